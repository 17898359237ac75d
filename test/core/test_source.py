# SPDX-License-Identifier: Apache-2.0
"""The ends of the streamline: pump, relief valve, accumulator, tank, plain ends."""

import math

from hydra_actuator.core.end import End
from hydra_actuator.core.records import SOURCE_PARAMETERS
from hydra_actuator.core.source import (
    GAS_EXPONENT,
    solve_flow_end,
    solve_pressure_end,
    solve_pump,
    stored_oil,
)
from hypothesis import given
from hypothesis import strategies as st
import numpy as np
import pytest

DENSITY, SPEED, AREA = 860.0, 1300.0, 2e-4
MODULUS = DENSITY * SPEED ** 2
AMBIENT = 101325.0
SUPPLY, MOST_FLOW, STEP = 21e6, 2e-3, 1e-5
VOLUME, PRECHARGE = 1e-3, 14e6
LAW = 1e-10

pressures = st.floats(0.0, 4e7)
velocities = st.floats(-8.0, 8.0)


def end(pressure: float, velocity: float = 0.0, guess: float = 0.0) -> End:
    """Return an end whose arriving wave carries this pressure [Pa] and outflow [m/s]."""
    wave = SPEED * math.log1p(pressure / MODULUS) + velocity
    return End(wave, guess, 1.0 / SPEED, MODULUS, AREA, DENSITY * SPEED / AREA, 1.0 / AREA)


def unknown() -> np.ndarray:
    """Return what an end knows that has not been held at any pressure yet."""
    return np.full(2, np.nan)


def at(this: End, velocity: float) -> tuple[float, float]:
    """Return pressure [Pa] and outflow at reference density [m^3/s], by the exact relation."""
    compression = math.expm1((this.wave - velocity) / SPEED)
    return MODULUS * compression, velocity * AREA * (1.0 + compression)


def source(max_flow: float = MOST_FLOW, volume: float = 0.0) -> np.record:
    record = np.zeros(1, SOURCE_PARAMETERS)
    record['pressure'], record['max_flow'], record['ambient'] = SUPPLY, max_flow, AMBIENT
    record['mu'] = SPEED * math.log1p(SUPPLY / MODULUS)
    record['relative_density'] = 1.0 + SUPPLY / MODULUS
    record['accumulator_volume'], record['precharge'] = volume, PRECHARGE
    return record[0]


@given(pressures, pressures, velocities)
def test_pressure_end_holds_its_pressure(pressure, arriving, velocity):
    this = end(arriving, velocity)
    assert at(this, solve_pressure_end(this, pressure, unknown()))[0] == pytest.approx(
        pressure, rel=LAW, abs=1e-5)


@given(st.lists(st.tuples(st.sampled_from([0.0, 1e5, 2.5e6]), pressures, velocities)))
def test_what_a_pressure_end_was_held_at_before_changes_nothing(steps):
    held = unknown()
    for pressure, arriving, velocity in steps:
        this = end(arriving, velocity)
        assert solve_pressure_end(this, pressure, held) == solve_pressure_end(
            this, pressure, unknown())


def test_a_pressure_that_is_no_number_leaves_none_and_is_forgotten():
    this, held = end(1e6), unknown()
    assert math.isnan(solve_pressure_end(this, math.nan, held))
    assert solve_pressure_end(this, 2e6, held) == solve_pressure_end(this, 2e6, unknown())


@given(st.floats(-2e-3, 2e-3), pressures, velocities, velocities)
def test_flow_end_passes_its_flow(flow, arriving, velocity, guess):
    this = end(arriving, velocity, guess)
    assert at(this, solve_flow_end(this, flow))[1] == pytest.approx(flow, rel=LAW, abs=1e-18)


@given(pressures, velocities)
def test_pump_holds_pressure_or_flow_and_never_exceeds_either(arriving, velocity):
    this = end(arriving, velocity)
    pressure, outflow = at(this, solve_pump(this, source(), 0.0, STEP)[0])
    assert pressure <= SUPPLY * (1.0 + LAW)
    assert -outflow <= MOST_FLOW * (1.0 + LAW)
    assert pressure == pytest.approx(SUPPLY, rel=LAW) or -outflow == pytest.approx(
        MOST_FLOW, rel=LAW)


def test_pump_gives_its_pressure_while_the_line_takes_little():
    this = end(20e6)
    velocity, _ = solve_pump(this, source(), 0.0, STEP)
    assert at(this, velocity)[0] == pytest.approx(SUPPLY, rel=LAW)
    assert 0.0 < -at(this, velocity)[1] < MOST_FLOW


