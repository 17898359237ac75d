# SPDX-License-Identifier: Apache-2.0
"""
The valve about null in the solver, against the orifice's formulas: overlap, underlap, leakage.

    held p_s ==== A | B ==== joined or closed ==== I | J ==== held p_t

Four short lines of oil meet in the valve. With ports B and I joined the load flow comes to rest,
with both closed their pressures do. C = C_d w sqrt(2/rho0), D = p_s - p_t, lap L > 0 underlap:

    joined, |x| < L   q = 2 C x sqrt(D/2)            beyond  q = C (x + L) sqrt(D/2)
    closed, |x| < L   p_B = p_t + D a^2/(a^2 + b^2), a = L + x, b = L - x, flow of both bridges
    closed, overlap and leakage G:  p_s - p_B = y^2, y = (sqrt(K^2 + 8 G^2 D) - K)/(4 G),
                      K = C (x - overlap) where open, else 0
"""

import math

from hydra_actuator.core.model import Domain, Junction
from hydra_actuator.core.port import LOSSLESS_COEFFICIENT
from hydra_actuator.core.records import CLOSED, ORIFICE, PRESSURE, VALVE, VALVE_PARAMETERS
from hydra_actuator.verification.case import Case, Row
from hydra_actuator.verification.chains import (
    BULK_MODULUS,
    DENSITY,
    LoneChain,
    mesh_of,
    WAVE_SPEED,
)
import numpy as np

LENGTH, AREA, CELLS = 0.05, 2e-4, 16
SUPPLY, TANK = 21e6, 1e6
LAP, LEAK = 2e-5, 2e-12
GAIN = 0.62 * 0.03 * math.sqrt(2.0 / DENSITY)
STROKE = 5e-4
RAMP, REST, BLOCKED_REST, SAMPLES = 0.01, 0.03, 0.4, 400
JOINED = (-1.5, -0.5, 0.25, 0.75, 1.5)
SPOOL_1, SPOOL_2, HELD_SUPPLY, HELD_TANK = range(4)


def bench(lap: float, leakage: float, joined: bool) -> LoneChain:
    """Return the valve between four lines; lap [m], positive is underlap."""
    middle = 0.5 * (SUPPLY + TANK)
    domains = [Domain(name, LENGTH, AREA, WAVE_SPEED, pressure=pressure)
               for name, pressure in (('supply', SUPPLY), ('port_1', middle),
                                      ('port_2', middle), ('return', TANK))]
    ports = [Junction(ORIFICE, (3, 4), coefficient=LOSSLESS_COEFFICIENT)] if joined else [
        Junction(CLOSED, (3,)), Junction(CLOSED, (4,))]
    junctions = [Junction(PRESSURE, (0,), HELD_SUPPLY), Junction(VALVE, (1, 2, 5, 6), SPOOL_1),
                 *ports, Junction(PRESSURE, (7,), HELD_TANK)]
    mesh = mesh_of(LENGTH, CELLS)
    valve = np.zeros(1, VALVE_PARAMETERS)
    valve['flow_gain'], valve['overlap'] = GAIN, -lap
    valve['leakage'], valve['stroke'], valve['step_time'] = leakage, STROKE, mesh.step_time
    return LoneChain(domains, junctions, mesh, valve=valve)


def settled(lap: float, leakage: float, spool: float, joined: bool) -> tuple[float, ...]:
    """Return flow out of A and at B [m^3/s] and pressures at B and I [Pa], means at rest."""
    chain = bench(lap, leakage, joined)
    dt, x = chain.model.step_time, spool / STROKE
    table = np.array([[0.0, 0.0, SUPPLY, TANK], [x, x, SUPPLY, TANK]])
    rest = REST if joined else BLOCKED_REST
    chain.follow(np.array([0.0, RAMP]), table, round((RAMP + rest) / dt))
    chain.hold(x, x, SUPPLY, TANK)
    rows = []
    for _ in range(SAMPLES):
        chain.advance(7)
        p_a, p_b, p_i = (chain.end_pressure(end) for end in (1, 2, 5))
        rows.append((chain.end_velocity(1) * AREA * (1.0 + p_a / BULK_MODULUS),
                     -chain.end_velocity(2) * AREA * (1.0 + p_b / BULK_MODULUS), p_b, p_i))
    return tuple(np.mean(rows, axis=0))


def valve_null_curves() -> list[Row]:
    """Compare flow gain, pressure gain and leakage about null."""
    name, rows, span = 'valve_null_curves', [], SUPPLY - TANK
    half = math.sqrt(0.5 * span)
    near = 'laws at the junctions hold to 1e-10'
    for label, lap in (('underlap', LAP), ('zero lap', 0.0), ('overlap', -LAP)):
        for share in JOINED:
            x = share * LAP
            sides = max(0.0, lap + x), max(0.0, lap - x)
            expected = GAIN * (sides[0] - sides[1]) * half
            got = settled(lap, LEAK, x, True)[1]
            rows.append(Row(name, f'{label}, load flow at {share:+g} laps', 'm^3/s', expected,
                            float(got), 1e-9 * GAIN * LAP * half, False, near))
    for share in (0.0, 0.3, 0.8):
        a, b = LAP * (1.0 + share), LAP * (1.0 - share)
        part = span * a * a / (a * a + b * b)
        through, _, p_b, p_i = settled(LAP, 0.0, share * LAP, False)
        rows += [
            Row(name, f'underlap, load pressure of blocked ports at {share:+g} laps', 'Pa',
                2.0 * part - span, float(p_b - p_i), 1e-9 * span, False, near),
            Row(name, f'underlap, leakage at {share:+g} laps', 'm^3/s',
                GAIN * (a * math.sqrt(span - part) + b * math.sqrt(part)), float(through), 1e-9,
                True, near)]
    return rows + _leaking(name, span)


def _leaking(name: str, span: float) -> list[Row]:
    """Return rows of an overlapped valve with leakage, its ports blocked."""
    rows = []
    for share in (0.0, 0.5, 1.02, 1.2):
        k = GAIN * LAP * max(0.0, share - 1.0)
        y = (math.sqrt(k * k + 8.0 * LEAK ** 2 * span) - k) / (4.0 * LEAK)
        through, _, p_b, p_i = settled(-LAP, LEAK, share * LAP, False)
        rows += [
            Row(name, f'overlap and leakage, load pressure at {share:+g} laps', 'Pa',
                span - 2.0 * y * y, float(p_b - p_i), 1e-9 * span, False,
                'as above, and what still fills the ports'),
            Row(name, f'overlap and leakage, leakage at {share:+g} laps', 'm^3/s',
                2.0 * LEAK * (span - y * y), float(through), 1e-9, True, 'as the pressure')]
    return rows


CASES = {'valve_null_curves': Case(
    valve_null_curves, 'the valve about null against the formulas of its orifices')}
