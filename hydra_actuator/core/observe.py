# SPDX-License-Identifier: Apache-2.0
"""
What can be read from a state: cross-sections, the field, the limits of the method.

Reading writes ghost nodes only, which every step fills anew: it never changes a later step.
"""

import math

from hydra_actuator.core.boiling import write_cavities
from hydra_actuator.core.compilation import formula, kernel
from hydra_actuator.core.fluid import pressure_of
from hydra_actuator.core.line import interpolate
from hydra_actuator.core.step import continue_beyond_ends
import numpy as np

SOUND, NOT_A_NUMBER, TOO_FAST, TOO_SHORT = range(4)

# A section: a station is an end; another lies in a line, or (cylinder 1) in the chamber that
# covers it, chamber `domain` up to its face, the next domain beyond.
SECTION = np.dtype([
    ('end', np.int64), ('domain', np.int64), ('cylinder', np.int64), ('position', np.float64)],
    align=True)


@formula
def find_limits(model, state):
    """Write the first broken limit into state.fault and return (code, largest |u|/c)."""
    largest = 0.0
    for d in range(model.start.size):
        first, last = model.start[d], model.start[d] + state.last[d]
        worst = 0.0
        for i in range(first, last + 1):
            speed = abs(state.wave_p[i] - state.wave_q[i])
            # a NaN, once taken, is never replaced: no comparison with it is true
            if speed > worst or speed != speed:
                worst = speed
        if model.moving[d] == 1:
            speed = abs(state.face_p[d] - state.face_q[d, 0])
            if speed > worst or speed != speed:
                worst = speed
        mach = 0.5 * worst / model.wave_speed[d]
        if not mach <= largest:
            largest = mach
        if not mach <= model.max_mach or state.length[d] < model.spacing[d]:
            state.fault[1] = d
            if not mach < math.inf:
                state.fault[0], state.fault[2] = NOT_A_NUMBER, mach
            elif mach > model.max_mach:
                state.fault[0], state.fault[2] = TOO_FAST, mach
            else:
                state.fault[0], state.fault[2] = TOO_SHORT, state.length[d]
            return int(state.fault[0]), mach
    return SOUND, largest


