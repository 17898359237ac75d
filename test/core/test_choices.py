# SPDX-License-Identifier: Apache-2.0
"""Choices lane by lane, and where what is no number goes."""

import math

from hydra_actuator.core.choices import (
    all_at_most,
    at_least,
    at_most,
    where_at_most,
    where_positive,
)
from hydra_actuator.core.compilation import kernel
from hydra_actuator.core.lanes import element, load, put, store, WIDTH
import numpy as np
import pytest

ODD = np.array([math.nan, -0.0, 0.0, 1.0, -1.0, math.inf, -math.inf, 2.0])


@kernel
def choices(a, limit, out):
    for i in range(0, a.size, WIDTH):
        x = load(a, i)
        store(out[0], i, at_most(x, limit))
        store(out[1], i, at_least(x, limit))
        store(out[2], i, where_positive(x, 2.0 + 0.0 * load(out[2], i), load(out[2], i)))


@kernel
def limits(a, b, out):
    x, y = element(a, 0), element(b, 0)
    put(out, 0, where_at_most(x, y, 2.0 + 0.0 * element(out, 0), element(out, 0)))
    return all_at_most(x, y)


@kernel
def are_at_most(a, limit):
    return all_at_most(load(a, 0), limit)


def test_choices_put_what_is_no_number_at_the_limit():
    out = np.zeros((3, ODD.size))
    choices(ODD, 1.0, out)
    assert out[0].tolist() == [1.0, 0.0, 0.0, 1.0, -1.0, 1.0, -math.inf, 1.0]
    assert out[1].tolist() == [1.0, 1.0, 1.0, 1.0, 1.0, math.inf, 1.0, 2.0]
    assert out[2].tolist() == [0.0, 0.0, 0.0, 2.0, 0.0, 2.0, 0.0, 2.0]


@pytest.mark.parametrize(('a', 'all_are'), [
    ([1.0, 2.0, -3.0, 0.0], True), ([1.0, 5.1, 0.0, 0.0], False), ([math.nan] * 4, False),
    ([-math.inf, 0.0, math.nan, 0.0], False)])
def test_a_limit_is_kept_by_all_lanes_or_not_and_never_by_what_is_no_number(a, all_are):
    out = np.zeros(WIDTH)
    assert limits(np.array(a), np.full(WIDTH, 5.0), out) == all_are
    assert out.tolist() == [2.0 if x <= 5.0 else 0.0 for x in a]


@pytest.mark.parametrize('lane', range(WIDTH))
def test_one_lane_beyond_the_limit_is_enough(lane):
    values = np.array([-math.inf, 0.0, -2.0, 1.0])[:WIDTH]
    assert are_at_most(values, 1.0)
    for other in (1.1, 3.0, math.inf, math.nan):
        values[lane] = other
        assert not are_at_most(values, 1.0)
