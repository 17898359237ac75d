# SPDX-License-Identifier: Apache-2.0
"""Laws of wall friction, each alone."""

import math

from hydra_actuator.core.friction import (
    damping_table,
    darcy_factor,
    DECAY,
    memory_constants,
    steady_drag,
    TABLE_SIZE,
    WEIGHT,
)
from hypothesis import given
from hypothesis import strategies as st
import numpy as np
import pytest

DIAMETER, VISCOSITY, ROUGHNESS, FASTEST = 0.016, 46e-6, 1.5e-6, 32.5
SCALE = (TABLE_SIZE - 1) / math.sqrt(FASTEST)


def drag(velocity: float, viscosity: float = VISCOSITY, loss: float = 0.0) -> float:
    table = damping_table(DIAMETER, viscosity, ROUGHNESS, FASTEST)
    return steady_drag(velocity, loss, (table, 0), SCALE)


@given(st.floats(1e-6, 1000.0))
def test_laminar_factor_is_64_over_reynolds(reynolds):
    assert darcy_factor(reynolds, 1e-4) == pytest.approx(64.0 / reynolds, rel=1e-9)


@pytest.mark.parametrize('reynolds', [1e4, 1e5, 1e6, 1e7])
@pytest.mark.parametrize('roughness', [0.0, 1e-5, 1e-3, 0.02])
def test_turbulent_factor_agrees_with_colebrook(reynolds, roughness):
    root = 8.0
    for _ in range(50):
        root = -2.0 * math.log10(roughness / 3.7 + 2.51 * root / reynolds)
    # Churchill's own formula is this far from Colebrook's at low Reynolds number
    assert darcy_factor(reynolds, roughness) == pytest.approx(root ** -2, rel=0.035)


def test_factor_is_smooth_through_transition():
    reynolds = np.geomspace(500.0, 2e4, 4000)
    slope = np.diff(np.log(darcy_factor(reynolds, 1e-4))) / np.diff(np.log(reynolds))
    assert np.abs(np.diff(slope)).max() < 0.1


@given(st.floats(0.01, 30.0), st.sampled_from([1e-6, 1e-5, 46e-6]))
def test_table_follows_the_formula(speed, viscosity):
    factor = float(darcy_factor(speed * DIAMETER / viscosity, ROUGHNESS / DIAMETER))
    exact = 0.5 * factor * speed * speed / DIAMETER
    # linear over sqrt|u| between 4096 places, worst in the bend of transition
    assert drag(speed, viscosity) == pytest.approx(exact, rel=2e-3)


@given(st.floats(0.0, 1e-2))
def test_drag_is_laminar_to_rounding_at_small_flow(speed):
    assert drag(speed) == pytest.approx(32.0 * VISCOSITY / DIAMETER ** 2 * speed, rel=1e-9)


@given(st.floats(-40.0, 40.0))
def test_drag_is_odd_and_opposes_the_flow(velocity):
    assert drag(-velocity) == -drag(velocity)
    assert drag(velocity) * velocity >= 0.0


def test_constant_loss_adds_half_lambda_u_squared():
    assert drag(-3.0, loss=1.9) - drag(-3.0) == pytest.approx(-0.5 * 1.9 * 9.0, rel=1e-12)


def test_terms_of_the_memory_and_its_inertia_sum_to_a_twelfth():
    radius, step = 0.008, 7e-6
    decay, gain, inertia = memory_constants(radius, VISCOSITY, step)
    # a velocity that rises by 1 and stays: the drag it leaves behind, summed over all time
    impulse = inertia * step + np.sum(gain / (1.0 - decay)) * step
    assert impulse == pytest.approx(4.0 / 12.0, rel=1e-9)
    assert sum(m / n for m, n in zip(WEIGHT, DECAY)) < 1.0 / 12.0


@pytest.mark.parametrize('step', [1e-9, 1e-6, 1e-4])
def test_memory_does_not_depend_on_how_time_is_cut(step):
    decay, _, _ = memory_constants(0.008, VISCOSITY, step)
    rate = VISCOSITY / 0.008 ** 2
    assert decay == pytest.approx(np.exp(-np.array(DECAY) * rate * step), rel=1e-12)


def test_what_is_no_number_has_a_place_in_the_table_and_stays_no_number():
    assert math.isnan(drag(math.nan))
