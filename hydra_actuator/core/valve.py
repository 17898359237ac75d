# SPDX-License-Identifier: Apache-2.0
r"""
The servo-valve: four edges between pressure port A, tank port J and valve ports B and I.

             A (pump)                 edge 0 = PA: A -> B     edge 1 = PB: A -> I
         PA /        \ PB             edge 2 = AT: B -> J     edge 3 = BT: I -> J
    port B <          > port I
         AT \        / BT             Opening of PA, BT: max(0, x - overlap),
             J (tank)                 of PB, AT: max(0, -x - overlap).

Each edge is an orifice with laminar leakage in parallel. Edges that share no station are solved
one by one; otherwise the four flows are the unknowns of a damped Newton iteration (flows, not
pressures: d dp/dq is finite at zero flow). The equations are the gradient of a convex function,
so the direction always descends. Neglected: flow forces on the spool, oil in the valve's body.
"""

import math

from hydra_actuator.core.compilation import formula
from hydra_actuator.core.end import end_relation
from hydra_actuator.core.lanes import multiply_add
from hydra_actuator.core.orifice import MOST_PASSES, orifice_drop, settled, solve_orifice
import numpy as np

A, B, I, J = range(4)
SOURCES = (A, A, B, I)
SINKS = (B, I, J, J)
MOST_RING_PASSES = 40
RING_TOLERANCE = 1e-7  # of the edges' laws [Pa]
# At zero flow an open edge has no slope, and a flow around the ring meets no resistance: this
# part of the impedances keeps the matrix regular. It steers the steps, not where they end.
FIRMNESS = 1e-9
# Of K': a spool that creeps towards null for ever leaves openings whose squares vanish.
LEAST_CONDUCTANCE = 1e-60


@formula
def opening(displacement):
    """Return the opening [m] of an edge, 0 while it overlaps; what is no number stays none."""
    return 0.0 if displacement <= 0.0 else displacement


@formula
def conductance(flow_gain, displacement):
    """Return K' [m^3/(s sqrt(Pa))] of an edge, 0 where its square is no longer a number."""
    k = flow_gain * opening(displacement)
    return 0.0 if k < LEAST_CONDUCTANCE else k


@formula
def edge_coefficients(valve, spool_1, spool_2, coefficient):
    """
    Write K' [m^3/(s sqrt(Pa))] of the four edges at two displacements [m] into `coefficient`.

    Spool 1 opens PA (+) and AT (-), spool 2 BT (+) and PB (-); one spool moves as both.
    """
    coefficient[0] = conductance(valve.flow_gain[0], spool_1 - valve.overlap[0])
    coefficient[1] = conductance(valve.flow_gain[1], -spool_2 - valve.overlap[1])
    coefficient[2] = conductance(valve.flow_gain[2], -spool_1 - valve.overlap[2])
    coefficient[3] = conductance(valve.flow_gain[3], spool_2 - valve.overlap[3])


@formula
def solve_valve(ends, velocity, valve_edges, ring):
    """
    Update the outflow velocities [m/s] (4,) of stations A, B, I, J in place.

    ends: four Ends; valve_edges: (K' of the edges (4,), their leakage); ring: work array (6, 4),
    row 5 the edge flows.
    """
    coefficient, leakage = valve_edges
    direct = coefficient[0] > 0.0 or coefficient[3] > 0.0
    reverse = coefficient[1] > 0.0 or coefficient[2] > 0.0
    if leakage == 0.0 and not (direct and reverse):
        if reverse:
            velocity[A], velocity[I] = solve_orifice(
                ends[A], ends[I], coefficient[1], 0.0)
            velocity[B], velocity[J] = solve_orifice(
                ends[B], ends[J], coefficient[2], 0.0)
        else:
            velocity[A], velocity[B] = solve_orifice(
                ends[A], ends[B], coefficient[0], 0.0)
            velocity[I], velocity[J] = solve_orifice(
                ends[I], ends[J], coefficient[3], 0.0)
        return
    for k in range(4):
        velocity[k] = ends[k].velocity
    for _ in range(MOST_PASSES):
        done = True
        for k in range(4):
            p, q, z, flatness = end_relation(ends[k], velocity[k])
            ring[0, k] = p + z * q
            ring[1, k] = z
            ring[2, k] = q
            ring[3, k] = flatness
        solve_ring(ring, coefficient, leakage)
        flow = ring[5]
        ring[4, A] = flow[0] + flow[1]
        ring[4, B] = flow[2] - flow[0]
        ring[4, I] = flow[3] - flow[1]
        ring[4, J] = -flow[2] - flow[3]
        for k in range(4):
            change = (ring[4, k] - ring[2, k]) * ring[3, k]
            velocity[k] += change
            done = done and settled(velocity[k], change)
        if done:
            break


