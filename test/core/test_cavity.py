# SPDX-License-Identifier: Apache-2.0
"""Free gas at a node: the balance of oil and gas, alone and in a line."""

import math

from hydra_actuator.core.cavity import (
    fill_cavities,
    gas_balance,
    ROUNDS_AT_END,
    ROUNDS_INSIDE,
    STRAIGHT,
)
from hydra_actuator.core.compilation import kernel
from hydra_actuator.core.lanes import WIDTH
from hydra_actuator.core.model import Domain, Junction, Mesh
from hydra_actuator.core.oil import Oil
from hydra_actuator.core.records import CLOSED, PRESSURE
from hydra_actuator.verification.chains import LoneChain
from hypothesis import given
from hypothesis import strategies as st
import numpy as np
import pytest

DENSITY, SPEED = 860.0, 1300.0
MODULUS = DENSITY * SPEED ** 2
FLOOR = 101325.0 - 10.0
OIL = (1.0 / SPEED, MODULUS)


@given(st.floats(-2e7, 6e7), st.floats(-7.0, -1.0), st.floats(1.0, 8.0))
def test_oil_and_gas_agree_on_one_pressure(pressure, exponent, star_exponent):
    strength = 0.5 * SPEED * 10.0 ** exponent * FLOOR
    held = min(strength / 10.0 ** star_exponent, 2.0 * SPEED)
    free = SPEED * math.log1p(pressure / MODULUS)
    mu, star = gas_balance((free, held), strength, FLOOR, OIL, ROUNDS_AT_END)
    assert star > 0.0
    assert mu == pytest.approx(free - held + strength / star, rel=1e-9, abs=1e-9)
    assert MODULUS * math.expm1(mu / SPEED) + FLOOR == pytest.approx(star, rel=1e-6, abs=1e-3)


@given(st.floats(5e5, 4e7), st.floats(1e-7, 1e-3))
def test_a_balance_that_stops_early_is_the_one_of_all_rounds(pressure, air_fraction):
    strength = 0.5 * SPEED * air_fraction * FLOOR
    waves = (SPEED * math.log1p(pressure / MODULUS), strength / (0.99 * (pressure + FLOOR)))
    early = gas_balance(waves, strength, FLOOR, OIL, ROUNDS_AT_END)
    full = gas_balance(waves, strength, FLOOR, OIL, ROUNDS_AT_END + 3)
    assert early == pytest.approx(full, rel=1e-12)


def test_nodes_side_by_side_balance_as_each_alone():
    chain, chance = line(1e-3, 1e6, 23, 0.975), np.random.default_rng(7)
    model, state = chain.model, chain.state
    inside = slice(model.start[0] + 1, model.start[0] + state.last[0])
    count = inside.stop - inside.start
    state.new_p[inside], state.new_q[inside] = chance.uniform(-60.0, 20.0, (2, count))
    state.star[inside] = 10.0 ** chance.uniform(1.0, 7.0, count)
    before = [state.new_p[inside].tolist(), state.new_q[inside].tolist(),
              state.star[inside].tolist(), state.strength[inside].tolist()]
    assert all(before[3]) and count % WIDTH
    fill(model, state)
    oil = float(model.slowness[0]), float(model.bulk_modulus[0])
    for k, (p, q, star, strength) in enumerate(zip(*before)):
        mu, star = gas_balance((0.5 * (p + q), strength / star), strength, model.floor, oil,
                               ROUNDS_INSIDE)
        node = inside.start + k
        assert state.star[node] == pytest.approx(star, rel=1e-9)
        assert state.new_p[node] == pytest.approx(2.0 * mu - q, rel=1e-9, abs=1e-9)
        assert state.new_q[node] == pytest.approx(2.0 * mu - p, rel=1e-9, abs=1e-9)


def test_nodes_that_stop_after_one_round_are_those_of_all_rounds():
    chain, chance = line(1e-3, 1e6, 64, 0.975), np.random.default_rng(5)
    model, state = chain.model, chain.state
    inside = slice(model.start[0] + 1, model.start[0] + state.last[0])
    star = 10.0 ** chance.uniform(4.0, 7.6, 63)
    oil = float(model.slowness[0]), float(model.bulk_modulus[0])
    # what the gas may take up for the oil's pressure to be a straight line, and some that may not
    way = STRAIGHT / oil[0] * chance.choice([-0.9, 0.5, 0.1, 1.5], 63)
    strength = state.strength[inside]
    mu = SPEED * np.log1p((star - model.floor) / MODULUS)
    state.new_p[inside] = state.new_q[inside] = mu + way * (1.0 + star ** 2 / (
        strength * MODULUS / SPEED))
    state.star[inside] = star
    waves = 0.5 * (state.new_p + state.new_q)[inside], strength / star
    fill(model, state)
    for k, node in enumerate(range(inside.start, inside.stop)):
        full, pressure = gas_balance((float(waves[0][k]), float(waves[1][k])), float(strength[k]),
                                     model.floor, oil, 6)
        assert state.star[node] == pytest.approx(pressure, rel=1e-11)
        assert 0.5 * (state.new_p + state.new_q)[node] == pytest.approx(
            2.0 * full - waves[0][k], rel=1e-12, abs=1e-12)


