# SPDX-License-Identifier: Apache-2.0
"""What the reader of a command meets: compiled or not, the same."""

from hydra_actuator.core.compilation import kernel
from hydra_actuator.realtime.held import nothing_held, sample, SLOT
import numpy as np

compiled = kernel(sample)


def commanded():
    held = nothing_held()
    held.slots[2] = (0.25, -0.5, 1000)
    record = held.record[0]
    record['slot'], record['given'], record['load_force'] = 2, 3, 7.0
    record['timeout'], record['centres'] = 500, 1
    return held


def test_what_holds_is_sampled_and_what_is_new_counts_once():
    assert SLOT.itemsize == 24
    for sampler in (sample, compiled):
        held = commanded()
        assert sampler(held, 1500) == (0.25, -0.5, 7.0)
        assert sampler(held, 1500) == (0.25, -0.5, 7.0)
        record = held.record[0]
        assert (record['applied'], record['timed_out'], record['timeouts']) == (1, 0, 0)


def test_compiled_and_not_they_leave_the_same_memory():
    one, other = commanded(), commanded()
    for now in (900, 1501, 1502, 1400, 9000):
        assert sample(one, now) == compiled(other, now)
        assert np.array_equal(one.record, other.record)
    assert one.record[0]['timeouts'] == 2
