# SPDX-License-Identifier: Apache-2.0
"""Draws belong to instants: the same whatever else is drawn, and distributed as they claim."""

from hydra_actuator.instruments.draws import BLOCK, Draws
import numpy as np
import pytest

NAMES = ('position', 'velocity', 'pressure.A')
STRIDE = 130
COUNT = 40_000


def normals(seed=0, purpose='sensor', names=NAMES, stride=STRIDE, count=COUNT):
    draws = Draws(seed, purpose, names, stride)
    return np.array([draws.normal(step) for step in range(0, count * stride, stride)])


def test_a_draw_is_the_same_in_any_order_and_beside_any_other():
    forwards = normals(count=3 * BLOCK)
    draws = Draws(0, 'sensor', ('pressure.A', 'extra'), STRIDE)
    for place in (150, 3, 149, 0):
        assert draws.normal(place * STRIDE)[0] == forwards[place, 2]


def test_a_draw_between_two_ticks_is_the_one_that_shorter_ticks_give():
    finer = normals(stride=STRIDE // 10, count=100)
    draws = Draws(0, 'sensor', NAMES, STRIDE)
    for place in (1, 7, 10, 99):
        assert draws.normal(place * STRIDE // 10).tolist() == finer[place].tolist()


def test_normal_draws_have_the_moments_of_the_standard_normal_distribution():
    # Fixed seeds give fixed numbers; the limits are four standard errors of the moments.
    values, error = normals(), 4.0 / np.sqrt(COUNT)
    assert np.abs(values.mean(axis=0)).max() < error
    assert np.abs(values.var(axis=0) - 1.0).max() < error * np.sqrt(2.0)
    assert np.abs((values ** 3).mean(axis=0)).max() < error * np.sqrt(15.0)
    assert np.abs((values ** 4).mean(axis=0) - 3.0).max() < error * np.sqrt(96.0)


def test_draws_are_without_memory_and_signals_seeds_and_purposes_without_a_common_one():
    values, error = normals(), 4.0 / np.sqrt(COUNT)
    assert abs((values[1:] * values[:-1]).mean()) < error
    others = (values[:, 1], normals(seed=1)[:, 0], normals(purpose='fault')[:, 0])
    for other in others:
        assert abs((values[:, 0] * other).mean()) < error


@pytest.mark.parametrize('share', [0.01, 0.3, 0.9])
def test_uniform_draws_fall_below_a_probability_that_often(share):
    draws = Draws(5, 'dropout', NAMES, STRIDE)
    values = np.array([draws.uniform(step) for step in range(COUNT // 4)])
    assert 0.0 < values.min() and values.max() < 1.0
    expected_error = np.sqrt(share * (1.0 - share) / values.size)
    assert (values < share).mean() == pytest.approx(share, abs=4.0 * expected_error)
