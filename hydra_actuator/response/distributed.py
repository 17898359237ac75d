# SPDX-License-Identifier: Apache-2.0
"""
The whole streamline, linear about an operating point, with its waves.

    O ==== A | B ==== C )( D ==== E ]M[ F ==== G )( H ==== I | J ==== K

Unknown at each complex frequency s: dp and dq at both ends of the six domains, the four edge
flows and the piston's speed v. Equations: six line matrices, and

    pump         dp = 0, or at its largest flow dq = -s C dp, C of the accumulator's gas (0 none)
    edge M to N  dp_M - dp_N = R (de - K_x dx), R the slope of the orifice's drop; de = K_x dx
                 where it is closed
    port         dp_C - dp_D = R dq
    piston       dq_E - A1 (r_E v + V0 dp_E/chi) = G (dp_E - dp_F), the same at F;
                 (m s + delta + k/s) v = A1 dp_E - A2 dp_F - dF
    tank         dp = 0

q is at reference density, r = 1 + p/chi, V0 the piston's steady speed. Neglected: see line_matrix
and valve_slopes; with a steady speed, that the chambers' lengths change.
"""

import math
from typing import NamedTuple

from hydra_actuator.channels import DOMAINS
from hydra_actuator.core.orifice import orifice_drop
from hydra_actuator.core.source import GAS_EXPONENT, stored_oil
from hydra_actuator.geometry import domain_lengths, LINES
from hydra_actuator.response.line_matrix import line_matrix, line_state, LineState
from hydra_actuator.response.operating_point import OperatingPoint
from hydra_actuator.response.valve_slopes import valve_slopes, ValveSlopes
from hydra_actuator.steady_flow import AT_I, beyond_line, COARSE, LINE_2, PORT_1, PORT_2
import numpy as np

# Unknowns: (dp, dq) at start and end of domain d are 4 d .. 4 d + 3, then the edges and v.
EDGE, SPEED, UNKNOWNS = 24, 28, 29
(O_P, O_Q, A_P, A_Q, B_P, B_Q, C_P, C_Q, D_P, D_Q, E_P, E_Q,
 F_P, F_Q, G_P, G_Q, H_P, H_Q, I_P, I_Q, J_P, J_Q, K_P, K_Q) = range(EDGE)
ENDS_OF_EDGES = ((A_P, B_P), (A_P, I_P), (B_P, J_P), (I_P, J_P))


class Plant(NamedTuple):
    """Constants of the linear plant; pump_capacity: C [m^3/Pa], negative where dp = 0."""

    point: OperatingPoint
    lines: tuple[LineState, ...]
    valve: ValveSlopes
    port_resistance: tuple[float, float]
    pump_capacity: float


class Responses(NamedTuple):
    """
    Complex responses at frequencies [Hz], each (F,).

    Over spool displacement [m]: velocity [1/s], pressure_1, pressure_2, load_pressure [Pa/m] (of
    the faces; load pressure is p_E - p_F A2/A1). stiffness: load force over the position it
    gives, taken positive [N/m].
    """

    frequency: np.ndarray
    velocity: np.ndarray
    pressure_1: np.ndarray
    pressure_2: np.ndarray
    load_pressure: np.ndarray
    stiffness: np.ndarray


def linear_plant(point: OperatingPoint) -> Plant:
    """Return the plant linear about an operating point."""
    p, model, x = point.parameters, point.model, point.network
    lengths = domain_lengths(p)
    drawn, returned = float(x[0] + x[1]), float(x[2] + x[3])
    flows = (drawn, point.flow_1, point.flow_1, point.flow_2, point.flow_2, returned)
    begins = (point.pump, x[5], point.face_1, point.face_2,
              beyond_line(model, LINE_2, float(x[AT_I]), point.flow_2, -COARSE), point.at_j)
    gas = p['fluid.air_fraction'] * float(model.floor) if p['fluid.cavitation'] else 0.0
    lines = tuple(
        line_state(model, d, lengths[d], float(begins[d]), flows[d], _rate(p, name), gas)
        for d, name in enumerate(DOMAINS))
    ports = tuple(
        orifice_drop.py_func(flow, model.junctions[k]['coefficient'], 0.0)[1]
        for k, flow in ((PORT_1, point.flow_1), (PORT_2, point.flow_2)))
    return Plant(point, lines, valve_slopes(point), ports, _pump_capacity(point))


def _rate(p, name: str) -> float:
    """Return nu/r^2 [1/s] of a line with unsteady friction, else 0."""
    if not name.endswith(LINES) or p[f'{name}.friction'] != 'unsteady':
        return 0.0
    return p['fluid.kinematic_viscosity'] / (0.5 * p[f'{name}.diameter']) ** 2


def _pump_capacity(point: OperatingPoint) -> float:
    """Return what the pump's end takes per pressure [m^3/Pa], -1 where its pressure is held."""
    if not point.limited:
        return -1.0
    source = point.model.source.view(np.recarray)[0]
    held = stored_oil.py_func(point.pump, source)
    if held == 0.0:
        return 0.0
    return float((source.accumulator_volume - held)
                 / (GAS_EXPONENT * (point.pump + source.ambient)))