@formula
def runs_away(model, state):
    """Return whether oil leaves an end at more than the allowed speed, or at no number."""
    most = model.max_mach
    for end in range(state.end_velocity.size):
        if not abs(state.end_velocity[end]) < most * model.wave_speed[end // 2]:
            return True
    return False


@formula
def end_values(model, state, end):
    """
    Return (gauge pressure [Pa], velocity [m/s] from pump to tank) at an end.

    With gas there the velocity is the boundary's, the piston's at its faces, beyond the cavity
    that may lie between boundary and oil; the oil's own is (P - Q)/2.
    """
    d = end // 2
    if len(model.extras) > 0 and model.end_strength[d] > 0.0:
        away = state.end_velocity[end] if end % 2 == 1 else -state.end_velocity[end]
        return state.end_star[end] - model.floor, away * model.direction[d]
    i = model.start[d] + (state.last[d] if end % 2 == 1 else 0)
    p, q = state.wave_p[i], state.wave_q[i]
    if end % 2 == 1 and model.moving[d] == 1:
        p, q = state.face_p[d], state.face_q[d, 0]
    pressure = pressure_of(0.5 * (p + q), model.wave_speed[d], model.bulk_modulus[d])
    return pressure, 0.5 * (p - q) * model.direction[d]


@formula
def values_within(model, state, d, distance):
    """Return (gauge pressure [Pa], streamline velocity [m/s]) at a distance [m] from node 0."""
    cells = distance / model.spacing[d]
    node = min(max(int(cells), 0), state.last[d])
    i, f = model.start[d] + node, cells - node
    wave_p, wave_q = state.wave_p, state.wave_q
    if model.moving[d] == 1 and node == state.last[d]:
        reach = state.length[d] / model.spacing[d] - node
        p = within_partial_cell(wave_p, i, node, (state.face_p[d], reach, f))
        q = within_partial_cell(wave_q, i, node, (state.face_q[d, 0], reach, f))
    else:
        p = interpolate(wave_p[i - 1], wave_p[i], wave_p[i + 1], wave_p[i + 2], f, 1.0)
        q = interpolate(wave_q[i - 1], wave_q[i], wave_q[i + 1], wave_q[i + 2], f, 1.0)
    velocity = 0.5 * (p - q) * model.direction[d]
    if model.end_strength[d] > 0.0:
        return gas_pressure_within(model, state, d, node, f) - model.floor, velocity
    return pressure_of(0.5 * (p + q), model.wave_speed[d], model.bulk_modulus[d]), velocity


@formula
def gas_pressure_within(model, state, d, node, fraction):
    """Return p* [Pa] between a whole node and the next or the face, linear, where gas is."""
    i = model.start[d] + node
    after, reach = state.star[i + 1], 1.0
    if model.moving[d] == 1 and node == state.last[d]:
        after = state.end_star[2 * d + 1]
        reach = max(state.length[d] / model.spacing[d] - node, 1e-9)
    elif node == state.last[d]:
        after = state.star[i]
    return state.star[i] + min(fraction / reach, 1.0) * (after - state.star[i])


@formula
def within_partial_cell(values, last_node, cells, place):
    """
    Return a wave between the last whole node and the face, by the parabola through both and one.

    place: (value at the face, its distance from the node, distance asked for), in cells. A point
    beyond the face reads the face.
    """
    face_value, reach, distance = place
    if distance >= reach:
        return face_value
    here = values[last_node]
    rise = face_value - here
    bend = 0.0
    if cells >= 1:
        bend = (rise - reach * (here - values[last_node - 1])) / (1.0 + reach)
    return here + distance / reach * (rise + (distance - reach) * bend)


@formula
def section_values(model, state, section):
    """Return (gauge pressure [Pa], streamline velocity [m/s]) at a section."""
    if section.end >= 0:
        return end_values(model, state, section.end)
    d = section.domain
    distance = section.position - model.origin[d]
    if section.cylinder == 1 and distance > state.length[d]:
        d += 1
        distance = model.origin[d] - section.position
    return values_within(model, state, d, distance)


@kernel
def observe(model, state, sections, ambient_pressure, inputs, row):
    """
    Write one observation row (layout: hydra_actuator.channels); return the status code.

    Pressures become absolute here.
    """
    code, mach = find_limits(model, state)
    continue_beyond_ends(model, state)
    motion = state.piston[0]
    row[0] = state.step[0] * model.step_time
    row[1] = motion.position
    row[2] = motion.velocity
    row[3] = hydraulic_force(model, state)
    row[4] = state.spool[0]
    row[5] = state.spool[2]
    row[6] = inputs[2]
    row[7] = mach
    count = sections.size
    for k in range(count):
        pressure, velocity = section_values(model, state, sections[k])
        row[8 + k] = pressure + ambient_pressure
        row[8 + count + k] = velocity
    write_cavities(model, state, ambient_pressure, row, 8 + 2 * count)
    return code


@formula
def hydraulic_force(model, state):
    """Return A1 p_E - A2 p_F [N], from gauge pressures, 0 without a piston."""
    force = 0.0
    sign = 1.0
    for d in range(model.start.size):
        if model.moving[d] == 1:
            pressure, _ = end_values(model, state, 2 * d + 1)
            force += sign * model.area[d] * pressure
            sign = -1.0
    return force


@kernel
def read_field(model, state, ambient_pressure, out):
    """
    Write absolute pressure [Pa] and velocity [m/s] of every node into out (nodes, 2).

    Streamline order; a face follows (or, mirrored, precedes) its chamber's grid; grid nodes that
    their chamber does not cover now are NaN. Ends read as `end_values` gives them.
    """
    row = 0
    for d in range(model.start.size):
        count = model.capacity[d] + 1 + model.moving[d]
        for k in range(count):
            index = k if model.direction[d] > 0.0 else count - 1 - k
            if index in (0, count - 1):
                pressure, velocity = end_values(model, state, 2 * d + (1 if index > 0 else 0))
                out[row, 0], out[row, 1] = pressure + ambient_pressure, velocity
            elif index > state.last[d]:
                out[row, 0], out[row, 1] = math.nan, math.nan
            else:
                i = model.start[d] + index
                p, q = state.wave_p[i], state.wave_q[i]
                pressure = pressure_of(
                    0.5 * (p + q), model.wave_speed[d], model.bulk_modulus[d])
                if model.strength[i] > 0.0:
                    pressure = state.star[i] - model.floor
                out[row, 0] = ambient_pressure + pressure
                out[row, 1] = 0.5 * (p - q) * model.direction[d]
            row += 1
    return row
