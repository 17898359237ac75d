# SPDX-License-Identifier: Apache-2.0
"""Interpolation, ghosts and the sweep of a line, each alone."""

import math

from hydra_actuator.core.compilation import kernel
from hydra_actuator.core.lanes import WIDTH
from hydra_actuator.core.line import fill_ghost, interpolate, sweep
from hydra_actuator.core.model import Domain, Junction, Mesh
from hydra_actuator.core.records import CLOSED
from hydra_actuator.verification.chains import LoneChain
from hypothesis import given
from hypothesis import strategies as st
import numpy as np
import pytest

numbers = st.floats(-10.0, 10.0)
constants = st.floats(allow_nan=False, min_value=-1e6, max_value=1e6)


def polynomial(degree: int) -> np.polynomial.Polynomial:
    return np.polynomial.Polynomial([1.3, -0.7, 0.45, 0.21][:degree + 1])


@pytest.mark.parametrize('theta', [0.0, 0.3, 0.976, 1.0, 1.4])
@pytest.mark.parametrize(('third_order', 'degree'), [(1.0, 3), (0.0, 1)])
def test_interpolation_reproduces_polynomials_of_its_order(theta, third_order, degree):
    values = polynomial(degree)(np.array([-1.0, 0.0, 1.0, 2.0]))
    assert interpolate(*values, theta, third_order) == pytest.approx(
        polynomial(degree)(theta), rel=1e-14)


@given(constants, st.floats(0.0, 2.0), st.sampled_from([0.0, 1.0]))
def test_interpolation_keeps_a_constant_to_the_bit(constant, theta, third_order):
    assert interpolate(constant, constant, constant, constant, theta, third_order) == constant


@pytest.mark.parametrize('inward', [1, -1])
@pytest.mark.parametrize(('cells', 'degree'), [(1, 1), (2, 2), (3, 3), (9, 3)])
def test_ghost_continues_the_polynomial_through_the_nodes_there_are(inward, cells, degree):
    values = np.full(12, np.nan)
    end = 1 if inward == 1 else 10
    nodes = end + inward * np.arange(cells + 1)
    values[nodes] = polynomial(degree)(nodes)
    fill_ghost(values, end, inward, cells, False)
    assert values[end - inward] == pytest.approx(polynomial(degree)(end - inward), rel=1e-12)


@pytest.mark.parametrize('inward', [1, -1])
@pytest.mark.parametrize(('cells', 'degree'), [(1, 1), (2, 2), (3, 2), (7, 2), (8, 3)])
def test_a_wave_leaving_the_end_of_a_short_line_is_continued_as_a_parabola(inward, cells, degree):
    values = np.full(12, np.nan)
    end = 1 if inward == 1 else 10
    nodes = end + inward * np.arange(cells + 1)
    values[nodes] = polynomial(degree)(nodes)
    fill_ghost(values, end, inward, cells, True)
    assert values[end - inward] == pytest.approx(polynomial(degree)(end - inward), rel=1e-12)


@given(constants, st.integers(1, 6), st.booleans())
def test_ghost_keeps_a_constant_to_the_bit(constant, cells, leaving):
    values = np.full(9, constant)
    values[0] = np.nan
    fill_ghost(values, 1, 1, cells, leaving)
    assert values[0] == constant


@kernel
def sweep_all(waves, new_waves, mesh, end, passes):
    sweep(waves, new_waves, mesh, (2, end), (1.0, passes))


def swept(wave_p: np.ndarray, wave_q: np.ndarray, friction: float = 0.0,
          passes: int = 2) -> tuple[np.ndarray, np.ndarray]:
    beyond = np.full(WIDTH - 1, np.nan)
    waves = tuple(np.append(wave, beyond) for wave in (wave_p, wave_q))
    new = tuple(np.full(wave.size, np.nan) for wave in waves)
    sweep_all(waves, new, (0.97, 3e-4, friction), wave_p.size - 2, (0,) * passes)
    return new[0][:wave_p.size], new[1][:wave_p.size]