def test_pressure_falls_out_of_the_wave_at_the_pumps_largest_flow():
    this = end(5e6)
    pressure, outflow = at(this, solve_pump(this, source(), 0.0, STEP)[0])
    assert -outflow == pytest.approx(MOST_FLOW, rel=LAW)
    assert 5e6 < pressure < SUPPLY


def test_relief_valve_takes_what_flows_back():
    this = end(25e6, 1.0)
    velocity, _ = solve_pump(this, source(), 0.0, STEP)
    assert velocity > 0.0
    assert at(this, velocity)[0] == pytest.approx(SUPPLY, rel=LAW)


def test_pump_without_flow_limit_always_holds_its_pressure():
    this = end(0.0)
    pressure, outflow = at(this, solve_pump(this, source(max_flow=0.0), 0.0, STEP)[0])
    assert pressure == pytest.approx(SUPPLY, rel=LAW)
    assert -outflow > MOST_FLOW


@given(st.floats(PRECHARGE, SUPPLY))
def test_accumulator_holds_oil_as_its_gas_law_says(pressure):
    gas = VOLUME - stored_oil(pressure, source(volume=VOLUME))
    assert (pressure + AMBIENT) * gas ** GAS_EXPONENT == pytest.approx(
        (PRECHARGE + AMBIENT) * VOLUME ** GAS_EXPONENT, rel=1e-12)


def test_accumulator_below_precharge_holds_nothing():
    assert stored_oil(0.99 * PRECHARGE, source(volume=VOLUME)) == 0.0


def draw(arriving: float, oil: float, steps: int) -> tuple[np.ndarray, float]:
    """Return (pressure, outflow, oil stored) of steps under one arriving wave."""
    record, rows, velocity = source(volume=VOLUME), [], 0.0
    for _ in range(steps):
        this = end(arriving, guess=velocity)
        velocity, oil = solve_pump(this, record, oil, STEP)
        rows.append((*at(this, velocity), oil))
    return np.array(rows), record


def test_accumulator_keeps_account_of_its_oil_and_obeys_its_gas_law():
    full = stored_oil(SUPPLY, source(volume=VOLUME))
    rows, record = draw(8e6, full, 2000)
    pressure, outflow, oil = rows.T
    before = np.concatenate(([full], oil[:-1]))
    np.testing.assert_allclose(oil - before, STEP * (MOST_FLOW + outflow), rtol=1e-9, atol=1e-18)
    expected = [stored_oil(p, record) for p in pressure]
    np.testing.assert_allclose(oil, expected, rtol=1e-9)
    assert (np.diff(pressure) < 0.0).all()


def test_gas_gives_the_work_that_its_adiabate_holds():
    full = stored_oil(SUPPLY, source(volume=VOLUME))
    rows, _ = draw(8e6, full, 2000)
    pressure, _, oil = rows.T
    gas = VOLUME - oil
    absolute = pressure + AMBIENT
    work = np.sum(0.5 * (absolute[1:] + absolute[:-1]) * np.diff(gas))
    energy = (absolute * gas) / (GAS_EXPONENT - 1.0)
    assert work == pytest.approx(energy[0] - energy[-1], rel=1e-6)


def test_empty_accumulator_leaves_the_pump_alone_and_fills_again():
    rows, _ = draw(1e6, 1e-6, 1000)
    pressure, outflow, oil = rows[-1]
    assert oil == 0.0
    assert pressure <= PRECHARGE
    assert -outflow == pytest.approx(MOST_FLOW, rel=LAW)
    # a closed line: all of the pump's flow goes into the gas, until the relief valve opens
    record, oil, last = source(volume=VOLUME), 0.0, 0.0
    full = stored_oil(SUPPLY, record)
    for _ in range(20_000):
        this = end(pressure)
        velocity, oil = solve_pump(this, record, oil, STEP)
        pressure = at(this, velocity)[0]
        assert 0.0 <= oil - last <= STEP * MOST_FLOW * (1.0 + 1e-9)
        last = oil
    assert oil == full
    assert pressure == pytest.approx(SUPPLY, rel=1e-9)


@given(pressures, velocities, st.floats(0.0, 1.0))
def test_accumulator_is_never_fuller_than_at_supply_pressure(arriving, velocity, share):
    record = source(volume=VOLUME)
    full = stored_oil(SUPPLY, record)
    this = end(arriving, velocity)
    outflow, oil = solve_pump(this, record, share * full, STEP)
    assert 0.0 <= oil <= full
    assert at(this, outflow)[0] <= SUPPLY * (1.0 + LAW)
