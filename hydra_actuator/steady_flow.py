# SPDX-License-Identifier: Apache-2.0
"""
Steady flow through the actuator at rest: lines, four edges, ports and the piston's leakage.

Along a line d(mu)/dx = -J(u)/(c (1 - (u/c)^2)) with A u rho constant, which is the model's own
pair of characteristics without d/dt. Unknowns are the five flows PA, PB, AT, BT and past the
piston [m^3/s at reference density] and the pressures at B and I [Pa]; Newton's steps on laws and
balances together, shortened while they do not help (Todini, Pilati, "A gradient algorithm for the
analysis of pipe networks", 1988). Neglected: nothing that the model has.
"""

import math

from hydra_actuator.core.friction import steady_drag
from hydra_actuator.core.orifice import orifice_drop
from hydra_actuator.core.records import Model
from hydra_actuator.parameters import ParameterError
import numpy as np

SUPPLY_LINE, LINE_1, CHAMBER_1, CHAMBER_2, LINE_2, RETURN_LINE = range(6)
PORT_1, PORT_2 = 2, 4
PA, PB, AT, BT, PAST, AT_B, AT_I = range(7)
COARSE, MOST_STEPS, MOST_HALVINGS = 12, 300, 30
# Largest defect [Pa] that ends the search, and that is no solution.
CLOSE, UNSOLVED = 1e-7, 1.0

# The formulas as plain Python: a start compiles nothing.
_drop, _drag = orifice_drop.py_func, steady_drag.py_func


def line_profile(model: Model, d: int, mu: float, flow: float, steps: int) -> np.ndarray:
    """
    Return mu [m/s] at steps + 1 equal distances along line d; steps < 0 from its far end back.

    mu: at the end where it begins; flow [m^3/s] from node 0 on.
    """
    speed, node = model.wave_speed[d], model.start[d]
    length = model.spacing[d] * model.capacity[d]
    table = (model.damping, model.table_start[node])
    size = length / steps

    def slope(x: float) -> float:
        velocity = flow * model.inverse_area[d] * math.exp(min(50.0, max(-50.0, -x / speed)))
        drag = _drag(velocity, model.loss[node], table, model.table_scale)
        return -drag / (speed * (1.0 - min(0.25, (velocity / speed) ** 2)))

    values = np.full(abs(steps) + 1, mu)
    if flow == 0.0:
        return values
    for k in range(abs(steps)):
        s_1 = slope(mu)
        s_2 = slope(mu + 0.5 * size * s_1)
        s_3 = slope(mu + 0.5 * size * s_2)
        s_4 = slope(mu + size * s_3)
        mu += size / 6.0 * (s_1 + 2.0 * (s_2 + s_3) + s_4)
        values[k + 1] = mu
    return values


def mu_of(model: Model, d: int, pressure: float) -> float:
    """Return mu [m/s] of a domain at a gauge pressure [Pa]."""
    return model.wave_speed[d] * math.log1p(max(-0.9, pressure / model.bulk_modulus[d]))


def beyond_line(model: Model, d: int, pressure: float, flow: float, steps: int = COARSE) -> float:
    """Return the pressure [Pa] at the other end of a line; steps < 0 from its far end back."""
    mu = line_profile(model, d, mu_of(model, d, pressure), flow, steps)[-1]
    return model.bulk_modulus[d] * math.expm1(
        min(1.0, max(-1.0, mu / model.wave_speed[d])))


def conductances(model: Model, spools: tuple[float, float] = (0.0, 0.0)
                 ) -> list[tuple[float, float]]:
    """Return (K' [m^3/(s sqrt(Pa))], leakage [m^3/(s Pa)]) of the edges; spools [m]: centred."""
    valve = model.valve[0]
    ways = (spools[0], -spools[1], -spools[0], spools[1])
    return [(float(gain * max(0.0, way - overlap)), float(valve['leakage']))
            for gain, way, overlap in zip(valve['flow_gain'], ways, valve['overlap'])]


