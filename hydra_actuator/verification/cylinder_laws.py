# SPDX-License-Identifier: Apache-2.0
"""
The cylinder by formula: slow compression, balance of forces, speeds of unequal areas, leakage.

Compression of a closed chamber: rho V constant gives p - p0 = (chi + p0)(V0/V - 1).

Unequal areas between pump and tank, valve open by K' [m^3/(s sqrt(Pa))] on both sides, no load:
with r = 1 + p/chi of each chamber, A1 p1 = A2 p2 and

    out: p_s - p1 = (r1 A1 v/K')^2, p2 - p_t = (r2 A2 v/K')^2      in: the same with 1, 2 exchanged

so that oil of no compressibility moves sqrt(A1/A2) times as fast out as in. Leakage k between
closed chambers lets a load F sink: with r at their mean pressure, v = -k F/(r A^2 + k delta).
"""

import math

from hydra_actuator.actuator import Actuator
from hydra_actuator.core.model import Domain, Junction
from hydra_actuator.core.records import CLOSED, PISTON, PISTON_PARAMETERS, PRESSURE, WALL
from hydra_actuator.parameters import Parameters
from hydra_actuator.verification.case import Case, Row
from hydra_actuator.verification.chains import (
    BULK_MODULUS,
    LoneChain,
    mesh_of,
    WAVE_SPEED,
)
from hydra_actuator.verification.seals import SHUT
from hydra_actuator.verification.spool_response import soft_step
import numpy as np

LINES = ('supply_line', 'line_1', 'line_2', 'return_line')
LOSSLESS = {**{f'{line}.friction': 'none' for line in LINES},
            'cylinder.port_loss_1': 0.0, 'cylinder.port_loss_2': 0.0}
FREE = {**LOSSLESS, 'cylinder.stiffness': 0.0, 'supply.max_flow': 0.0}


def slow_compression() -> list[Row]:
    """Press a closed chamber together by a twentieth, so slowly that no wave is left."""
    name, length, rest, cells = 'slow_compression', 0.5, 10e6, 100
    mesh = mesh_of(length - 1e-6, cells)
    chain = LoneChain(
        [Domain('chamber', length, 1e-3, WAVE_SPEED, pressure=rest, longest=2.0 * length)],
        [Junction(CLOSED, (0,)), Junction(WALL, (1,), 0)], mesh)
    steps = round(0.2 / mesh.step_time)
    speeds = -np.diff(soft_step(np.linspace(-0.5 / steps, 1.0 + 0.5 / steps, steps + 2)))
    for speed in speeds:
        chain.step(float(0.05 * length * speed / mesh.step_time))
    got_length, pressure = float(chain.state.length[0]), chain.pressure(0)
    rise = (BULK_MODULUS + rest) * (length / got_length - 1.0)
    return [
        Row(name, 'part of the length that is left', '-', 0.95, got_length / length, 1e-9, False,
            'the sum of the way'),
        Row(name, 'rise of pressure', 'Pa', rise, float(pressure.mean()) - rest, 1e-9, True,
            'the speed changes over 500 passes of a wave; no cell that went cost any oil'),
        Row(name, 'unevenness along the chamber', 'Pa', 0.0, float(np.ptp(pressure)), 1.0, False,
            '1e-8 of the rise'),
    ]


def force_balance() -> list[Row]:
    """Let a piston of unequal areas come to rest between closed chambers, spring and load."""
    parameters = Parameters().replace({
        **SHUT, 'cylinder.area_2': 6e-4, 'cylinder.viscous_friction': 2e4,
        'initial.pressure_1': 8e6, 'initial.pressure_2': 9e6})
    load = 1500.0
    actuator = Actuator(parameters)
    actuator.advance(1.0, load_force=load)
    readings = np.empty((200, 3))
    for reading in readings:
        state = actuator.advance(1e-3)
        reading[:] = (
            parameters['cylinder.area_1'] * (state.pressure['E'] - parameters['ambient_pressure'])
            - parameters['cylinder.area_2'] * (
                state.pressure['F'] - parameters['ambient_pressure']),
            load + parameters['cylinder.stiffness'] * state.position, state.effort)
    push, wanted, effort = readings.mean(axis=0).tolist()
    return [
        Row('force_balance', 'A1 p1 - A2 p2 at rest, mean of 0.2 s', 'N', wanted, push, 1e-6,
            True, 'waves of 0.02 N that hardly lose ring on, and cancel'),
        Row('force_balance', 'effort', 'N', push, effort, 1e-12, True, 'the same sum'),
    ]


def steady_speed(parameters: Parameters, spool: float) -> float:
    """Return the mean speed [m/s] once the piston runs steadily under a spool position."""
    actuator = Actuator(parameters)
    actuator.advance(0.5, spool=spool)
    first = actuator.state
    last = actuator.advance(0.5)
    return (last.position - first.position) / (last.time - first.time)


