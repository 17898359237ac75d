# SPDX-License-Identifier: Apache-2.0
"""How long things took: percentiles in bounded memory, counted by Python or by compiled code."""

import numpy as np

BITS = 5
DURATIONS = np.dtype([('count', np.int64), ('maximum', np.int64)], align=True)


def count_duration(bins, totals, duration_ns):
    """Count one duration [ns]; a negative one counts as zero."""
    if duration_ns < 0:
        duration_ns = 0
    shift = 0
    while (duration_ns >> shift) >= (2 << BITS):
        shift += 1
    bins[(shift << BITS) + (duration_ns >> shift)] += 1
    total = totals[0]
    total['count'] += 1
    if duration_ns > total['maximum']:
        total['maximum'] = duration_ns


class DurationHistogram:
    """
    Counts of durations: 32 bins per octave, so 3.2 % wide at most.

    Durations are whole nanoseconds, below 64 ns exactly resolved.
    """

    def __init__(self):
        self.arrays = (
            np.zeros((64 - BITS) << BITS, np.int64), np.zeros(1, DURATIONS))

    @property
    def count(self) -> int:
        """How many durations were counted."""
        return int(self.arrays[1]['count'][0])

    @property
    def maximum(self) -> int:
        """The longest duration [ns]."""
        return int(self.arrays[1]['maximum'][0])

    def add(self, duration_ns: int) -> None:
        """Count one duration [ns]; a negative one counts as zero."""
        count_duration(*self.arrays, duration_ns)

    def percentile(self, percent: float) -> int:
        """Return the duration [ns] that `percent` of the counted ones do not exceed."""
        bins = self.arrays[0]
        seen = np.cumsum(bins)
        if not seen[-1]:
            return 0
        index = int(np.argmax((bins > 0) & (seen >= percent / 100.0 * seen[-1])))
        if not bins[index]:
            # more than all of them, by rounding
            return self.maximum
        return min(_upper_edge(index), self.maximum)


def _upper_edge(index: int) -> int:
    """Return the longest duration [ns] that falls into a bin."""
    shift = max(0, (index >> BITS) - 1)
    return ((index - (shift << BITS) + 1) << shift) - 1
