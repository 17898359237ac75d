# SPDX-License-Identifier: Apache-2.0
"""The mesh between a fixed end and a moving face, formula by formula."""

import math

from hydra_actuator.core.chamber import (
    extend_to_face,
    NEAREST,
    wave_at_face,
    wave_from_face,
)
from hydra_actuator.core.model import Domain, Junction, Mesh
from hydra_actuator.core.records import CLOSED, WALL
from hydra_actuator.verification.chains import LoneChain
from hypothesis import given
from hypothesis import strategies as st
import numpy as np
import pytest

LAST = 5
GHOSTS = 3
constants = st.floats(-1e6, 1e6)


def polynomial(degree: int) -> np.polynomial.Polynomial:
    return np.polynomial.Polynomial([1.3, -0.7, 0.45, 0.21][:degree + 1])


def extended(shape, cells: int, fraction: float, leaving: bool = False) -> np.ndarray:
    """Return nodes from the last whole one's (cells)th neighbour on, ghosts filled."""
    values = np.full(LAST + 1 + GHOSTS, np.nan)
    offsets = np.arange(-cells, 1)
    values[LAST + offsets] = shape(offsets)
    extend_to_face(values, LAST, cells, (float(shape(fraction)), fraction), leaving)
    return values


@pytest.mark.parametrize('fraction', [0.0, 0.2, 0.499, 0.5, 0.75, 0.999])
@pytest.mark.parametrize(('cells', 'degree'), [(1, 1), (2, 2), (3, 3), (5, 3)])
def test_ghosts_continue_a_polynomial_of_the_stencils_order(cells, degree, fraction):
    shape = polynomial(degree)
    values = extended(shape, cells, fraction)
    ghosts = np.arange(1, GHOSTS + 1)
    assert values[LAST + ghosts] == pytest.approx(shape(ghosts), rel=1e-12)


@pytest.mark.parametrize('fraction', [0.0, 0.2, 0.399])
def test_a_wave_leaving_the_near_face_of_a_short_chamber_is_continued_as_a_parabola(fraction):
    shape = polynomial(2)
    ghosts = np.arange(1, GHOSTS + 1)
    values = extended(shape, 5, fraction, leaving=True)
    assert values[LAST + ghosts] == pytest.approx(shape(ghosts), rel=1e-12)
    cubic = extended(polynomial(3), 5, fraction, leaving=True)
    assert cubic[LAST + 1] != pytest.approx(polynomial(3)(1), rel=1e-3)


@given(constants, st.integers(1, 5), st.floats(0.0, 0.999))
def test_ghosts_keep_a_constant_to_the_bit(constant, cells, fraction):
    values = extended(lambda x: 0.0 * np.asarray(x) + constant, cells, fraction)
    assert (values[LAST - cells:] == constant).all()


@pytest.mark.parametrize('fraction', [1e-12, 1e-6, 0.3, 0.5, 0.9])
def test_an_error_at_the_face_is_amplified_by_its_weight_where_nearest_at_most(fraction):
    clean = extended(polynomial(3), 4, fraction)
    values = clean.copy()
    extend_to_face(values, LAST, 4, (float(polynomial(3)(fraction)) + 1e-9, fraction), False)
    # Lagrange's weight of the face at the third ghost, the face as near as it counts
    weight = (3.0 * 4.0 * 5.0) / (NEAREST * (NEAREST + 1.0) * (NEAREST + 2.0))
    assert np.abs(values - clean)[LAST:].max() <= 1.001e-9 * weight


@pytest.mark.parametrize('lag', [0.0, 0.2, 0.97, 1.5, 2.3])
@pytest.mark.parametrize(('third_order', 'degree'), [(1.0, 2), (0.0, 1)])
def test_path_of_the_face_is_exact_for_polynomials_in_time(lag, third_order, degree):
    shape = polynomial(degree)
    history = np.append(shape(np.array([1.0, 2.0])), np.nan)
    assert wave_from_face(history, float(shape(0.0)), lag, third_order) == pytest.approx(
        shape(lag), rel=1e-12)


@given(constants, st.floats(0.0, 1.5))
def test_path_of_the_face_keeps_a_constant_to_the_bit(constant, lag):
    assert wave_from_face(np.full(3, constant), constant, lag, 1.0) == constant


@pytest.mark.parametrize('distance', [0.0, 0.4, 0.99, 1.02])
def test_wave_that_reaches_the_face_left_where_c_plus_u_says(distance):
    # P - Q = 2 u uniform; P grows along the chamber by a slope too small to matter to u
    sigma, kappa, u, slope = 0.97, 1e-4, 3.0, 1e-8
    x = np.arange(10.0)
    waves = 9.0 + u + slope * x, np.full(10, 9.0 - u)
    mesh = np.full(10, sigma), np.full(10, kappa), np.zeros(10)
    foot = distance - sigma - kappa * 2.0 * u
    for guess in ((math.nan, math.nan), (u, math.nan)):
        wave, theta = wave_at_face(waves, 6, distance, mesh, 1.0, guess)
        assert theta == pytest.approx(sigma + kappa * 2.0 * u, rel=1e-7)
        assert wave - 9.0 - u == pytest.approx(slope * (6.0 + foot), rel=1e-6)


SPEED, CELL = 1300.0, 0.01
STEP = CELL / (1.025 * SPEED)


def chamber_with_wall() -> LoneChain:
    domain = Domain('chamber', 10.3 * CELL, 1e-3, SPEED, pressure=1e7, longest=20.0 * CELL)
    return LoneChain([domain], [Junction(CLOSED, (0,)), Junction(WALL, (1,))],
                     Mesh(STEP, 0.025))


@pytest.mark.parametrize('velocity', [3.0, -3.0])
def test_whole_cells_come_and_go_with_the_face(velocity):
    chain = chamber_with_wall()
    start = chain.state.length[0]
    for _ in range(1500):
        chain.step(velocity)
        length = chain.state.length[0]
        assert chain.state.last[0] == int(length / chain.model.spacing[0])
    # the wall's speed rises from 0 within the first step
    assert length - start == pytest.approx(velocity * STEP * (1500 - 0.5), rel=1e-9)
    assert abs(chain.state.last[0] - 10) >= 3


def test_gas_free_oil_at_rest_with_a_wall_at_rest_keeps_its_waves_to_rounding():
    chain = chamber_with_wall()
    before = chain.waves(0)
    chain.advance(5000)
    for now, then in zip(chain.waves(0), before):
        np.testing.assert_allclose(now, then, rtol=1e-14)


@pytest.mark.parametrize('cells', [1, 2, 3, 4, 5, 6, 8, 12])
@pytest.mark.parametrize('fraction', [0.05, 0.39, 0.41, 0.47, 0.49, 0.55, 0.9])
def test_waves_of_a_chamber_of_any_length_never_grow(cells, fraction, growth):
    domain = Domain('chamber', (cells + fraction) * CELL, 1e-3, SPEED, longest=20.0 * CELL)
    chain = LoneChain([domain], [Junction(CLOSED, (0,)), Junction(WALL, (1,))],
                      Mesh(STEP, 0.025))
    # where the modes do not decay their beat may rise; an unstable stencil grew by 1e-4 a step
    # and more, seven times in 20 000 steps
    assert growth(chain) <= 2.0

