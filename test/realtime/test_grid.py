# SPDX-License-Identifier: Apache-2.0
"""The grid's arithmetic is compiled into the loop: it counts as the Python does."""

from hydra_actuator.core.compilation import kernel
from hydra_actuator.realtime.durations import count_duration, DurationHistogram
from hydra_actuator.realtime.grid import GRID, next_instant, release
from hypothesis import given, settings
from hypothesis import strategies as st
import numpy as np
import pytest

compiled_next, compiled_release = kernel(next_instant), kernel(release)
compiled_count = kernel(count_duration)


def grid(period, catch_up, halts):
    record = np.zeros(1, GRID)
    record['period'], record['catch_up'], record['halts'] = period, catch_up, halts
    record['origin'], record['released'] = 5_000_000_123, -1
    return record


@settings(deadline=None, max_examples=50)
@given(
    period=st.sampled_from([1e6, 1e9 / 3000.0, 1e9 / 7.0]), catch_up=st.integers(0, 12),
    halts=st.booleans(),
    delays=st.lists(st.integers(0, 20_000_000), min_size=1, max_size=40))
def test_compiled_and_not_they_count_the_same(period, catch_up, halts, delays):
    one, other = grid(period, catch_up, halts), grid(period, catch_up, halts)
    now = 5_000_000_123
    for delay in delays:
        now += delay
        index, due = next_instant(one, now)
        assert (index, due) == compiled_next(other, now)
        now = max(now, int(due))
        release(one, index, now)
        compiled_release(other, index, now)
        assert np.array_equal(one, other)


@pytest.mark.parametrize('first', [-5, 0, 63, 64, 65, 10**6, 2**40])
def test_compiled_and_not_durations_fall_into_the_same_bins(first):
    one, other = DurationHistogram(), DurationHistogram()
    for duration in range(first, first + 200):
        one.add(duration)
        compiled_count(*other.arrays, duration)
    assert all(np.array_equal(*pair) for pair in zip(one.arrays, other.arrays))
    assert one.count == 200
    assert one.percentile(100.0) == max(first + 199, 0)
