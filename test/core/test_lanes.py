# SPDX-License-Identifier: Apache-2.0
"""Four nodes as one value: lane by lane what the same formula gives with floats."""

import math

from hydra_actuator.core.compilation import kernel
from hydra_actuator.core.lanes import (
    at_least,
    at_most,
    load,
    look_up,
    store,
    where_positive,
    WIDTH,
)
import numpy as np
import pytest

VALUES = np.random.default_rng(3).normal(size=(2, 3 * WIDTH))
ODD = np.array([math.nan, -0.0, 0.0, 1.0, -1.0, math.inf, -math.inf, 2.0])


@kernel
def in_lanes(a, b, out):
    for i in range(0, a.size, WIDTH):
        x, y = load(a, i), load(b, i)
        z = (x + 2.0) * (y - 0.5) / (1.0 + abs(x)) - 3.0 * y + math.sqrt(abs(y))
        z += x
        z -= 0.25 / (2.0 + abs(y))
        store(out, i, z)


@kernel
def in_floats(a, b, out):
    for i in range(a.size):
        x, y = a[i], b[i]
        z = (x + 2.0) * (y - 0.5) / (1.0 + abs(x)) - 3.0 * y + math.sqrt(abs(y))
        z += x
        z -= 0.25 / (2.0 + abs(y))
        out[i] = z


@kernel
def choices(a, limit, out):
    for i in range(0, a.size, WIDTH):
        x = load(a, i)
        store(out[0], i, at_most(x, limit))
        store(out[1], i, at_least(x, limit))
        store(out[2], i, where_positive(x, 2.0 + 0.0 * load(out[2], i), load(out[2], i)))


@kernel
def interpolated(table, start, places, out):
    low, high, rest = look_up(table, start, load(places, 0))
    store(out, 0, low + rest * (high - low))


def test_arithmetic_of_lanes_is_that_of_floats():
    alone, together = np.zeros((2, VALUES.shape[1]))
    in_floats(*VALUES, alone)
    in_lanes(*VALUES, together)
    np.testing.assert_allclose(together, alone, rtol=1e-15, atol=1e-15)


def test_choices_put_what_is_no_number_at_the_limit():
    out = np.zeros((3, ODD.size))
    choices(ODD, 1.0, out)
    assert out[0].tolist() == [1.0, 0.0, 0.0, 1.0, -1.0, 1.0, -math.inf, 1.0]
    assert out[1].tolist() == [1.0, 1.0, 1.0, 1.0, 1.0, math.inf, 1.0, 2.0]
    assert out[2].tolist() == [0.0, 0.0, 0.0, 2.0, 0.0, 2.0, 0.0, 2.0]


@pytest.mark.parametrize('start', [0, 5])
def test_a_table_is_looked_up_at_each_lanes_own_place(start):
    table = np.arange(20.0) ** 2
    places = np.array([0.0, 0.25, 7.5, 13.999])
    out = np.zeros(WIDTH)
    interpolated(table, start, places, out)
    assert out == pytest.approx(np.interp(start + places, np.arange(20.0), table), rel=1e-14)
