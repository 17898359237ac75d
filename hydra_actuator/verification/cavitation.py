# SPDX-License-Identifier: Apache-2.0
"""
Free gas and vapour in a lone line: wave speed, lowest pressure, mass, no pattern of the mesh.

Gas is lumped at the nodes, in addition to a line full of oil: the oil a cavity displaces has left
the line. At inner nodes the field holds the waves that leave a node, whose mean is not its
pressure while its gas grows: pressures are read from the gas, p = p* + p_v.
"""

from functools import cache
import math

from hydra_actuator.core.boiling import gas_volumes
from hydra_actuator.core.model import Domain, Junction
from hydra_actuator.core.oil import Oil
from hydra_actuator.core.records import CLOSED, FLOW, PRESSURE
from hydra_actuator.verification.case import Case, Row
from hydra_actuator.verification.chains import (
    BULK_MODULUS,
    DENSITY,
    LoneChain,
    mesh_of,
    WAVE_SPEED,
)
import numpy as np

LENGTH = 2.0
AREA = 2e-4
AMBIENT, VAPOUR_PRESSURE = 101325.0, 10.0
FLOOR = AMBIENT - VAPOUR_PRESSURE
# a slammed line: gauge pressure at its inlet [Pa], velocity [m/s], how long the valve closes [s]
HEAD, SPEED, CLOSURE = 0.5e6, 0.8, 2e-3
TRACE_OF_GAS, DURATION = 1e-7, 0.04
COURANTS = (0.7, 0.9, 0.975)
MIXTURES = ((1e-3, 1e6), (1e-2, 5e6), (1e-4, 2e5))     # share of gas, gauge pressure [Pa]
CELLS = 200
# [kg]: a sum over nodes knows a front's place, rise rho c u, to within a cell
FRONT = DENSITY * AREA * LENGTH / CELLS * SPEED / WAVE_SPEED
SPEED_BAR, VAPOUR_BAR, PATTERN_BAR = 1e-3, 50.0, 5e-3


def lone_line(ends: tuple[int, int], air_fraction: float, mesh: dict,
              **initial: float) -> LoneChain:
    """Return a lossless line with gas between two junction kinds; mesh: as mesh_of takes it."""
    return LoneChain(
        [Domain('line', LENGTH, AREA, WAVE_SPEED, **initial)],
        [Junction(kind, (end,), end) for end, kind in enumerate(ends)],
        mesh_of(LENGTH, **mesh), oil=Oil(DENSITY, 0.0, air_fraction, FLOOR))


def above_vapour(chain: LoneChain, d: int = 0) -> np.ndarray:
    """Return absolute less vapour pressure [Pa] at the nodes of a line with gas."""
    first = chain.model.start[d]
    return chain.state.star[first:first + chain.state.last[d] + 1]


def mixture_speed(share: float, pressure: float) -> float:
    """Return the wave speed [m/s] of oil with a share of gas at gauge pressure 0, at another."""
    star = pressure + FLOOR
    alpha = share * FLOOR / star
    stiff = DENSITY * (1.0 + pressure / BULK_MODULUS) * WAVE_SPEED ** 2
    return WAVE_SPEED / math.sqrt(1.0 + stiff * alpha / star)


def gas_wave_speed() -> list[Row]:
    """Time the quarter wave of a line whose oil carries gas, at a swing of 1e-7."""
    rows = []
    for share, pressure in MIXTURES:
        for courant in COURANTS:
            exact = mixture_speed(share, pressure)
            rows.append(Row(
                'gas_wave_speed', f'{share:g} of gas, {pressure / 1e6:g} MPa, Courant {courant}',
                'm/s', exact, quarter_wave_speed(share, pressure, courant, exact), SPEED_BAR, True,
                'lumping gas at 200 nodes costs less'))
    return rows


@cache
def quarter_wave_speed(share: float, pressure: float, courant: float, guess: float) -> float:
    """Return the wave speed [m/s] at which an open-closed line rings about a pressure [Pa]."""
    chain = lone_line((PRESSURE, CLOSED), share, {'cells': 200, 'courant': courant},
                      pressure=pressure)
    raised = pressure * (1.0 + 1e-7)
    chain.hold(raised)
    trace = []
    for _ in range(round(24.0 * LENGTH / guess / chain.model.step_time)):
        chain.advance()
        trace.append((chain.time, chain.end_pressure(1) - raised))
    time, swing = np.array(trace).T
    up = np.flatnonzero((swing[:-1] < 0.0) & (swing[1:] >= 0.0))
    instants = time[up] - swing[up] * np.diff(time)[up] / np.diff(swing)[up]
    return 4.0 * LENGTH / float(np.diff(instants).mean())


def slammed_line(cells: int, courant: float) -> LoneChain:
    """Return a line that flows from a constant head to a valve, before it closes."""
    return lone_line((PRESSURE, FLOW), TRACE_OF_GAS, {'cells': cells, 'courant': courant},
                     pressure=HEAD, velocity=SPEED)


def close_valve(chain: LoneChain) -> None:
    """Advance one step of the closing, then closed, valve."""
    after = chain.time + chain.model.step_time
    flow = AREA * SPEED * (1.0 + HEAD / BULK_MODULUS)
    chain.step(HEAD, flow * max(0.0, 1.0 - after / CLOSURE))


@cache
def boil(courant: float) -> tuple[np.ndarray, ...]:
    """Return time [s], lowest p - p_v anywhere, and p - p_v at the valve [Pa] of a slam."""
    chain, trace = slammed_line(200, courant), []
    while chain.time < DURATION:
        close_valve(chain)
        trace.append((chain.time, float(above_vapour(chain).min()), chain.end_pressure(1) + FLOOR))
    return tuple(np.array(trace).T)


