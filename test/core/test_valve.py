# SPDX-License-Identifier: Apache-2.0
"""The four edges and the spool of the servo-valve."""

import cmath
import math

from hydra_actuator.core.end import End
from hydra_actuator.core.orifice import orifice_drop, solve_orifice
from hydra_actuator.core.records import VALVE_PARAMETERS
from hydra_actuator.core.valve import (
    edge_coefficients,
    move_spool,
    solve_valve,
    spool_transition,
)
import numpy as np
import pytest

DENSITY, SPEED = 860.0, 1300.0
MODULUS = DENSITY * SPEED ** 2
STROKE, STEP = 5e-4, 1e-5
FLOW_GAIN = 0.62 * 0.03 * math.sqrt(2.0 / DENSITY)
LAW = 1e-10             # what a boundary must hold to, relative
A, B, I, J = range(4)
SOURCES, SINKS = (A, A, B, I), (B, I, J, J)
CASES = 10_000


def valve_of(**fields) -> np.record:
    valve = np.zeros(1, VALVE_PARAMETERS)
    valve['flow_gain'], valve['stroke'], valve['step_time'] = FLOW_GAIN, STROKE, STEP
    for name, value in fields.items():
        valve[name] = value
    return valve[0]


def test_a_spool_that_creeps_to_null_shuts_its_edges_at_last():
    coefficient = np.ones(4)
    edge_coefficients(valve_of(), 1e-170, -1e-162, coefficient)
    assert not coefficient.any()
    edge_coefficients(valve_of(), 1e-20, 1e-20, coefficient)
    assert coefficient[0] > 0.0
    edge_coefficients(valve_of(), math.nan, 0.0, coefficient)
    assert math.isnan(coefficient[0])


def end(pressure: float, velocity: float, area: float, guess: float) -> End:
    wave = SPEED * math.log1p(pressure / MODULUS) + velocity
    return End(wave, guess, 1.0 / SPEED, MODULUS, area, DENSITY * SPEED / area, 1.0 / area)


def random_ends(rng: np.random.Generator) -> tuple[End, ...]:
    areas = math.pi / 4.0 * rng.uniform(0.004, 0.03, 4) ** 2
    return tuple(
        end(*values) for values in zip(rng.uniform(0.0, 35e6, 4), rng.normal(0.0, 2.0, 4), areas,
                                       rng.normal(0.0, 2.0, 4)))


def random_edges(rng: np.random.Generator) -> tuple[np.ndarray, float]:
    """Return coefficients and leakage: any mixture of shut, just open, open and underlapped."""
    spools = rng.uniform(-STROKE, STROKE, 2)
    if rng.random() < 0.7:
        spools[1] = spools[0]
    coefficient = np.empty(4)
    valve = valve_of(
        overlap=rng.choice([0.0, 1e-9, 1e-5, -1e-5, -1e-4, -6e-4], 4),
        flow_gain=FLOW_GAIN * rng.choice([0.0, 1e-3, 1.0, 10.0], 4, p=[0.1, 0.1, 0.7, 0.1]))
    edge_coefficients(valve, *spools, coefficient)
    return coefficient, float(rng.choice([0.0, 0.0, 1e-16, 1e-13, 1e-11]))


def solve(ends, coefficient, leakage, ring=None) -> tuple[np.ndarray, np.ndarray]:
    """Return outflow velocities at A, B, I, J and the flows of the edges."""
    velocity, ring = np.empty(4), np.zeros((6, 4)) if ring is None else ring
    solve_valve(ends, velocity, (np.asarray(coefficient), leakage), ring)
    return velocity, ring[5]


def pressures_and_flows(ends, velocity) -> tuple[np.ndarray, np.ndarray]:
    compression = np.array([
        math.expm1((this.wave - v) / SPEED) for this, v in zip(ends, velocity)])
    areas = np.array([this.area for this in ends])
    return MODULUS * compression, velocity * areas * (1.0 + compression)


def flow_through(drop: float, coefficient: float, leakage: float) -> float:
    return leakage * drop + math.copysign(coefficient * math.sqrt(abs(drop)), drop)


def defects(ends, velocity, coefficient, leakage) -> tuple[float, float]:
    """
    Return how badly (mass, laws) hold, relative to the largest flow and the largest pressure.

    The law at a station: the change of its edges' drops that would supply what flows there.
    """
    p, q = pressures_and_flows(ends, velocity)
    scale = max(np.abs(p).max(), 1e5)
    mass = abs(q.sum()) / max(np.abs(q).max(), 1e-15)
    law = 0.0
    drops = np.array([p[SOURCES[k]] - p[SINKS[k]] for k in range(4)])
    flows = np.array([flow_through(*edge) for edge in zip(drops, coefficient, [leakage] * 4)])
    balance = np.array([flows[0] + flows[1], flows[2] - flows[0], flows[3] - flows[1],
                        -flows[2] - flows[3]])
    impedance = np.array([this.impedance for this in ends])
    for k in range(4):
        slope = max(1e-300, *(slope_of(drops[e], coefficient[e], leakage)
                              for e in range(4) if k in (SOURCES[e], SINKS[e])))
        law = max(law, abs(balance[k] - q[k]) / (slope + 1.0 / impedance[k]) / scale)
    return mass, law


