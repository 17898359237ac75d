# SPDX-License-Identifier: Apache-2.0
"""Records that compiled code sees as one address."""

import copy
from dataclasses import dataclass
import pickle

from hydra_actuator.core.compilation import formula
from hydra_actuator.core.handle import Handle
import numpy as np
import pytest


@dataclass(frozen=True, eq=False)
class Thing(Handle):
    number: float
    count: int
    row: np.ndarray
    grid: np.ndarray
    marks: tuple
    next: 'Thing | None' = None


@formula
def read(thing):
    return thing.number, thing.count, thing.row[1], thing.grid[1, 2], thing.grid.shape


@formula
def write(thing, value):
    thing.row[0] = value


@formula
def marks(thing):
    return len(thing.marks)


def thing(*given: object) -> Thing:
    return Thing(0.1, -3, np.array([1.0, 2.0]), np.arange(6).reshape(2, 3), given)


def test_kernels_read_numbers_arrays_and_shapes():
    assert read(thing()) == (0.1, -3, 2.0, 5, (2, 3))


def test_kernels_write_the_arrays_that_python_holds():
    record = thing()
    write(record, 7.0)
    assert record.row[0] == 7.0


def test_the_length_of_a_tuple_is_part_of_the_type():
    assert (marks(thing()), marks(thing(1))) == (0, 1)
    assert len(marks.signatures) == 2


def test_records_of_one_shape_share_one_compilation():
    read(thing())
    before = len(read.signatures)
    read(Thing(5.0, 1, np.zeros(9), np.zeros((4, 4), int), ()))
    assert len(read.signatures) == before


@pytest.mark.parametrize('copied', [copy.copy, copy.deepcopy,
                                    lambda record: pickle.loads(pickle.dumps(record))])
def test_a_copy_outlives_what_it_was_made_from(copied):
    record = thing()
    other = copied(record)
    del record
    assert read(other) == (0.1, -3, 2.0, 5, (2, 3))


def test_an_array_with_gaps_is_refused():
    with pytest.raises(TypeError, match='C-contiguous'):
        Thing(0.1, 1, np.zeros(6)[::2], np.zeros((1, 1), int), ())


@dataclass(frozen=True, eq=False)
class Numbers(Handle):
    values: np.ndarray
    counts: np.ndarray


@formula
def shift(record, by):
    for i in range(by, record.values.size):
        record.values[i - by] = record.values[i] + record.counts[i]
    record.counts[by] = record.values.size
    total = 0.0
    for value in record.values[by:]:
        total += value
    return total


def test_elements_and_slices_of_an_array_are_read_and_written():
    record = Numbers(np.array([1.0, 2.0, 3.0, 4.0]), np.array([10, 20, 30, 40]))
    assert shift(record, 1) == 33.0 + 44.0 + 4.0
    assert record.values.tolist() == [22.0, 33.0, 44.0, 4.0]
    assert record.counts.tolist() == [10, 4, 30, 40]
