# SPDX-License-Identifier: Apache-2.0
"""
Real time: ticks at absolute deadlines of the steady clock.

The stamp of a tick is base + (ticks + slipped) * period, with base the system time of the start:
simulated time plus slip, whatever the clocks do meanwhile.
"""

import time

from hydra_actuator.pacer import Pacer
from hydra_actuator.ros import statuses
from hydra_actuator.ros.clocks.source import Act, ClockSource, Grant
from hydra_actuator.ros.watch import Watched


class Paced(ClockSource):
    """Grants what a pacer grants."""

    simulated = False

    def __init__(self, period: float, pacer: Pacer):
        super().__init__(period)
        self.pacer = pacer
        self._base = 0
        self._missed = statuses.Recently()

    def start(self, last_stamp: int) -> int:
        """Lay the grid to this instant."""
        self.failure = ''
        self.pacer.start()
        self._base = max(time.time_ns(), last_stamp)
        return self._base

    def stop(self) -> None:
        """End the run of the pacer."""
        self.pacer.stop()

    def wait(self) -> Grant | None:
        """Sleep until the next instant of the grid; a reset takes one of them."""
        index = self.pacer.wait()
        if index is None:
            self.failure = 'a tick was missed, and timing.overrun_policy is halt'
            return None
        self.ticks += 1
        stamp = self._base + round(index * self._period_ns)
        return self._grant(stamp)

    def out_of_turn(self, last_stamp: int) -> Grant:
        """Return a grant one period after the last state."""
        return self._grant(last_stamp + round(self._period_ns))

    def log_time(self, system_time: int) -> int:
        """Return the system's time."""
        return system_time

    def status(self) -> statuses.Status:
        """Return how well the ticks keep to their grid."""
        pacer = self.pacer
        return statuses.real_time(pacer, self.period, self._missed.grew(pacer.missed))

    def watched(self) -> list[Watched]:
        """Return missed ticks and slip."""
        pacer, warn = self.pacer, statuses.WARN
        return [
            Watched('Real time', warn, 'ticks missed', lambda: pacer.missed),
            Watched('Real time', warn, 'ticks given up as slip', lambda: pacer.slipped),
        ]

    def _grant(self, stamp: int) -> Grant:
        return Grant(stamp, Act.RESET if self._reset_due() else Act.SOLVE)
