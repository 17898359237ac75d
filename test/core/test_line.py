# SPDX-License-Identifier: Apache-2.0
"""Interpolation, ghosts and the sweep of a line, each alone."""

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


def swept(wave_p: np.ndarray, wave_q: np.ndarray, friction: float = 0.0,
          passes: int = 2) -> tuple[np.ndarray, np.ndarray]:
    mesh = (np.full(wave_p.size, 0.97), np.full(wave_p.size, 3e-4),
            np.full(wave_p.size, friction))
    new = np.full(wave_p.size, np.nan), np.full(wave_p.size, np.nan)
    sweep((wave_p, wave_q), new, mesh, 1.0, (0,) * passes)
    return new


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
