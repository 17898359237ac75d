# SPDX-License-Identifier: Apache-2.0
"""
The valve: several edges open at once against a solution of another kind, and two spools.

Four pressures around the ring A, B, I, J; at each station the flow of its line at reference
density, v A (1 + p/chi) with v = W - mu(p), equals what its edges take. A balance is monotone in
its own pressure, and stays so where others are solved along: bisect B and I inside A inside J,
without a derivative, a flow as unknown or any line of the solver's.
"""

from hydra_actuator.actuator import Actuator
from hydra_actuator.core.end import End
from hydra_actuator.core.valve import solve_valve
from hydra_actuator.parameters import Parameters
from hydra_actuator.verification.case import Case, Row
from hydra_actuator.verification.chains import (
    BULK_MODULUS,
    DENSITY,
    pressure_of,
    riemann_variable,
    WAVE_SPEED,
)
import numpy as np

RINGS = 200
LOWEST, HIGHEST, HALVINGS = -10e6, 50e6, 44


def random_rings() -> tuple[np.ndarray, ...]:
    """Return arriving waves [m/s] and areas [m^2] (4, N), K' (4, N) and leakage (N,) of rings."""
    rng = np.random.default_rng(5)
    waves = riemann_variable(rng.uniform(1e6, 30e6, (4, RINGS))) + rng.normal(0.0, 1.0, (4, RINGS))
    areas = 0.25 * np.pi * rng.uniform(0.008, 0.02, (4, RINGS)) ** 2
    openings = rng.uniform(0.0, 5e-4, (4, RINGS)) * (rng.random((4, RINGS)) < 0.8)
    gains = 0.62 * 0.03 * np.sqrt(2.0 / DENSITY) * openings
    return waves, areas, gains, rng.choice([1e-14, 1e-12, 1e-11], RINGS)


def edge_flow(drop: np.ndarray, gain: np.ndarray, leakage: np.ndarray) -> np.ndarray:
    """Return the flow [m^3/s] of an edge at a pressure drop [Pa]."""
    return leakage * drop + gain * np.sign(drop) * np.sqrt(np.abs(drop))


def brought(wave: np.ndarray, area: np.ndarray, pressure: np.ndarray) -> np.ndarray:
    """Return the flow [m^3/s] that a line brings to its end at a pressure [Pa]."""
    return (wave - riemann_variable(pressure)) * area * (1.0 + pressure / BULK_MODULUS)


def bisect(excess, shape: tuple[int, ...]) -> np.ndarray:
    """Return the pressures [Pa] at which a falling excess of inflow (of that shape) is zero."""
    low, high = np.full(shape, LOWEST), np.full(shape, HIGHEST)
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        above = excess(middle) > 0.0
        low, high = np.where(above, middle, low), np.where(above, high, middle)
    return 0.5 * (low + high)


def solve_by_bisection(rings: tuple[np.ndarray, ...]) -> np.ndarray:
    """Return the pressures [Pa] (4, N) around all rings."""
    waves, areas, gains, leakage = rings
    from_a, to_j, ports = gains[:2], gains[2:], slice(1, 3)

    def at_ports(p_a: np.ndarray, p_j: np.ndarray) -> np.ndarray:
        return bisect(lambda p: brought(waves[ports], areas[ports], p)
                      - edge_flow(p - p_a, from_a, leakage) - edge_flow(p - p_j, to_j, leakage),
                      (2, RINGS))

    def at_a(p_j: np.ndarray) -> np.ndarray:
        return bisect(lambda p: brought(waves[0], areas[0], p)
                      - edge_flow(p - at_ports(p, p_j), from_a, leakage).sum(axis=0), (RINGS,))

    p_j = bisect(lambda p: brought(waves[3], areas[3], p)
                 - edge_flow(p - at_ports(at_a(p), p), to_j, leakage).sum(axis=0), (RINGS,))
    p_a = at_a(p_j)
    return np.vstack((p_a, at_ports(p_a, p_j), p_j))


def solve_by_valve(rings: tuple[np.ndarray, ...]) -> np.ndarray:
    """Return the same by the solver's valve, from rest."""
    waves, areas, gains, leakage = rings
    pressures = np.empty((4, RINGS))
    velocity = np.empty(4)
    for n in range(RINGS):
        ends = tuple(
            End(float(waves[k, n]), 0.0, 1.0 / WAVE_SPEED, BULK_MODULUS, float(areas[k, n]),
                DENSITY * WAVE_SPEED / float(areas[k, n]), 1.0 / float(areas[k, n]))
            for k in range(4))
        solve_valve(ends, velocity, (gains[:, n].copy(), float(leakage[n])), np.zeros((6, 4)))
        pressures[:, n] = pressure_of(waves[:, n] - velocity)
    return pressures


def valve_ring() -> list[Row]:
    """Solve rings of random openings, leaks, lines and waves in both ways."""
    rings = random_rings()
    exact, got = solve_by_bisection(rings), solve_by_valve(rings)
    worst = np.unravel_index(np.argmax(np.abs(got - exact)), got.shape)
    several = int(np.count_nonzero((rings[2] > 0.0).sum(axis=0) > 2))
    return [
        Row('valve_ring', f'pressures around {RINGS} rings, {several} with three or four edges '
            'open, worst', 'Pa', float(exact[worst]), float(got[worst]), 0.01, False,
            '1e-10 of 100 MPa, what the laws at a boundary hold to')]


def differences(first: np.ndarray, second: np.ndarray) -> float:
    """Count the values that are not the same bits."""
    return float(np.count_nonzero(first != second))


def run(parameters: Parameters, spools) -> np.ndarray:
    """Return position, velocity and pressures (T, 14) under commands (T, 2) of one tick each."""
    actuator = Actuator(parameters)
    channels, rows = actuator.channels, []
    for first, second in spools:
        actuator.tick_once(first, second, 0.0)
        row = actuator.row
        rows.append((row[channels.POSITION], row[channels.VELOCITY], *row[channels.pressure]))
    return np.array(rows)


def two_spools() -> list[Row]:
    """Move both spools alike, then one alone."""
    name = 'two_spools'
    sine = 0.5 * np.sin(2.0 * np.pi * 30.0 * 1e-3 * np.arange(200))
    alike = np.column_stack((sine, sine))
    one, two = (run(Parameters().replace({'valve.spools': count}), alike) for count in (1, 2))
    apart = Parameters().replace({
        'valve.spools': 2, 'cylinder.stiffness': 0.0, 'cylinder.area_2': 8e-4,
        'initial.pressure_2': 1.25 * 1.05e7})
    filled = run(apart, np.tile((0.3, 0.0), (1500, 1)))[-200:].mean(axis=0)
    actuator = Actuator(apart)
    ambient = apart['ambient_pressure']
    e, f = (2 + actuator.channels.section_names.index(station) for station in 'EF')
    return [
        Row(name, 'values that differ from one spool, same commands', '-', 0.0,
            differences(one, two), 0.0, False, 'the same openings: the same bits'),
        Row(name, 'chamber 1, PA alone open', 'Pa', apart['supply.pressure'],
            filled[e] - ambient, 1e-3, True, 'waves of the closed side ring about it'),
        Row(name, 'chamber 2, shut in', 'Pa', apart['supply.pressure'] / 0.8,
            filled[f] - ambient, 1e-3, True, 'A1 p1 = A2 p2'),
    ]


CASES = {
    'valve_ring': Case(valve_ring, 'several edges open at once, against bisection', 'slow'),
    'two_spools': Case(two_spools, 'two spools, alike and apart'),
}