def slope_of(drop: float, coefficient: float, leakage: float) -> float:
    return leakage + 0.5 * coefficient / math.sqrt(abs(drop) + 1e-12)


def test_ten_thousand_random_valves_hold_mass_and_laws():
    rng = np.random.default_rng(11)
    worst_mass, worst_law = 0.0, 0.0
    ring = np.zeros((6, 4))
    for _ in range(CASES):
        ends = random_ends(rng)
        coefficient, leakage = random_edges(rng)
        if rng.random() < 0.5:
            ring[:] = 0.0
        velocity, _ = solve(ends, coefficient, leakage, ring)
        assert np.isfinite(velocity).all()
        mass, law = defects(ends, velocity, coefficient, leakage)
        worst_mass, worst_law = max(worst_mass, mass), max(worst_law, law)
    assert worst_mass < LAW
    assert worst_law < LAW


def test_edge_flows_are_those_of_the_pressures_around_them():
    rng = np.random.default_rng(12)
    for _ in range(200):
        ends = random_ends(rng)
        coefficient = rng.uniform(0.2, 1.0, 4) * FLOW_GAIN * STROKE
        velocity, flows = solve(ends, coefficient, 1e-13)
        p, _ = pressures_and_flows(ends, velocity)
        for k in range(4):
            drop, _ = orifice_drop(flows[k], coefficient[k], 1e-13)
            assert p[SOURCES[k]] - p[SINKS[k]] == pytest.approx(
                drop, abs=LAW * np.abs(p).max())


@pytest.mark.parametrize('pairs', [((0, A, B), (3, I, J)), ((1, A, I), (2, B, J))])
def test_edges_that_share_no_station_are_single_orifices(pairs):
    ends = random_ends(np.random.default_rng(13))
    coefficient = np.zeros(4)
    for edge, _, _ in pairs:
        coefficient[edge] = FLOW_GAIN * STROKE
    velocity, _ = solve(ends, coefficient, 0.0)
    through_ring, _ = solve(ends, coefficient, 1e-25)
    for edge, source, sink in pairs:
        expected = solve_orifice(ends[source], ends[sink], coefficient[edge], 0.0)
        assert velocity[[source, sink]].tolist() == list(expected)
        assert through_ring[[source, sink]] == pytest.approx(expected, rel=1e-9)


def test_closed_valve_without_leakage_stops_all_four_stations():
    velocity, _ = solve(random_ends(np.random.default_rng(14)), np.zeros(4), 0.0)
    assert (velocity == 0.0).all()


def test_exchanging_the_ports_mirrors_the_valve():
    rng = np.random.default_rng(15)
    for _ in range(200):
        a, b, i, j = random_ends(rng)
        coefficient, leakage = random_edges(rng)
        velocity, _ = solve((a, b, i, j), coefficient, leakage)
        mirrored, _ = solve((a, i, b, j), coefficient[[1, 0, 3, 2]], leakage)
        assert mirrored[[A, I, B, J]] == pytest.approx(velocity, rel=1e-8, abs=1e-9)


def test_a_warm_start_changes_nothing_that_matters():
    ends = random_ends(np.random.default_rng(16))
    coefficient = np.array([1.0, 0.3, 0.2, 0.9]) * FLOW_GAIN * STROKE
    ring = np.zeros((6, 4))
    cold, _ = solve(ends, coefficient, 1e-13, ring)
    warm, _ = solve(ends, coefficient, 1e-13, ring)
    np.testing.assert_allclose(warm, cold, rtol=1e-9, atol=1e-11)


def test_edges_open_beyond_their_overlap_each_on_its_side():
    valve, coefficient = valve_of(overlap=[1e-5, 2e-5, -1e-5, 0.0]), np.empty(4)
    edge_coefficients(valve, 5e-5, 5e-5, coefficient)
    assert coefficient / FLOW_GAIN == pytest.approx([4e-5, 0.0, 0.0, 5e-5])
    edge_coefficients(valve, -5e-5, -5e-5, coefficient)
    assert coefficient / FLOW_GAIN == pytest.approx([0.0, 3e-5, 6e-5, 0.0])
    edge_coefficients(valve, 0.0, 0.0, coefficient)
    assert coefficient / FLOW_GAIN == pytest.approx([0.0, 0.0, 1e-5, 0.0])