def one_node_later(p: np.ndarray, q: np.ndarray, friction: float, passes: int) -> tuple:
    """Return P and Q of the middle of five nodes, by the formula as it is written."""
    sigma, kappa, loss = 0.97, 3e-4, friction
    here, before, after = p[2] - q[2], p[1] - q[1], p[3] - q[3]
    foot_p, foot_q = here + sigma * (before - here), here + sigma * (after - here)
    mean_p, mean_q = foot_p, foot_q
    lost_p, lost_q = foot_p * abs(foot_p), foot_q * abs(foot_q)
    theta_p, theta_q, new_p, new_q = sigma, sigma, math.nan, math.nan
    for k in range(passes):
        if k > 0:
            arrival = new_p - new_q
            foot_p = here + theta_p * (before - here)
            foot_q = here + theta_q * (after - here)
            mean_p, mean_q = 0.5 * (foot_p + arrival), 0.5 * (foot_q + arrival)
            lost_p = 0.5 * (foot_p * abs(foot_p) + arrival * abs(arrival))
            lost_q = 0.5 * (foot_q * abs(foot_q) + arrival * abs(arrival))
        theta_p, theta_q = sigma + kappa * mean_p, sigma - kappa * mean_q
        new_p = interpolate(p[3], p[2], p[1], p[0], theta_p, 1.0) - loss * lost_p
        new_q = interpolate(q[1], q[2], q[3], q[4], theta_q, 1.0) + loss * lost_q
    return new_p, new_q


@pytest.mark.parametrize('passes', [1, 2, 3])
@pytest.mark.parametrize('size', [5, 8, 9, 10, 11, 40])
def test_every_node_is_swept_by_the_formula_of_one(size, passes):
    p, q = np.random.default_rng(size).normal(size=(2, size))
    new_p, new_q = swept(p, q, 1e-3, passes)
    for i in range(2, size - 2):
        five = slice(i - 2, i + 3)
        assert (new_p[i], new_q[i]) == pytest.approx(
            one_node_later(p[five], q[five], 1e-3, passes), rel=1e-13, abs=1e-14)


@given(constants, constants)
def test_uniform_flow_without_friction_stays_to_the_bit(p, q):
    new_p, new_q = swept(np.full(12, p), np.full(12, q))
    assert (new_p[2:-2] == p).all()
    assert (new_q[2:-2] == q).all()


def test_reversing_the_waves_reverses_the_flow():
    rng = np.random.default_rng(5)
    p, q = rng.normal(size=(2, 40))
    new_p, new_q = swept(p, q, friction=1e-3)
    mirrored_p, mirrored_q = swept(q[::-1].copy(), p[::-1].copy(), friction=1e-3)
    np.testing.assert_allclose(mirrored_p[::-1][2:-2], new_q[2:-2], rtol=1e-14)
    np.testing.assert_allclose(mirrored_q[::-1][2:-2], new_p[2:-2], rtol=1e-14)


@pytest.mark.parametrize('velocity', [2.0, -2.0])
def test_friction_slows_the_oil_whichever_way_it_flows(velocity):
    dt, loss = 7.5e-6, 1.9
    p, q = np.full(12, 9.0 + velocity), np.full(12, 9.0 - velocity)
    new_p, new_q = swept(p, q, friction=loss * dt / 8.0, passes=1)
    assert 0.5 * (new_p - new_q)[5] - velocity == pytest.approx(
        -0.5 * loss * velocity * abs(velocity) * dt, rel=1e-9)
    assert 0.5 * (new_p + new_q)[5] == pytest.approx(9.0, rel=1e-15)


def test_a_wave_travels_with_the_oil():
    # P = a (x - (c + u) dt) where P - Q = 2 u is uniform but for the small slope a
    x, u, slope = np.arange(30.0), 5.0, 1e-9
    p, q = 9.0 + u + slope * x, np.full(30, 9.0 - u)
    new_p, _ = swept(p, q)
    travelled = (p - new_p)[2:-2] / slope
    assert travelled == pytest.approx(0.97 + 3e-4 * 2.0 * u, rel=1e-5)


@pytest.mark.parametrize('cells', [1, 2, 3, 4, 5, 6, 8])
@pytest.mark.parametrize('courant', [0.55, 0.8, 0.97])
def test_waves_of_a_line_of_any_cells_never_grow(cells, courant, growth):
    step = courant * 0.1 / 1300.0
    line = Domain('line', cells * 0.1, 1e-4, 1300.0)
    chain = LoneChain([line], [Junction(CLOSED, (0,)), Junction(CLOSED, (1,))],
                      Mesh(step, 0.999 / courant - 1.0))
    assert chain.state.last[0] == cells
    # where the modes do not decay their beat may rise; an unstable stencil grew by 1e-4 a step
    # and more, seven times in 20 000 steps
    assert growth(chain) <= 2.0
