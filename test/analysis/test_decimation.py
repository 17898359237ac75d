# SPDX-License-Identifier: Apache-2.0
"""Fewer points keep every extreme, exactly and in place."""

from hydra_actuator.analysis.decimation import bucket_extremes, extreme_samples, line_samples
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import array_shapes, arrays
import numpy as np
import pytest

LINES = arrays(float, st.integers(1, 400), elements=st.floats(-1e9, 1e9))
GAPPY = arrays(float, st.integers(1, 400), elements=st.floats(-1e9, 1e9) | st.just(float('nan')))


@given(LINES, st.integers(1, 50))
def test_the_extremes_of_a_line_are_kept_exactly(values, buckets):
    kept = extreme_samples(values, buckets)
    assert values[kept].min() == values.min()
    assert values[kept].max() == values.max()


@given(LINES, st.integers(1, 50))
def test_kept_samples_are_in_order_and_begin_and_end_with_the_line(values, buckets):
    kept = extreme_samples(values, buckets)
    assert np.all(np.diff(kept) > 0)
    assert kept[0] == 0
    assert kept[-1] == len(values) - 1
    assert len(kept) <= 2 * buckets + 2


@given(GAPPY, st.integers(1, 50))
def test_a_gap_stays_a_gap_and_hides_no_extreme(values, buckets):
    shown = values[extreme_samples(values, buckets)]
    assert np.isnan(shown).any() == np.isnan(values).any()
    if np.isfinite(values).any():
        assert np.nanmax(shown) == np.nanmax(values)
        assert np.nanmin(shown) == np.nanmin(values)


@given(st.integers(2, 5000), st.integers(1, 50), st.data())
def test_a_spike_of_one_sample_stays_at_its_instant(count, buckets, data):
    place = data.draw(st.integers(0, count - 1))
    values = np.zeros(count)
    values[place] = 1.0
    assert place in extreme_samples(values, buckets)


@given(LINES, st.integers(8, 200), st.data())
def test_the_part_on_view_keeps_its_full_rate(values, budget, data):
    full_from = data.draw(st.integers(0, len(values)))
    kept = line_samples(values, budget, full_from)
    tail = np.arange(full_from, len(values))
    if len(tail) <= budget // 2:
        assert np.all(np.isin(tail, kept))
    assert len(kept) <= budget + 2
    assert values[kept].max() == values.max()
    assert np.all(np.diff(kept) > 0)


@given(arrays(np.float32, array_shapes(min_dims=2, max_dims=2, max_side=40),
              elements=st.floats(-1000, 1000, width=32) | st.just(float('nan'))),
       st.integers(1, 30))
def test_the_extremes_of_a_field_are_kept_at_every_node(values, buckets):
    starts, lowest, highest = bucket_extremes(values, buckets)
    assert len(starts) == len(lowest) == len(highest) == min(buckets, len(values))
    np.testing.assert_array_equal(np.fmax.reduce(highest), np.fmax.reduce(values))
    np.testing.assert_array_equal(np.fmin.reduce(lowest), np.fmin.reduce(values))


@pytest.mark.parametrize('count', [0, 1])
def test_almost_nothing_is_shown_whole(count):
    assert len(extreme_samples(np.zeros(count), 10)) == count
    assert len(bucket_extremes(np.zeros((count, 3)), 10)[0]) == count
