# SPDX-License-Identifier: Apache-2.0
"""
The hydraulic supply of a bench: switched on and off over a ramp, as an unloading valve does.

Off is the tank's pressure: a supply that fell at once, or lower, would send a wave of its own
height into the supply line, below vacuum where there is no model of cavitation. The ramp is half
a cosine of 50 ms, long against the travel time of any line here. A new pressure while it is on
acts at once: that is a change somebody asked for.
"""

import math

RAMP = 0.05


class Supply:
    """Supply pressure [Pa, gauge] tick by tick."""

    def __init__(self, pressure: float, tank_pressure: float, period: float):
        self.on = True
        self.pressure = pressure
        self._tank_pressure = tank_pressure
        self._step = period / RAMP
        self._share = 1.0
        self._given = pressure

    def tick(self) -> float | None:
        """Move the ramp by a period; return the pressure to set, None if it is set already."""
        move = self._step if self.on else -self._step
        self._share = min(1.0, max(0.0, self._share + move))
        rise = self.pressure - self._tank_pressure
        lacking = 0.5 + 0.5 * math.cos(math.pi * self._share)
        wanted = self.pressure - lacking * rise
        if wanted == self._given:
            return None
        self._given = wanted
        return wanted

    def forget(self) -> None:
        """Have the next tick give the pressure anew, since whom it was given to was reset."""
        self._given = math.nan
