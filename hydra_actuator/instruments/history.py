# SPDX-License-Identifier: Apache-2.0
"""
What the signals were at past ticks, for readings that come late.

Between two ticks a signal is taken as linear. Before the first tick known it is what it was then.
"""

import numpy as np


class History:
    """Values of signals by tick, the newest `capacity` of them."""

    def __init__(self, signals: int, capacity: int):
        # The system gives pages of zeros only where they are used.
        self._values = np.zeros((capacity, signals))
        self._columns = np.arange(signals)
        self.oldest, self.newest = 0, -1

    def forget(self) -> None:
        """Begin anew."""
        self.oldest, self.newest = 0, -1

    def append(self, tick: int, values: np.ndarray) -> None:
        """Keep the values (signals,) of a tick later than all; ticks left out get the same."""
        capacity = len(self._values)
        if self.newest < self.oldest or tick - self.newest > capacity:
            self.oldest, self.newest = tick, tick - 1
        for missing in range(self.newest + 1, tick + 1):
            self._values[missing % capacity] = values
        self.newest = tick
        self.oldest = max(self.oldest, tick - capacity + 1)

    def at(self, places: np.ndarray, now: float, values: np.ndarray) -> np.ndarray:
        """
        Return each signal at its own place in time, shape (signals,).

        places: in ticks, at most `now`; values: the signals at `now`, a tick or between two.
        """
        if self.newest < self.oldest:
            return values
        whole = np.floor(places).astype(np.int64)
        share = places - whole
        before = self._known(whole)
        if now == self.newest and not share.any():
            return before
        after = self._known(whole + 1)
        beyond = whole >= self.newest
        after = np.where(beyond, values, after)
        share = np.where(beyond, share / max(now - self.newest, 1e-300), share)
        late = np.where(share > 0.0, before + share * (after - before), before)
        return np.where(places >= now, values, late)

    def _known(self, ticks: np.ndarray) -> np.ndarray:
        """Return each signal at its own tick, or at the nearest one known."""
        nearest = np.minimum(np.maximum(ticks, self.oldest), self.newest)
        return self._values[nearest % len(self._values), self._columns]
