# SPDX-License-Identifier: Apache-2.0
"""
Hold a loop to instants of a clock: absolute deadlines, exact count of what was missed.

What the grid is, and what becomes of missed instants: hydra_actuator.realtime.grid. Neglected:
the time between reading the clock and going to sleep; it shows as lateness. The clock and the
sleep are handed in, so the arithmetic can be tested without waiting.
"""

from collections.abc import Callable
import time

from hydra_actuator.realtime.durations import DurationHistogram
from hydra_actuator.realtime.grid import GRID, next_instant, release
import numpy as np

POLICIES = ('burst', 'slip', 'halt')
_NS = 1_000_000_000


class Pacer:
    """
    Grants ticks at the instants of an absolute grid on a steady clock.

    One thread calls `start`, then `wait` before each tick, then `stop`; the figures may be read
    by others at any moment. Compiled code may grant ticks between two calls of `wait`: on `grid`,
    counting into the arrays of `lateness` and `execution`.

    Parameters
    ----------
    period
        Distance of the grid's instants [s] on the clock.
    policy
        `burst`, `slip` or `halt`.
    max_burst
        Ticks that are caught up after a delay (`burst` only).
    clock, sleep
        Steady time [ns], and a sleep of so many seconds that never returns early.

    """

    def __init__(
        self,
        period: float,
        policy: str = 'burst',
        max_burst: int = 10,
        *,
        clock: Callable[[], int] = time.monotonic_ns,
        sleep: Callable[[float], None] = time.sleep,
    ):
        if policy not in POLICIES:
            raise ValueError(f'overrun policy {policy!r}: not one of {", ".join(POLICIES)}')
        if period * _NS < 1.0:
            raise ValueError(f'period = {period} s: below one nanosecond')
        self.grid = np.zeros(1, GRID)
        grid = self.grid[0]
        grid['period'] = period * _NS
        grid['catch_up'] = max_burst if policy == 'burst' else 0
        grid['halts'] = policy == 'halt'
        self._clock = clock
        self._sleep = sleep
        self.lateness = DurationHistogram()
        self.execution = DurationHistogram()
        self._running = False
        self._past_ns = 0
        self._begin_run(0)

    def start(self) -> None:
        """Lay the grid's origin to this instant; the first tick is one period ahead."""
        self.grid[0]['halted'] = 0
        self._running = True
        self._begin_run(self._clock())

    def stop(self) -> None:
        """End the run; the figures stay and the next run adds to them."""
        if self._running:
            self._past_ns += self._clock() - int(self.grid[0]['origin'])
        self._running = False

    def wait(self) -> int | None:
        """
        End the tick before, sleep until the next one is released, return its grid index.

        The index counts periods since `start`, slipped ones included. None after a miss under
        `halt`.
        """
        now = self._clock()
        released = int(self.grid[0]['released'])
        if released >= 0:
            self.execution.add(now - released)
        index, due = map(int, next_instant(self.grid, now))
        if self.halted:
            return None
        while now < due:
            self._sleep((due - now) / _NS)
            now = self._clock()
        self.lateness.add(now - due)
        release(self.grid, index, now)
        return index

    @property
    def ticks(self) -> int:
        """Ticks granted, of all runs."""
        return int(self.grid[0]['ticks'])

    @property
    def missed(self) -> int:
        """Grid instants at which the tick before had not ended, of all runs."""
        return int(self.grid[0]['missed'])

    @property
    def slipped(self) -> int:
        """Periods given up as slip, of all runs."""
        return int(self.grid[0]['slipped'])

    @property
    def halted(self) -> bool:
        """Whether a tick was missed under `halt`."""
        return bool(self.grid[0]['halted'])

    @property
    def elapsed(self) -> float:
        """Time [s] on the clock between `start` and `stop`, of all runs."""
        running_ns = self._clock() - int(self.grid[0]['origin']) if self._running else 0
        return (self._past_ns + running_ns) / _NS

    @property
    def slip(self) -> float:
        """Time [s] on the clock given up as slip, of all runs."""
        return self.slipped * float(self.grid[0]['period']) / _NS

    def _begin_run(self, origin: int) -> None:
        """Forget the grid, keep the figures."""
        grid = self.grid[0]
        grid['origin'] = origin
        grid['index'] = grid['passed'] = 0
        grid['released'] = -1
