# SPDX-License-Identifier: Apache-2.0
"""The oil's equation of state and what an end makes of it."""

import math

from hydra_actuator.core.end import End, end_relation
from hydra_actuator.core.fluid import (
    pressure_of,
    relative_compression,
    riemann_variable,
    SERIES_LIMIT,
)
from hypothesis import given
from hypothesis import strategies as st
import pytest

DENSITY, SPEED = 860.0, 1300.0
MODULUS = DENSITY * SPEED ** 2
AREA = 2e-4
ROUNDING = 4e-16

compressions = st.floats(-0.5, 0.5)
pressures = st.floats(-1e5, 1e9)
waves = st.floats(0.0, 20.0)
velocities = st.floats(-13.0, 13.0)


def end(wave: float, velocity: float = 0.0) -> End:
    return End(wave, velocity, 1.0 / SPEED, MODULUS, AREA, DENSITY * SPEED / AREA, 1.0 / AREA)


@given(compressions)
def test_compression_is_the_exponential_less_one(z):
    assert relative_compression(z) == pytest.approx(math.expm1(z), rel=ROUNDING, abs=0.0)


def test_the_series_joins_the_function_without_a_step():
    for limit in (SERIES_LIMIT, -SERIES_LIMIT):
        beyond = math.nextafter(limit, math.copysign(1.0, limit))
        step = relative_compression(beyond) - relative_compression(limit)
        assert abs(step) <= 2e-16 * abs(limit) + abs(beyond - limit) * 1.1


def test_nothing_compressed_is_exactly_nothing():
    assert relative_compression(0.0) == 0.0
    assert riemann_variable(0.0, SPEED, MODULUS) == 0.0


@given(pressures)
def test_pressure_and_riemann_variable_are_inverse(pressure):
    mu = riemann_variable(pressure, SPEED, MODULUS)
    assert pressure_of(mu, SPEED, MODULUS) == pytest.approx(pressure, rel=1e-14, abs=1e-7)


def test_riemann_variable_is_the_integral_of_dp_over_rho_c():
    # at 21 MPa by the midpoint rule, 1000 strips
    strips, top = 1000, 21e6
    integral = sum(
        top / strips / (DENSITY * (1.0 + (k + 0.5) * top / strips / MODULUS) * SPEED)
        for k in range(strips))
    assert riemann_variable(top, SPEED, MODULUS) == pytest.approx(integral, rel=1e-9)


@given(waves, velocities)
def test_end_answers_with_the_pressure_and_mass_flow_of_its_wave(wave, velocity):
    pressure, flow, _, _ = end_relation(end(wave), velocity)
    ratio = math.exp((wave - velocity) / SPEED)
    assert pressure == pytest.approx(MODULUS * (ratio - 1.0), rel=1e-12, abs=1e-5)
    # below 1e-300 numbers lose digits one by one
    assert flow == pytest.approx(velocity * AREA * ratio, rel=1e-14, abs=1e-300)


@given(waves, velocities)
def test_impedance_and_flatness_are_the_slopes_of_the_relation(wave, velocity):
    _, _, impedance, flatness = end_relation(end(wave), velocity)
    ratio, mach = math.exp((wave - velocity) / SPEED), velocity / SPEED
    assert impedance == pytest.approx(DENSITY * SPEED / AREA / (1.0 - mach), rel=1e-6)
    assert flatness == pytest.approx(1.0 / (AREA * ratio * (1.0 - mach)), rel=1e-6)