@formula
def ring_residual(ring, flow, coefficient, leakage):
    """Return the four pressure defects [Pa] of the edges and their slopes [Pa s/m^3]."""
    p_a = ring[0, A] - ring[1, A] * (flow[0] + flow[1])
    p_b = ring[0, B] - ring[1, B] * (flow[2] - flow[0])
    p_i = ring[0, I] - ring[1, I] * (flow[3] - flow[1])
    p_j = ring[0, J] + ring[1, J] * (flow[2] + flow[3])
    drop_0, slope_0 = orifice_drop(flow[0], coefficient[0], leakage)
    drop_1, slope_1 = orifice_drop(flow[1], coefficient[1], leakage)
    drop_2, slope_2 = orifice_drop(flow[2], coefficient[2], leakage)
    drop_3, slope_3 = orifice_drop(flow[3], coefficient[3], leakage)
    defect = (p_a - p_b - drop_0, p_a - p_i - drop_1, p_b - p_j - drop_2, p_i - p_j - drop_3)
    return defect, (slope_0, slope_1, slope_2, slope_3)


@formula
def defect_size(defect, coefficient, leakage):
    """Return the largest defect [Pa] among the edges that conduct."""
    largest = 0.0
    for k in range(4):
        if coefficient[k] > 0.0 or leakage > 0.0:
            largest = max(largest, abs(defect[k]))
    return largest


@formula
def solve_ring(ring, coefficient, leakage):
    """Solve the four edge flows ring[5] [m^3/s] for pressures ring[0] and impedances ring[1]."""
    flow = ring[5]
    for k in range(4):
        if coefficient[k] == 0.0 and leakage == 0.0:
            flow[k] = 0.0
    defect, slope = ring_residual(ring, flow, coefficient, leakage)
    size = defect_size(defect, coefficient, leakage)
    if size < RING_TOLERANCE:
        return
    for _ in range(MOST_RING_PASSES):
        change = newton_direction(ring[1], defect, slope, coefficient, leakage)
        damping = 1.0
        before = (flow[0], flow[1], flow[2], flow[3])
        for _ in range(20):
            for k in range(4):
                flow[k] = before[k] + damping * change[k]
            defect, slope = ring_residual(ring, flow, coefficient, leakage)
            trial = defect_size(defect, coefficient, leakage)
            if trial <= size * (1.0 - 0.1 * damping) or trial < 1e-9:
                break
            damping *= 0.5
        settled = trial < RING_TOLERANCE or trial >= size
        size = trial
        if settled:
            break