def past_piston(model: Model, pressure: float, flow: float) -> tuple[float, float, float]:
    """Return the pressures [Pa] at E, F and I for a pressure at B and a flow past the piston."""
    port_1, port_2 = (model.junctions[k]['coefficient'] for k in (PORT_1, PORT_2))
    face_1 = beyond_line(model, LINE_1, pressure, flow) - _drop(flow, port_1, 0.0)[0]
    leakage = model.piston[0]['leakage']
    face_2 = face_1 - flow / leakage if leakage > 0.0 else face_1
    return face_1, face_2, beyond_line(
        model, LINE_2, face_2 - _drop(flow, port_2, 0.0)[0], flow)


def solve_network(model: Model, supply: float, tank: float, lone: tuple,
                  edges: list) -> np.ndarray:
    """
    Return the seven unknowns, indexed PA .. AT_I, at the pressures [Pa] of pump and tank.

    lone: the pressure [Pa] of B and of I where nothing reaches it, None where something does;
    edges: as `conductances` returns them. Raises ParameterError where no steady flow is found.
    """
    span = max(abs(supply - tank), 1.0)
    unknown = np.zeros(7)
    unknown[AT_B] = unknown[AT_I] = 0.5 * (supply + tank)
    for k, (gain, leakage) in enumerate(edges):
        unknown[k] = math.copysign(gain * math.sqrt(0.5 * span) + leakage * 0.5 * span,
                                   supply - tank)
    flow_scale = max(1e-12, np.abs(unknown[:5]).max())
    scale = np.array([flow_scale] * 5 + [span] * 2)
    least = span * 1e-9

    def residual(x: np.ndarray) -> np.ndarray:
        return _defects(model, x, (supply, tank), edges, lone) / np.array(
            [1.0] * 5 + [flow_scale / span] * 2)

    defect = residual(unknown)
    for _ in range(MOST_STEPS):
        size = np.abs(defect).max()
        change = _newton_step(
            _slopes(residual, unknown, defect, scale, least), defect) * scale
        for halving in range(MOST_HALVINGS):
            trial = unknown + 0.5 ** halving * change
            after = residual(trial)
            if np.abs(after).max() < size:
                break
        else:
            break
        unknown, defect = trial, after
        if np.abs(defect).max() < CLOSE:
            break
    if not np.abs(defect).max() < UNSOLVED:
        raise ParameterError('initial.equilibrium: no steady flow was found for these parameters')
    return unknown


def _newton_step(slopes: np.ndarray, defect: np.ndarray) -> np.ndarray:
    """Return what would take the defect away; the shortest that best does where none can."""
    try:
        return np.linalg.solve(slopes, -defect)
    except np.linalg.LinAlgError:
        return np.linalg.lstsq(slopes, -defect, rcond=None)[0]


def _slopes(residual, unknown: np.ndarray, defect: np.ndarray, scale: np.ndarray,
            least: float) -> np.ndarray:
    """Return the matrix of residuals over scaled unknowns; every edge resists a little."""
    matrix = np.empty((7, 7))
    for k in range(7):
        step = 1e-6 * (abs(unknown[k]) + 1e-3 * scale[k])
        moved = unknown.copy()
        moved[k] += step
        matrix[:, k] = (residual(moved) - defect) * (scale[k] / step)
    for k in range(5):
        matrix[k, k] -= least
    return matrix


def _defects(model: Model, x: np.ndarray, ends: tuple, edges: list, lone: tuple) -> np.ndarray:
    supply, tank = ends
    at_a = beyond_line(model, SUPPLY_LINE, supply, x[PA] + x[PB])
    at_j = beyond_line(model, RETURN_LINE, tank, x[AT] + x[BT], -COARSE)
    drops = (at_a - x[AT_B], at_a - x[AT_I], x[AT_B] - at_j, x[AT_I] - at_j)
    defect = np.empty(7)
    for k, (gain, leakage) in enumerate(edges):
        closed = gain == 0.0 and leakage == 0.0
        defect[k] = -1e12 * x[k] if closed else drops[k] - _drop(x[k], gain, leakage)[0]
    defect[PAST] = -1e12 * x[PAST]
    if model.piston[0]['leakage'] > 0.0:
        defect[PAST] = past_piston(model, x[AT_B], x[PAST])[2] - x[AT_I]
    defect[5] = x[PA] - x[AT] - x[PAST]
    defect[6] = x[PB] - x[BT] + x[PAST]
    for k in range(2):
        if lone[k] is not None:
            defect[5 + k] = (x[AT_B + k] - lone[k]) * 1e-12
    return defect
