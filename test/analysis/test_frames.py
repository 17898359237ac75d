# SPDX-License-Identifier: Apache-2.0
"""The field of a recording, read when it is looked at, is the array it was written from."""

from hydra_actuator.analysis.decimation import bucket_extremes
from hydra_actuator.analysis.extraction import series_of
from hydra_actuator.analysis.frames import Frames
import numpy as np
import pytest


@pytest.fixture
def both(make_run, record):
    """Return a field as it was made, float32, and as it is read, of several blocks."""
    run = make_run(0.5, 10_000)
    read = series_of(record(run, chunk_size=20_000)).field
    assert isinstance(read.pressure, Frames)
    return run.field, read


def test_it_is_the_array_and_so_is_each_part_of_it(both):
    made, read = both
    pressure = made.pressure.astype(np.float32)
    assert read.pressure.shape == pressure.shape
    for part in (slice(None), slice(7, 4000, 3), slice(5, 5), np.array([0, 9, 4321]),
                 np.arange(len(pressure)) % 1000 == 1):
        np.testing.assert_array_equal(read.pressure[part], pressure[part])
    np.testing.assert_array_equal(read.at(slice(100, 200)).velocity[3:5],
                                  made.velocity[103:105].astype(np.float32))


@pytest.mark.parametrize('buckets', [1, 2, 7, 210, 10_000])
def test_its_extremes_are_those_of_the_array(both, buckets):
    made, read = both
    values = made.pressure.astype(np.float32)
    starts, lowest, highest = read.extremes('pressure', buckets)
    ends = [*starts[1:], len(values)]
    for k, (first, end) in enumerate(zip(starts, ends)):
        np.testing.assert_array_equal(lowest[k], np.fmin.reduce(values[first:end]))
        np.testing.assert_array_equal(highest[k], np.fmax.reduce(values[first:end]))
    np.testing.assert_array_equal(bucket_extremes(values, buckets)[1], lowest)


@pytest.mark.parametrize('after', [None, 1, 50])
def test_its_lowest_pressure_is_found_where_it_is_first(both, after):
    made, read = both
    if after:
        read.extremes('pressure', after)
    values = made.pressure.astype(np.float32)
    frame, node = np.unravel_index(np.nanargmin(values), values.shape)
    assert read.lowest_pressure() == (values[frame, node], frame, node)


def test_frames_are_still_read_when_the_recording_is_forgotten(make_run, record):
    run = make_run(0.05, 1000)
    field = series_of(record(run)).field.between(0.01, 0.02)
    np.testing.assert_array_equal(
        field.pressure, run.field.between(0.01, 0.02).pressure.astype(np.float32))