@formula
def newton_direction(impedance, defect, slope, coefficient, leakage):
    """
    Return the Newton step of the four flows [m^3/s].

    The matrix is symmetric and positive: impedances of shared stations plus the edges' slopes.
    An edge that does not conduct keeps zero flow.
    """
    z_a, z_b, z_i, z_j = impedance[A], impedance[B], impedance[I], impedance[J]
    d_0, d_1, d_2, d_3 = z_a + z_b, z_a + z_i, z_b + z_j, z_i + z_j
    m_01, m_02, m_13, m_23 = z_a, -z_b, -z_i, z_j
    r_0, r_1, r_2, r_3 = defect
    least = FIRMNESS * (z_a + z_b + z_i + z_j)
    d_0, d_1 = d_0 + (slope[0] + least), d_1 + (slope[1] + least)
    d_2, d_3 = d_2 + (slope[2] + least), d_3 + (slope[3] + least)
    if leakage == 0.0:
        if coefficient[0] == 0.0:
            m_01, m_02, r_0 = 0.0, 0.0, 0.0
        if coefficient[1] == 0.0:
            m_01, m_13, r_1 = 0.0, 0.0, 0.0
        if coefficient[2] == 0.0:
            m_02, m_23, r_2 = 0.0, 0.0, 0.0
        if coefficient[3] == 0.0:
            m_13, m_23, r_3 = 0.0, 0.0, 0.0
    # L D L^T of the symmetric 4 x 4 matrix, rows in the order of the edges
    l_1, l_2 = m_01 / d_0, m_02 / d_0
    e_1 = d_1 - l_1 * m_01
    f_12 = -l_1 * m_02
    l_12, l_13 = f_12 / e_1, m_13 / e_1
    e_2 = d_2 - l_2 * m_02 - l_12 * f_12
    f_23 = m_23 - l_12 * m_13
    l_23 = f_23 / e_2
    e_3 = d_3 - l_13 * m_13 - l_23 * f_23
    s_1 = r_1 - l_1 * r_0
    s_2 = r_2 - l_2 * r_0 - l_12 * s_1
    s_3 = r_3 - l_13 * s_1 - l_23 * s_2
    x_3 = s_3 / e_3
    x_2 = s_2 / e_2 - l_23 * x_3
    x_1 = s_1 / e_1 - l_12 * x_2 - l_13 * x_3
    x_0 = r_0 / d_0 - l_1 * x_1 - l_2 * x_2
    return x_0, x_1, x_2, x_3


def spool_transition(natural_frequency: float, damping_ratio: float,
                     step_time: float) -> np.ndarray:
    """
    Return the 2 x 2 transition matrix of (deviation, velocity) over one step.

    x'' + 2 zeta omega x' + omega^2 x = 0, omega = 2 pi f [Hz]; scaling and squaring of the series.
    """
    omega = 2.0 * math.pi * natural_frequency
    generator = step_time * np.array(
        [[0.0, 1.0], [-omega ** 2, -2.0 * damping_ratio * omega]])
    scale = np.diag([1.0, max(omega, 1e-300)])
    generator = np.linalg.solve(scale, generator @ scale) if omega > 0.0 else generator
    halvings = max(0, math.ceil(math.log2(max(np.abs(generator).sum(), 1e-12))) + 1)
    small = generator / 2 ** halvings
    result, term = np.eye(2), np.eye(2)
    for k in range(1, 20):
        term = term @ small / k
        result = result + term
    for _ in range(halvings):
        result = result @ result
    return scale @ result @ np.linalg.inv(scale) if omega > 0.0 else result


@formula
def let_go(transition, deviation, velocity):
    """Return a spool's (deviation [m], velocity [m/s]) one step after."""
    return (multiply_add(transition[0], deviation, transition[1] * velocity),
            multiply_add(transition[2], deviation, transition[3] * velocity))


@formula
def move_spool(valve, position, velocity, command):
    """
    Return the spool's (displacement [m], velocity [m/s]) one step after, towards a command [m].

    Second order with the exact transition of a held command (valve.transition, row-major 2 x 2
    for the deviation from the command), or ideal; then slew-rate and stroke limits.
    """
    target = command
    if abs(command) > valve.stroke:
        target = math.copysign(valve.stroke, command)
    if valve.natural_frequency > 0.0:
        deviation = position - target
        moved, speed = let_go(valve.transition, deviation, velocity)
        moved += target
    else:
        moved = target
        speed = (moved - position) / valve.step_time
    if valve.slew_rate > 0.0:
        reach = valve.slew_rate * valve.step_time
        if abs(moved - position) > reach:
            moved = position + math.copysign(reach, moved - position)
        speed = min(max(speed, -valve.slew_rate), valve.slew_rate)
    if abs(moved) > valve.stroke:
        moved = math.copysign(valve.stroke, moved)
        speed = 0.0
    return moved, speed
