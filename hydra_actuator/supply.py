# SPDX-License-Identifier: Apache-2.0
"""
The hydraulic supply of a bench: switched on and off, or lost in part, over a ramp.

Off is the tank's pressure: a supply that fell at once, or lower, would send a wave of its own
height into the supply line, below vacuum where there is no model of cavitation. The ramp is half
a cosine of 50 ms, long against the travel time of any line here. A new pressure while it is on
acts at once: that is a change somebody asked for.
"""

import math

RAMP = 0.05


class Supply:
    """Supply pressure [Pa, gauge] tick by tick; `pressure` is what there is when all is well."""

    def __init__(self, pressure: float, tank_pressure: float, period: float):
        """Begin at full pressure; period [s] is that of the ticks."""
        self._tank_pressure = tank_pressure
        self._step = period / RAMP
        self._first = pressure
        self._on, self._loss = True, 0.0
        self._target = 1.0
        self.begin()

    @property
    def on(self) -> bool:
        """Whether it is switched on."""
        return self._on

    @on.setter
    def on(self, on: bool) -> None:
        self._on = on
        self._aim()

    @property
    def loss(self) -> float:
        """The part of the pressure above the tank's that is lost."""
        return self._loss

    @loss.setter
    def loss(self, loss: float) -> None:
        self._loss = loss
        self._aim()

    def _aim(self) -> None:
        """Find the end of the ramp, at 1 for all and 0 for none of the pressure."""
        self._target = math.acos(2.0 * self._loss - 1.0) / math.pi if self._on else 0.0

    @property
    def resting(self) -> bool:
        """Tell whether the pressure stays as it was given."""
        return self._share == self._target and self.pressure == self._whole

    def begin(self) -> None:
        """Start anew at the first pressure in full, as the plant does; on and loss stay."""
        self._share = 1.0
        self.pressure = self._whole = self._given = self._first

    def tick(self) -> float | None:
        """Move the ramp by a period; return the pressure to set, None if it is set already."""
        way = self._target - self._share
        self._share = self._target if abs(way) <= self._step else (
            self._share + math.copysign(self._step, way))
        return self.give()

    def give(self) -> float | None:
        """Return the pressure where the ramp is now, None if it is set already."""
        self._whole = self.pressure
        lacking = 0.5 + 0.5 * math.cos(math.pi * self._share)
        wanted = self.pressure - lacking * (self.pressure - self._tank_pressure)
        if wanted == self._given:
            return None
        self._given = wanted
        return wanted
