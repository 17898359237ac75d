# SPDX-License-Identifier: Apache-2.0
"""Four nodes as one value: lane by lane what the same formula gives with floats."""

import math

from hydra_actuator.core.compilation import kernel
from hydra_actuator.core.lanes import (
    gather,
    load,
    look_up,
    multiply_add,
    put,
    scatter,
    store,
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
def two_products(a, b, c, d, out):
    put(out, 0, multiply_add(load(a, 0), load(b, 0), load(c, 0) * load(d, 0)))
    for k in range(WIDTH):
        out[WIDTH + k] = multiply_add(a[k], b[k], c[k] * d[k])


@kernel
def signs(a, out):
    put(out, 0, -load(a, 0))
    put(out, 1, math.copysign(load(a, WIDTH), load(a, 0)))


@kernel
def moved(values, places, out):
    scatter(out, places, WIDTH, 1, gather(values, places, 0, 2))


@kernel
def interpolated(table, start, places, out):
    low, high, rest = look_up(table, start, load(places, 0))
    store(out, 0, low + rest * (high - low))


def test_arithmetic_of_lanes_is_that_of_floats():
    alone, together = np.zeros((2, VALUES.shape[1]))
    in_floats(*VALUES, alone)
    in_lanes(*VALUES, together)
    np.testing.assert_allclose(together, alone, rtol=1e-15, atol=1e-15)


@pytest.mark.parametrize('start', [0, 5])
def test_a_table_is_looked_up_at_each_lanes_own_place(start):
    table = np.arange(20.0) ** 2
    places = np.array([0.0, 0.25, 7.5, 13.999])
    out = np.zeros(WIDTH)
    interpolated(table, start, places, out)
    assert out == pytest.approx(np.interp(start + places, np.arange(20.0), table), rel=1e-14)


def test_a_sum_of_two_products_rounds_alike_in_lanes_and_in_floats():
    random = np.random.default_rng(7)
    for _ in range(50):
        a, b, c, d = random.normal(size=(4, WIDTH))
        out = np.zeros(2 * WIDTH)
        two_products(a, b, c, d, out)
        assert out[:WIDTH].tolist() == out[WIDTH:].tolist()
        assert out[:WIDTH] == pytest.approx(a * b + c * d, rel=1e-14, abs=1e-15)


def test_signs_are_those_of_floats():
    out = np.zeros(2 * WIDTH)
    signs(ODD, out)
    assert np.signbit(out[1:WIDTH]).tolist() == [False, True, True]
    assert out[WIDTH + 1:].tolist() == [-math.inf, math.inf, 2.0]


def test_lanes_come_from_and_go_to_places_of_their_own():
    values, out = np.arange(20.0), np.zeros(20)
    places = np.array([3, 0, 11, 7, 9, 1, 17, 5])
    moved(values, places, out)
    assert out[[10, 2, 18, 6]].tolist() == [5.0, 2.0, 13.0, 9.0]
    assert np.count_nonzero(out) == 4