@pytest.mark.parametrize('cells', range(2, 2 * WIDTH + 2))
def test_what_lies_beyond_the_nodes_with_gas_is_left_alone(cells):
    chain, chance = line(1e-3, 1e6, cells, 0.975), np.random.default_rng(cells)
    model, state = chain.model, chain.state
    assert state.last[0] == cells
    arrays = state.new_p, state.new_q, state.star
    for array in arrays:
        array[:] = chance.uniform(1e5, 1e6, array.size)
    before = [array.copy() for array in arrays]
    fill(model, state)
    inside = np.zeros(state.star.size, bool)
    inside[model.start[0] + 1:model.start[0] + cells] = True
    for now, then in zip(arrays, before):
        assert np.array_equal(now != then, inside)


def test_without_gas_the_oil_keeps_its_wave():
    mu, _ = gas_balance((7.0, 0.0), 0.0, FLOOR, OIL, ROUNDS_AT_END)
    assert mu == pytest.approx(7.0, rel=1e-12)


@kernel
def fill(model, state):
    """Call what only compiled code can."""
    fill_cavities(model, state)


def line(air_fraction: float, pressure: float, cells: int, courant: float) -> LoneChain:
    step = 2.0 / cells * courant / SPEED
    return LoneChain(
        [Domain('line', 2.0, 2e-4, SPEED, pressure=pressure)],
        [Junction(PRESSURE, (0,), 0), Junction(CLOSED, (1,))],
        Mesh(step, 1.0 / courant - 1.0), oil=Oil(DENSITY, 0.0, air_fraction, FLOOR))


@pytest.mark.parametrize('courant', [0.7, 0.975])
@pytest.mark.parametrize(('air_fraction', 'pressure'), [(1e-3, 1e6), (1e-2, 5e6), (1e-4, 2e5)])
def test_gas_lowers_the_wave_speed_as_the_formula_says(air_fraction, pressure, courant):
    chain = line(air_fraction, pressure, 200, courant)
    star = pressure + FLOOR
    # gas at the node: alpha0 (ambient - p_v) / p* by volume, stiffness p*
    share = air_fraction * FLOOR / star
    ratio = 1.0 + pressure / MODULUS
    slowed = SPEED / math.sqrt(1.0 + DENSITY * ratio * SPEED ** 2 * share / star)
    frequency = slowed / (4.0 * 2.0)
    step, trace = chain.model.step_time, []
    chain.hold(pressure * (1.0 + 1e-7))
    for _ in range(round(6.0 / frequency / step)):
        chain.advance()
        trace.append(chain.end_pressure(1) - pressure * (1.0 + 1e-7))
    trace = np.array(trace)
    rising = np.flatnonzero((trace[:-1] < 0.0) & (trace[1:] >= 0.0))
    instants = rising + trace[rising] / (trace[rising] - trace[rising + 1])
    period = np.diff(instants).mean() * step
    assert 1.0 / period == pytest.approx(frequency, rel=1e-3)


def test_pulled_oil_opens_cavities_and_stays_above_vapour_pressure():
    chain = line(1e-5, 1e5, 100, 0.975)
    chain.hold(1e5)
    chain.advance(50)
    lowest = np.inf
    for k in range(400):
        chain.hold(1e5 if k > 200 else -1e5)
        chain.advance(5)
        lowest = min(lowest, chain.end_pressure(1), float(chain.state.star[2:103].min()) - FLOOR)
    assert -FLOOR < lowest < -0.9 * FLOOR


@given(st.floats(-2.0, 0.3), st.floats(-7.0, -1.0), st.floats(0.0, 8.0))
def test_oil_pulled_far_beyond_what_it_bears_boils(pull, exponent, star_exponent):
    strength = 0.5 * SPEED * 10.0 ** exponent * FLOOR
    held = strength / 10.0 ** star_exponent
    free = pull * SPEED
    mu, star = gas_balance((free, held), strength, FLOOR, OIL, ROUNDS_AT_END)
    assert 0.0 < star < math.inf
    assert mu == pytest.approx(free - held + strength / star, rel=1e-9, abs=1e-6)
    if free - held < -1.0:
        # what the oil cannot follow is gas, at less than ambient pressure
        assert star < FLOOR