def vapour_pressure() -> list[Row]:
    """Slam a line until it boils and look for its lowest pressure at any node and step."""
    rows = []
    for courant in COURANTS:
        _, lowest, at_valve = boil(courant)
        for where, star in (('anywhere', lowest), ('at the valve, by its waves', at_valve)):
            rows.append(Row(
                'vapour_pressure', f'lowest p - p_v {where}, Courant {courant}', 'Pa', VAPOUR_BAR,
                float(star.min()), VAPOUR_BAR, False,
                'never below 0, and 0.1 % of ambient where it boils'))
    return rows


def oil_density(chain: LoneChain) -> np.ndarray:
    """Return the oil's density [kg/m^3] at the nodes of a line with gas."""
    return DENSITY * (1.0 + (above_vapour(chain) - FLOOR) / BULK_MODULUS)


def oil_mass(chain: LoneChain) -> float:
    """Return the oil [kg] in a line: what fills it, less what its gas displaces."""
    room = np.full(chain.state.last[0] + 1, AREA * chain.model.spacing[0])
    room[0], room[-1] = 0.5 * room[0], 0.5 * room[-1]
    return float(np.sum(oil_density(chain) * (room - gas_volumes(chain.model, chain.state, 0))))


def mass_flow(chain: LoneChain) -> np.ndarray:
    """Return the oil [kg/s] into a line's inlet and out of its far end, past the gas there."""
    outflow = chain.state.end_velocity[:2] * np.array((-1.0, 1.0))
    return AREA * oil_density(chain)[[0, -1]] * outflow


@cache
def weigh(cells: int, courant: float) -> np.ndarray:
    """
    Return a row at every step of a slammed line.

    Columns: in - out - stored [kg], gas [m^3], throughput [kg], time [s].
    """
    chain = slammed_line(cells, courant)
    before, mass = mass_flow(chain), oil_mass(chain)
    moved, throughput, rows = np.zeros(2), 0.0, []
    while chain.time < DURATION:
        close_valve(chain)
        after = mass_flow(chain)
        mean = 0.5 * chain.model.step_time * (before + after)
        before = after
        moved += mean
        throughput += abs(mean[0])
        gas = float(gas_volumes(chain.model, chain.state, 0).sum())
        rows.append((moved[0] - moved[1] - oil_mass(chain) + mass, gas, throughput,
                     chain.time))
    return np.array(rows)


def cavity_mass() -> list[Row]:
    """Weigh the oil that cavities displace, and what is left when all have collapsed."""
    cells, rows, front = CELLS, [], FRONT
    for courant in COURANTS:
        missing, gas, throughput, _ = weigh(cells, courant).T
        most = int(np.argmax(gas))
        rows += [
            Row('cavity_mass', f'gas against oil displaced, Courant {courant}', 'ml',
                1e6 * float(gas[most] - missing[most] / DENSITY), 1e6 * float(gas[most]),
                1e6 * front / DENSITY, False, 'one cell of a front, 1.8 % of the gas'),
            Row('cavity_mass', f'in - out - stored, worst step, Courant {courant}',
                'cells of a front', 0.0, float(np.max(np.abs(missing)) / front), 1.0, False,
                'a sum over nodes knows the place of a front to within a cell'),
            Row('cavity_mass', f'in - out - stored after collapse, Courant {courant}',
                'of throughput', 0.0, float(missing[-1] / throughput[-1]), 1e-4, False,
                'interpolating fronts adds mass, most at a high Courant number: closed_line'),
        ]
    return rows


def alternation(values: np.ndarray) -> float:
    """Return the size of a pattern + - + - on smooth values, in parts of their mean."""
    bend = 0.25 * np.diff(values, 2)
    return float(abs(np.mean(bend * (-1.0) ** np.arange(len(bend)))) / np.mean(values))


@cache
def growing_zone(courant: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """
    Return (time [s], alternation in the zone that boils beside the valve), and gas [m^3] at last.

    The gas is that of the nodes from the valve, its own half cell left out.
    """
    chain, history, gas = slammed_line(200, courant), [], np.zeros(0)
    while chain.time < 6.6e-3:
        close_valve(chain)
        if chain.time > 5.5e-3:
            gas = gas_volumes(chain.model, chain.state, 0)[-2::-1]
            zone = int(np.argmin(gas > 0.2 * gas[0]))
            history.append((chain.time,
                            alternation(gas[1:zone - 2]) if zone > 8 else math.nan))
    time, size = np.array(history).T
    return time, size, gas


def alternate_nodes() -> list[Row]:
    """Compare every other node of the zone that boils beside the valve, while it grows."""
    return [Row('alternate_nodes', f'gas of odd against even nodes, Courant {courant}', 'of mean',
                0.0, float(growing_zone(courant)[1].max()), PATTERN_BAR, False,
                'a pattern would be of order one; what is left falls with the cell')
            for courant in COURANTS]


CASES = {
    'gas_wave_speed': Case(gas_wave_speed, 'wave speed of oil that carries gas'),
    'vapour_pressure': Case(vapour_pressure, 'a slammed line boils and goes no lower'),
    'cavity_mass': Case(cavity_mass, 'oil in, out, stored and displaced by cavities'),
    'alternate_nodes': Case(alternate_nodes, 'no odd-even pattern beside a cavity'),
}
