# SPDX-License-Identifier: Apache-2.0
"""
Hold a loop to instants of a clock: absolute deadlines, exact count of what was missed.

The grid is origin + g * period for g = 1, 2, ...; a tick is released at a grid instant and is
due at the next one, when the following tick is released. A loop that comes back late by
`lateness` has let ceil(lateness / period) grid instants pass; each is counted once as missed,
however long the loop then takes to catch up. What becomes of them is the overrun policy:

- `burst`: up to `max_burst` ticks are run at once, one after the other; the rest is slip,
- `slip`: all of them are slip,
- `halt`: the pacer grants no further tick.

Slip is a declared shift of the grid by whole periods, so that at all times, without rounding,

    grid index of a tick = ticks granted + slipped        (no drift, ever).

Neglected: the time between reading the clock and going to sleep; it shows as lateness. The clock
and the sleep are handed in, so the arithmetic can be tested without waiting.
"""

from collections.abc import Callable
import math
import time

POLICIES = ('burst', 'slip', 'halt')
_NS = 1_000_000_000


class DurationHistogram:
    """
    Counts of durations in bounded memory: 32 bins per octave, so 3.2 % wide at most.

    Durations are whole nanoseconds, below 64 ns exactly resolved.
    """

    _BITS = 5

    def __init__(self):
        self._counts = [0] * ((64 - self._BITS) << self._BITS)
        self.count = 0
        self.maximum = 0

    def add(self, duration_ns: int) -> None:
        """Count one duration [ns]; a negative one counts as zero."""
        if duration_ns < 0:
            duration_ns = 0
        shift = duration_ns.bit_length() - self._BITS - 1
        if shift < 0:
            shift = 0
        self._counts[(shift << self._BITS) + (duration_ns >> shift)] += 1
        self.count += 1
        if duration_ns > self.maximum:
            self.maximum = duration_ns

    def percentile(self, percent: float) -> int:
        """Return the duration [ns] that `percent` of the counted ones do not exceed."""
        if not self.count:
            return 0
        wanted = percent / 100.0 * self.count
        seen = 0
        for index, count in enumerate(self._counts):
            seen += count
            if count and seen >= wanted:
                return min(self._upper_edge(index), self.maximum)
        return self.maximum

    def _upper_edge(self, index: int) -> int:
        """Return the longest duration [ns] that falls into a bin."""
        shift = max(0, (index >> self._BITS) - 1)
        return ((index - (shift << self._BITS) + 1) << shift) - 1


class Pacer:
    """
    Grants ticks at the instants of an absolute grid on a steady clock.

    One thread calls `start`, then `wait` before each tick, then `stop`; the figures may be read
    by others at any moment.

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
        self._period_ns = period * _NS
        if self._period_ns < 1.0:
            raise ValueError(f'period = {period} s: below one nanosecond')
        self._policy = policy
        self._catch_up = max_burst if policy == 'burst' else 0
        self._clock = clock
        self._sleep = sleep
        self.ticks = 0
        self.missed = 0
        self.slipped = 0
        self.halted = False
        self.lateness = DurationHistogram()
        self.execution = DurationHistogram()
        self._running = False
        self._past_ns = 0
        self._begin_run(0)

    def start(self) -> None:
        """Lay the grid's origin to this instant; the first tick is one period ahead."""
        self.halted = False
        self._running = True
        self._begin_run(self._clock())

    def stop(self) -> None:
        """End the run; the figures stay and the next run adds to them."""
        if self._running:
            self._past_ns += self._clock() - self._origin
        self._running = False

    def wait(self) -> int | None:
        """
        End the tick before, sleep until the next one is released, return its grid index.

        The index counts periods since `start`, slipped ones included. None after a miss under
        `halt`.
        """
        now = self._clock()
        if self._released is not None:
            self.execution.add(now - self._released)
        index = self._index + 1
        if now > self._instant(index):
            index = self._late(index, now)
            if self.halted:
                return None
        due = self._instant(index)
        while now < due:
            self._sleep((due - now) / _NS)
            now = self._clock()
        self.lateness.add(now - due)
        self._index = index
        self._released = now
        self.ticks += 1
        return index

    @property
    def elapsed(self) -> float:
        """Time [s] on the clock between `start` and `stop`, of all runs."""
        running_ns = self._clock() - self._origin if self._running else 0
        return (self._past_ns + running_ns) / _NS

    @property
    def slip(self) -> float:
        """Time [s] on the clock given up as slip, of all runs."""
        return self.slipped * self._period_ns / _NS

    def _begin_run(self, origin: int) -> None:
        """Forget the grid, keep the figures."""
        self._origin = origin
        self._index = 0
        self._passed = 0
        self._released: int | None = None

    def _instant(self, index: int) -> int:
        """Return a grid instant [ns] on the clock."""
        return self._origin + round(index * self._period_ns)

    def _late(self, index: int, now: int) -> int:
        """Count the grid instants that passed; return the grid index to go on with."""
        behind = math.ceil((now - self._instant(index)) / self._period_ns)
        # Instants are whole nanoseconds, so the quotient may be one off.
        if self._instant(index + behind) < now:
            behind += 1
        elif behind > 1 and self._instant(index + behind - 1) >= now:
            behind -= 1
        passed = index + behind - 1
        self.missed += max(0, passed - max(self._passed, index - 1))
        self._passed = max(self._passed, passed)
        if self._policy == 'halt':
            self.halted = True
            return index
        slip = max(0, behind - self._catch_up)
        self.slipped += slip
        return index + slip
