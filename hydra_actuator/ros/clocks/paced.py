# SPDX-License-Identifier: Apache-2.0
"""
Real time: ticks at absolute deadlines of the steady clock.

The stamp of a tick is base + (ticks + slipped) * period, with base the system time of the start:
simulated time plus slip, whatever the clocks do meanwhile.
"""

import time

from hydra_actuator.realtime.pacer import Pacer
from hydra_actuator.ros import statuses
from hydra_actuator.ros.clocks.source import Act, ClockSource, Grant
from hydra_actuator.ros.watch import Watched
import numpy as np


class Paced(ClockSource):
    """
    Grants what a pacer grants.

    A compiled loop may tick on the pacer's grid meanwhile; attention (1,): not 0 where it is to
    end; base: stamp [ns] of grid index 0.
    """

    simulated = False

    def __init__(self, period: float, pacer: Pacer):
        super().__init__(period)
        self.pacer = pacer
        self.attention = np.zeros(1, np.int64)
        self.base = 0
        self._missed = statuses.Recently()

    def start(self, last_stamp: int) -> int:
        """Lay the grid to this instant."""
        self.failure = ''
        self.pacer.start()
        self.base = max(time.time_ns(), last_stamp)
        return self.base

    def stop(self) -> None:
        """End the run of the pacer."""
        self.pacer.stop()

    def wait(self) -> Grant | None:
        """Sleep until the next instant of the grid; a reset takes one of them."""
        index = self.pacer.wait()
        if index is None:
            self.halt()
            return None
        stamp = self.base + round(index * self._period_ns)
        return self._grant(stamp)

    def halt(self) -> None:
        """Say why there is no further tick."""
        self.failure = 'a tick was missed, and timing.overrun_policy is halt'

    def restart(self) -> None:
        """Have the next grant be a reset."""
        super().restart()
        self.attention[0] = 1

    def wake(self) -> None:
        """Have a compiled loop end after its tick."""
        super().wake()
        self.attention[0] = 1

    @property
    def reset_is_due(self) -> bool:
        """Tell whether the next grant is a reset."""
        return self._restarting

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