def system(plant: Plant, s: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """
    Return matrices (F, 29, 29) and right sides (F, 29, 2) for a spool of 1 m and a load of 1 N.

    Pressures are counted in units of rho0 c/A of line_1 times the flow.
    """
    s = np.asarray(s, complex)
    unit = float(plant.point.model.impedance[1])
    m = np.zeros((len(s), UNKNOWNS, UNKNOWNS), complex)
    right = np.zeros((len(s), UNKNOWNS, 2), complex)
    for d, line in enumerate(plant.lines):
        a, row = line_matrix(line, s), 2 * d
        m[:, row:row + 2, 4 * d:4 * d + 2] = a * np.array([[1.0, 1.0 / unit], [unit, 1.0]])
        m[:, row, 4 * d + 2] = m[:, row + 1, 4 * d + 3] = -1.0
        largest = np.abs(m[:, row:row + 2]).max(axis=2, keepdims=True)
        m[:, row:row + 2] /= largest
    if plant.pump_capacity < 0.0:
        m[:, 12, O_P] = 1.0
    else:
        m[:, 12, O_Q], m[:, 12, O_P] = 1.0, s * plant.pump_capacity * unit
    m[:, 13, K_P] = 1.0
    _set_valve(m, right, plant.valve, unit)
    for row, ends, resistance in ((22, (C_P, D_P), plant.port_resistance[0]),
                                  (24, (G_P, H_P), plant.port_resistance[1])):
        m[:, row, ends[0] + 1], m[:, row, ends[1] + 1] = 1.0, -1.0
        m[:, row + 1, ends[0]], m[:, row + 1, ends[1]] = 1.0, -1.0
        m[:, row + 1, ends[0] + 1] = -resistance / unit
    _set_piston(m, right, plant.point, s, unit)
    return m, right


def _set_valve(m: np.ndarray, right: np.ndarray, valve: ValveSlopes, unit: float) -> None:
    """Write rows 14 to 21: mass at A, B, I, J and the laws of the edges."""
    for row, (end, edges) in enumerate((
            (A_Q, {0: 1, 1: 1}), (B_Q, {0: 1, 2: -1}), (I_Q, {3: 1, 1: -1}),
            (J_Q, {2: 1, 3: 1})), start=14):
        m[:, row, end] = -1.0
        for edge, sign in edges.items():
            m[:, row, EDGE + edge] = sign
    for k, (before, after) in enumerate(ENDS_OF_EDGES):
        row = 18 + k
        if valve.conducts[k]:
            resistance = valve.resistance[k] / unit
            size = max(1.0, resistance)
            m[:, row, before], m[:, row, after] = 1.0 / size, -1.0 / size
            m[:, row, EDGE + k] = -resistance / size
            right[:, row, 0] = -resistance * valve.gain[k] / size
        else:
            m[:, row, EDGE + k] = 1.0
            right[:, row, 0] = valve.gain[k]


def _set_piston(m: np.ndarray, right: np.ndarray, point: OperatingPoint, s: np.ndarray,
                unit: float) -> None:
    """Write rows 26 to 28; the unknown is v A1."""
    p, model = point.parameters, point.model
    leak = p['cylinder.leakage'] * unit
    area_1 = p['cylinder.area_1']
    for row, (pressure, flow), area, face, d, sign in (
            (26, (E_P, E_Q), area_1, point.face_1, 2, 1.0),
            (27, (F_P, F_Q), p['cylinder.area_2'], point.face_2, 3, 1.0)):
        chi = float(model.bulk_modulus[d])
        m[:, row, flow] = 1.0
        m[:, row, SPEED] = -area * (1.0 + face / chi) / area_1
        m[:, row, pressure] = -area * point.velocity / chi * unit
        m[:, row, E_P] -= sign * leak
        m[:, row, F_P] += sign * leak
    force = area_1 * unit
    load = p['cylinder.mass'] * s + p['cylinder.viscous_friction'] + p['cylinder.stiffness'] / s
    m[:, 28, E_P] = 1.0
    m[:, 28, F_P] = -p['cylinder.area_2'] / area_1
    m[:, 28, SPEED] = -load / (area_1 * force)
    right[:, 28, 1] = 1.0 / force


def respond(plant: Plant, frequency: np.ndarray) -> Responses:
    """Return the responses at frequencies [Hz] above 0."""
    frequency = np.asarray(frequency, float)
    s = 2j * math.pi * frequency
    m, right = system(plant, s)
    found = np.linalg.solve(m, right)
    unit = float(plant.point.model.impedance[1])
    p = plant.point.parameters
    area_1, ratio = p['cylinder.area_1'], p['cylinder.area_2'] / p['cylinder.area_1']
    p_1, p_2 = unit * found[:, E_P, 0], unit * found[:, F_P, 0]
    return Responses(
        frequency, found[:, SPEED, 0] / area_1, p_1, p_2, p_1 - ratio * p_2,
        -s * area_1 / found[:, SPEED, 1])


def spool_dynamics(plant: Plant, frequency: np.ndarray) -> np.ndarray:
    """Return the response of the spool to its command [-], 1 for an ideal spool."""
    p = plant.point.parameters
    natural = p['valve.natural_frequency']
    ratio = 1j * np.asarray(frequency, float) / natural if natural > 0.0 else 0.0
    return 1.0 / (1.0 + 2.0 * p['valve.damping_ratio'] * ratio + ratio ** 2) + np.zeros_like(
        np.asarray(frequency, complex))