def test_the_first_spool_meters_port_b_and_the_second_port_i():
    valve, coefficient = valve_of(), np.empty(4)
    edge_coefficients(valve, 2e-4, -1e-4, coefficient)
    assert coefficient / FLOW_GAIN == pytest.approx([2e-4, 1e-4, 0.0, 0.0])
    edge_coefficients(valve, -2e-4, 1e-4, coefficient)
    assert coefficient / FLOW_GAIN == pytest.approx([0.0, 0.0, 2e-4, 1e-4])


def test_gains_scale_the_edges_and_zero_blocks_one():
    valve = valve_of(flow_gain=[0.0, FLOW_GAIN, FLOW_GAIN, 2.0 * FLOW_GAIN])
    coefficient = np.empty(4)
    edge_coefficients(valve, 1e-4, 1e-4, coefficient)
    assert coefficient / FLOW_GAIN == pytest.approx([0.0, 0.0, 0.0, 2e-4])


def second_order(frequency: float, damping: float, **fields) -> np.record:
    return valve_of(natural_frequency=frequency,
                    transition=spool_transition(frequency, damping, STEP).ravel(), **fields)


@pytest.mark.parametrize('damping', [0.1, 0.7, 0.999, 1.5, 4.0])
@pytest.mark.parametrize('frequency', [20.0, 200.0, 3000.0])
def test_spool_follows_the_step_response_of_second_order(frequency, damping):
    valve, omega = second_order(frequency, damping), 2.0 * math.pi * frequency
    root = cmath.sqrt(damping ** 2 - 1.0)
    fast, slow = omega * (-damping - root), omega * (-damping + root)
    position, velocity, command = 0.0, 0.0, 1e-4
    for step in range(1, 300):
        position, velocity = move_spool(valve, position, velocity, command)
        t = step * STEP
        exact = 1.0 + (slow * cmath.exp(fast * t) - fast * cmath.exp(slow * t)) / (fast - slow)
        speed = fast * slow * (cmath.exp(fast * t) - cmath.exp(slow * t)) / (fast - slow)
        assert position == pytest.approx(command * exact.real, rel=1e-9, abs=1e-15)
        assert velocity == pytest.approx(command * speed.real, rel=1e-9, abs=1e-15 * omega)


def test_critically_damped_spool_follows_its_step_response():
    frequency, command = 200.0, 1e-4
    valve, omega = second_order(frequency, 1.0), 2.0 * math.pi * frequency
    position, velocity = 0.0, 0.0
    for step in range(1, 300):
        position, velocity = move_spool(valve, position, velocity, command)
        phase = omega * step * STEP
        assert position == pytest.approx(
            command * (1.0 - (1.0 + phase) * math.exp(-phase)), rel=1e-10, abs=1e-17)


def test_ideal_spool_is_where_it_is_commanded():
    valve = valve_of()
    assert move_spool(valve, 1e-4, 0.0, 3e-4) == (3e-4, pytest.approx(2e-4 / STEP))


@pytest.mark.parametrize('frequency', [0.0, 400.0])
def test_slew_rate_limits_the_way_of_each_step(frequency):
    rate = 0.05
    valve = second_order(frequency, 0.7, slew_rate=rate) if frequency else valve_of(slew_rate=rate)
    position, velocity = 0.0, 0.0
    for _ in range(3000):
        before = position
        position, velocity = move_spool(valve, position, velocity, 4e-4)
        assert abs(position - before) <= rate * STEP * (1.0 + 1e-12)
        assert abs(velocity) <= rate
    assert position == pytest.approx(4e-4, rel=1e-6)


def test_slew_limited_ideal_spool_moves_at_exactly_its_rate():
    valve, position, velocity = valve_of(slew_rate=0.05), 0.0, 0.0
    for _ in range(100):
        position, velocity = move_spool(valve, position, velocity, -4e-4)
    assert position == pytest.approx(-100 * 0.05 * STEP, rel=1e-12)
    assert velocity == -0.05


@pytest.mark.parametrize('damping', [0.05, 0.7])
@pytest.mark.parametrize('command', [STROKE, -STROKE, 3.0 * STROKE])
def test_spool_stays_within_its_stroke(damping, command):
    valve, position, velocity = second_order(300.0, damping), 0.0, 0.0
    for _ in range(2000):
        position, velocity = move_spool(valve, position, velocity, command)
        assert abs(position) <= STROKE
    assert position == pytest.approx(math.copysign(STROKE, command), rel=0.02)


def test_a_command_that_is_no_number_leaves_none():
    for valve in (valve_of(), second_order(300.0, 0.7)):
        position, _ = move_spool(valve, 0.0, 0.0, math.nan)
        assert math.isnan(position)
        coefficient = np.empty(4)
        edge_coefficients(valve, position, position, coefficient)
        assert np.isnan(coefficient).all()
