# SPDX-License-Identifier: Apache-2.0
"""One orifice law: its limits, its symmetry, its residual, and two ends joined by it."""

from decimal import Decimal, getcontext
import math

from hydra_actuator.core.end import End
from hydra_actuator.core.orifice import orifice_drop, orifice_flow, solve_orifice
from hypothesis import given
from hypothesis import strategies as st
import pytest

DENSITY, SPEED = 860.0, 1300.0
MODULUS = DENSITY * SPEED ** 2
LAW = 1e-10             # what a boundary must hold to, relative
ROUNDING = 1e-15

differences = st.floats(1e-9, 1e8)
impedances = st.floats(1e8, 1e11)
coefficients = st.floats(1e-12, 1e-4)
leakages = st.floats(1e-16, 1e-9)
pressures = st.floats(0.0, 4e7)
areas = st.floats(1e-5, 1e-2)


def end(pressure: float, velocity: float, area: float, guess: float = 0.0) -> End:
    """Return an end whose arriving wave carries this pressure [Pa] and velocity [m/s]."""
    wave = SPEED * math.log1p(pressure / MODULUS) + velocity
    return End(wave, guess, 1.0 / SPEED, MODULUS, area, DENSITY * SPEED / area, 1.0 / area)


def at(this: End, velocity: float) -> tuple[float, float]:
    """Return pressure [Pa] and flow at reference density [m^3/s], by the exact relation."""
    compression = math.expm1((this.wave - velocity) / SPEED)
    return MODULUS * compression, velocity * this.area * (1.0 + compression)


@given(differences, coefficients)
def test_without_impedance_it_is_the_square_root_law(difference, coefficient):
    assert orifice_flow(difference, 0.0, coefficient, 0.0) == pytest.approx(
        coefficient * math.sqrt(difference), rel=ROUNDING)


@given(differences, impedances)
def test_infinitely_wide_it_joins_the_lines(difference, impedance):
    assert orifice_flow(difference, impedance, 1e9, 0.0) == pytest.approx(
        difference / impedance, rel=1e-6)


@given(differences, impedances, coefficients, st.sampled_from([0.0, 1e-12, 1e-9]))
def test_flow_is_odd_in_the_difference(difference, impedance, coefficient, leakage):
    forth = orifice_flow(difference, impedance, coefficient, leakage)
    assert orifice_flow(-difference, impedance, coefficient, leakage) == -forth


@given(impedances, coefficients)
def test_slope_at_zero_is_finite_and_that_of_the_lines(impedance, coefficient):
    assert orifice_flow(0.0, impedance, coefficient, 0.0) == 0.0
    tiny = 1e-6 * (impedance * coefficient) ** 2
    assert orifice_flow(tiny, impedance, coefficient, 0.0) / tiny == pytest.approx(
        1.0 / impedance, rel=2e-6)


@given(differences, impedances, coefficients)
def test_flow_is_right_to_the_last_bits(difference, impedance, coefficient):
    getcontext().prec = 60
    d, z, k = Decimal(difference), Decimal(impedance), Decimal(coefficient)
    half = k * z / 2
    exact = k * d / (half + (half * half + d).sqrt())
    assert orifice_flow(difference, impedance, coefficient, 0.0) == pytest.approx(
        float(exact), rel=ROUNDING)


@given(differences, impedances, coefficients, leakages)
def test_leakage_adds_to_the_flow_at_the_same_drop(difference, impedance, coefficient, leakage):
    flow = orifice_flow(difference, impedance, coefficient, leakage)
    getcontext().prec = 60
    root = 2 * Decimal(difference) / (
        Decimal(impedance) * Decimal(coefficient)
        + ((Decimal(impedance) * Decimal(coefficient)) ** 2
           + 4 * (1 + Decimal(impedance) * Decimal(leakage)) * Decimal(difference)).sqrt())
    assert flow == pytest.approx(
        float(Decimal(leakage) * root * root + Decimal(coefficient) * root), rel=ROUNDING)
    drop = float(root * root)
    assert drop + impedance * flow == pytest.approx(difference, rel=1e-12)


@given(st.floats(1e-12, 1e-2), coefficients, st.sampled_from([0.0, 1e-13, 1e-9]),
       st.sampled_from([-1.0, 1.0]))
def test_drop_is_the_inverse_of_the_law_and_slope_its_derivative(flow, coefficient, leakage, sign):
    drop, slope = orifice_drop(sign * flow, coefficient, leakage)
    assert drop * sign > 0.0
    root = math.sqrt(abs(drop))
    assert leakage * drop + coefficient * sign * root == pytest.approx(sign * flow, rel=1e-13)
    assert slope == pytest.approx(1.0 / (leakage + 0.5 * coefficient / root), rel=1e-12)


def test_drop_has_a_finite_slope_at_zero_flow():
    assert orifice_drop(0.0, 1e-6, 0.0) == (0.0, 0.0)
    drop, slope = orifice_drop(0.0, 0.0, 1e-12)
    assert drop == 0.0
    assert slope == pytest.approx(1e12)


@given(pressures, pressures, areas, areas, st.floats(1e-10, 1e-4), st.floats(-5.0, 5.0))
def test_law_and_mass_hold_between_two_ends(p_1, p_2, area_1, area_2, coefficient, guess):
    ends = end(p_1, 0.3, area_1, guess), end(p_2, -0.2, area_2, -guess)
    v_1, v_2 = solve_orifice(*ends, coefficient, 0.0)
    (p_1, q_1), (p_2, q_2) = at(ends[0], v_1), at(ends[1], v_2)
    assert q_1 == pytest.approx(-q_2, rel=LAW, abs=1e-18)
    drop = q_1 * abs(q_1) / coefficient ** 2
    assert p_1 - p_2 == pytest.approx(drop, abs=LAW * max(abs(p_1), abs(p_2), 1e5))


@given(pressures, pressures, areas, areas, st.floats(1e-10, 1e-4))
def test_exchanging_the_ends_exchanges_the_velocities(p_1, p_2, area_1, area_2, coefficient):
    end_1, end_2 = end(p_1, 0.3, area_1), end(p_2, -0.2, area_2)
    there = solve_orifice(end_1, end_2, coefficient, 1e-12)
    back = solve_orifice(end_2, end_1, coefficient, 1e-12)
    assert there == pytest.approx(back[::-1], rel=1e-12, abs=1e-15)


def test_closed_orifice_stops_the_oil_exactly():
    assert solve_orifice(end(1e7, 0.5, 1e-4), end(0.0, 0.5, 1e-4), 0.0, 0.0) == (0.0, 0.0)


def test_equal_pressures_at_rest_stay_at_rest():
    this = end(1.05e7, 0.0, 1e-4)
    # the rounding of one product, 1e-9 Pa, over rho c
    assert solve_orifice(this, this, 1e-5, 1e-12) == pytest.approx((0.0, 0.0), abs=2e-15)
