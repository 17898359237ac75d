# SPDX-License-Identifier: Apache-2.0
"""
Runs dealt in chunks: client and scheduler have few tasks to handle, however short runs are.

A chunk is to take AT_LEAST [s], and longer with many workers: each task costs the asking process
some milliseconds, and must not be asked for more often than that. Until the first ones are back
chunks hold one run; towards the end they get smaller, so that all workers end together. The runs
of a chunk that was lost with its worker are dealt again one by one, to find the one to blame.
"""

from collections import deque

AT_LEAST, PER_WORKER = 0.5, 0.01        # [s]
SHARES = 3                              # chunks per worker in what is left, at least


class Chunks:
    """What is left of the runs of a sweep."""

    def __init__(self, runs: list[int], workers: int) -> None:
        """Hold runs in order, for so many workers."""
        self._left, self._alone = deque(runs), deque()
        self._workers = max(1, workers)
        self._seconds, self._done = 0.0, 0

    def deal(self) -> tuple[int, ...]:
        """Return the next chunk, empty if nothing is left."""
        if self._alone:
            return (self._alone.popleft(),)
        return tuple(self._left.popleft() for _ in range(min(self.size, len(self._left))))

    @property
    def size(self) -> int:
        """How many runs the next chunk is to hold."""
        if not self._done:
            return 1
        each = max(self._seconds / self._done, 1e-4)
        wanted = int(max(AT_LEAST, PER_WORKER * self._workers) / each)
        return max(1, min(wanted, len(self._left) // (SHARES * self._workers)))

    def learn(self, runs: int, seconds: float) -> None:
        """Take note of how long a chunk took its worker [s]."""
        self._done += runs
        self._seconds += seconds

    def give_back(self, runs: tuple[int, ...]) -> None:
        """Take back a chunk that was lost."""
        self._alone.extend(runs)