def exact_speed(p: Parameters, spool: float) -> float:
    """Return the steady speed [m/s] by bisection on it; A1 p1 = A2 p2 + delta v."""
    gain = (p['valve.discharge_coefficient'] * p['valve.area_gradient'] * p['valve.stroke']
            * abs(spool) * math.sqrt(2.0 / p['fluid.density']))
    first, second = p['cylinder.area_1'], p['cylinder.area_2']
    if spool < 0.0:
        first, second = second, first
    chi, low, high = p['fluid.bulk_modulus'], 0.0, gain * math.sqrt(p['supply.pressure']) / second
    for _ in range(100):
        speed = 0.5 * (low + high)
        # p = p_t + drop (1 + p/chi)^2, the smaller root
        drop = (second * speed / gain) ** 2
        half = 0.5 - drop / chi
        before = (p['tank.pressure'] + drop) / (
            half + math.sqrt(half ** 2 - (p['tank.pressure'] + drop) * drop / chi ** 2))
        behind = (second * before + p['cylinder.viscous_friction'] * speed) / first
        if p['supply.pressure'] - behind > ((1.0 + behind / chi) * first * speed / gain) ** 2:
            low = speed
        else:
            high = speed
    return math.copysign(speed, spool)


def unequal_areas() -> list[Row]:
    """Run a piston of unequal areas out and in, against the steady solution and the ratio."""
    name = 'unequal_areas'
    parameters = Parameters().replace({
        **FREE, 'cylinder.area_2': 6e-4, 'tank.pressure': 0.0, 'cylinder.viscous_friction': 0.0,
        'initial.pressure_1': 4e6, 'initial.pressure_2': 4e6 / 0.6, 'cylinder.stroke': 1.0})
    out, back = (steady_speed(parameters, sign * 0.2) for sign in (1.0, -1.0))
    reason = 'what is left of the start; steady flow is exact'
    return [
        Row(name, 'speed out', 'm/s', exact_speed(parameters, 0.2), out, 1e-6, True, reason),
        Row(name, 'speed in', 'm/s', exact_speed(parameters, -0.2), back, 1e-6, True, reason),
        Row(name, 'speed out over speed in', '-', math.sqrt(1.0 / 0.6), -out / back, 0.01, True,
            'the formula has oil of no compressibility: p/chi is 1.4 %'),
    ]


def leak_flow() -> list[Row]:
    """Hold a leaking piston between two pressures, and let one sink under a load."""
    return [*steady_leak(), *sinking_load()]


def steady_leak() -> list[Row]:
    """Let oil pass a held piston: k (p1 - p2) at each fixed end, in the mean of the waves."""
    name, length, area, leakage = 'piston_leakage', 0.25, 1e-3, 2e-12
    pressures = 15e6, 5e6
    piston = np.zeros(1, PISTON_PARAMETERS)
    piston['breakaway'] = piston['coulomb'] = 1e5
    piston['mass'], piston['leakage'], piston['limit'] = 10.0, leakage, 0.1
    piston['length_1'] = piston['length_2'] = length
    chambers = [
        Domain(f'chamber_{k + 1}', length, area, WAVE_SPEED, 2000.0, pressures[k],
               longest=0.4, origin=0.5 * k, direction=1.0 - 2.0 * k) for k in range(2)]
    chain = LoneChain(
        chambers, [Junction(PRESSURE, (0,), 0), Junction(PRESSURE, (2,), 1),
                   Junction(PISTON, (1, 3), 3)], mesh_of(0.5, 100), piston=piston)
    chain.hold(*pressures)
    chain.advance(100_000)
    flows = np.empty((8000, 2))
    for row in flows:
        chain.advance()
        for k in range(2):
            row[k] = ((1.0 + chain.end_pressure(2 * k) / BULK_MODULUS) * area
                      * chain.end_velocity(2 * k))
    expected = leakage * (pressures[0] - pressures[1])
    reason = 'the mean of what still rings: nothing but the piston ends a wave'
    return [
        Row(name, 'flow into the chamber of 15 MPa', 'm^3/s', expected, float(-flows[:, 0].mean()),
            1e-3, True, reason),
        Row(name, 'flow out of the chamber of 5 MPa', 'm^3/s', expected, float(flows[:, 1].mean()),
            1e-3, True, reason)]


def sinking_load() -> list[Row]:
    """Let a load sink on closed chambers past a leaking piston."""
    load, leakage = 5000.0, 1e-11
    parameters = Parameters().replace({
        **SHUT, 'cylinder.stiffness': 0.0, 'cylinder.leakage': leakage,
        'initial.pressure_1': 12.5e6, 'initial.pressure_2': 7.5e6})
    area, mean = parameters['cylinder.area_1'], 10e6
    ratio = 1.0 + mean / parameters['fluid.bulk_modulus']
    actuator = Actuator(parameters)
    first = actuator.advance(0.1, load_force=load)
    last = actuator.advance(0.2)
    speed = (last.position - first.position) / (last.time - first.time)
    exact = -leakage * load / (ratio * area ** 2
                               + leakage * parameters['cylinder.viscous_friction'])
    return [Row('piston_leakage', 'speed of a sinking load', 'm/s', exact, speed, 3e-4, True,
                'the mean pressure rises by 1e-4 of chi as the load sinks, and the start rings')]


CASES = {
    'slow_compression': Case(slow_compression, 'a closed chamber, slowly pressed together'),
    'force_balance': Case(force_balance, 'unequal areas at rest between spring and load'),
    'unequal_areas': Case(unequal_areas, 'speeds out and in of unequal areas'),
    'piston_leakage': Case(leak_flow, 'oil past the piston'),
}
