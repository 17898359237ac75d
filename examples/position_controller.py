# SPDX-License-Identifier: Apache-2.0
"""The controller that the examples test: holds the piston at a target."""

import math


class PositionController:
    """
    A PI controller: a spool command for each position measured.

    target [m]; period [s] between calls; gain [1/m] of the normalised spool per error;
    integral_time [s], infinite for none.
    """

    def __init__(
        self, target: float, period: float, gain: float = 30.0, integral_time: float = math.inf
    ):
        self._target = target
        self._gain = gain
        self._growth = gain * period / integral_time
        self._integral = 0.0

    def command(self, position: float) -> float:
        """Return the spool command, -1 to 1, for a position [m]."""
        error = self._target - position
        wanted = self._gain * error + self._integral
        command = min(1.0, max(-1.0, wanted))
        # At its limit the valve can do no more: the integral waits.
        if command == wanted:
            self._integral += self._growth * error
        return command
