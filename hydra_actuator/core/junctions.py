# SPDX-License-Identifier: Apache-2.0
"""
The junctions: which ends meet, and which formula answers them with outflow velocities.

A junction sees Ends (a wave and an impedance each), never a mesh.
"""

from hydra_actuator.core.cavity import face_strength
from hydra_actuator.core.compilation import formula
from hydra_actuator.core.end import End
from hydra_actuator.core.orifice import solve_orifice
from hydra_actuator.core.orifices import solve_open_orifices
from hydra_actuator.core.piston import (
    face_pressures,
    force_on_piston,
    implicitness,
    move_piston,
)
from hydra_actuator.core.records import (
    CLOSED,
    FLOW,
    ORIFICE,
    PISTON,
    PRESSURE,
    PUMP,
    VALVE,
    WALL,
)
from hydra_actuator.core.source import solve_flow_end, solve_pressure_end, solve_pump
from hydra_actuator.core.valve import solve_valve


@formula
def end_of(model, state, end):
    """Return the End of a domain as the boundaries see it."""
    d = end // 2
    if len(model.extras) == 0:
        return End(
            state.end_wave[end], state.end_velocity[end], model.slowness[d],
            model.bulk_modulus[d], model.area[d], model.impedance[d], model.inverse_area[d],
            0.0, 0.0, 0.0)
    strength, held = model.end_strength[d], 0.0
    if strength > 0.0 and model.moving[d] == 1 and end % 2 == 1:
        strength, held = face_strength(model, state, d), state.face_held[d]
    elif strength > 0.0:
        held = strength / state.end_star[end]
    return End(
        state.end_wave[end], state.end_velocity[end], model.slowness[d], model.bulk_modulus[d],
        model.area[d], model.impedance[d], model.inverse_area[d], strength, held, model.floor)


@formula
def solve_junctions(model, state, inputs):
    """Solve all junctions, four orifices at once where that can be done."""
    together = solve_open_orifices(model, state)
    for j in range(model.junctions.size):
        kind = model.junctions[j].kind
        if not (together and (kind == VALVE or kind == ORIFICE)):
            solve_junction(model, state, j, inputs)


@formula
def solve_junction(model, state, j, inputs):
    """Solve one junction: its ends' outflow velocities at the new level."""
    junction = model.junctions[j]
    kind, end = junction.kind, junction.end[0]
    velocity = state.end_velocity
    if kind == CLOSED:
        velocity[end] = 0.0
    elif kind == PRESSURE:
        velocity[end] = solve_pressure_end(
            end_of(model, state, end), inputs[junction.input], state.end_held[end])
    elif kind == FLOW:
        velocity[end] = solve_flow_end(end_of(model, state, end), inputs[junction.input])
    elif kind == PUMP:
        velocity[end], state.oil_stored[1] = solve_pump(
            end_of(model, state, end), model.source[0], state.oil_stored[0], model.step_time)
    elif kind == ORIFICE:
        other = junction.end[1]
        velocity[end], velocity[other] = solve_orifice(
            end_of(model, state, end), end_of(model, state, other),
            junction.coefficient, junction.leakage)
    elif kind == VALVE:
        solve_valve_junction(model, state, junction)
    elif kind == PISTON:
        solve_piston_junction(model, state, junction, inputs)
    elif kind == WALL:
        velocity[end] = inputs[junction.input]
        d = end // 2
        state.length[d] = (
            state.old_length[d]
            + 0.5 * model.step_time * (velocity[end] + state.old_velocity[d]))


@formula
def solve_valve_junction(model, state, junction):
    """Solve the four edges of the valve."""
    ends = (
        end_of(model, state, junction.end[0]), end_of(model, state, junction.end[1]),
        end_of(model, state, junction.end[2]), end_of(model, state, junction.end[3]))
    solve_valve(ends, state.valve_velocity, (state.edge_coefficient, model.valve[0].leakage),
                state.ring)
    for k in range(4):
        state.end_velocity[junction.end[k]] = state.valve_velocity[k]


@formula
def solve_piston_junction(model, state, junction, inputs):
    """Move the piston and both faces."""
    face_1, face_2 = junction.end[0], junction.end[1]
    d_1, d_2 = face_1 // 2, face_2 // 2
    piston, motion = model.piston[0], state.piston[0]
    ends = (end_of(model, state, face_1), end_of(model, state, face_2))
    theta = implicitness(ends, piston, model.step_time)
    load_force = inputs[junction.input]
    slip = (motion.slip_1, motion.slip_2)
    old = (motion.position, motion.velocity, motion.force, theta, model.step_time, slip)
    position, velocity, hit = move_piston(
        ends, piston, old, load_force, state.end_velocity[face_1] - motion.slip_1)
    p_1, p_2, _, _, u_1, u_2 = face_pressures(ends, piston, velocity, slip)
    motion.new_position = position
    motion.new_velocity = velocity
    motion.new_force = force_on_piston(
        (model.area[d_1], model.area[d_2]), (p_1, p_2), piston, (position, velocity), load_force)
    motion.hit = hit
    motion.slip_1, motion.slip_2 = u_1 - velocity, u_2 - velocity
    state.end_velocity[face_1] = u_1
    state.end_velocity[face_2] = -u_2
    state.length[d_1] = piston.length_1 + position
    state.length[d_2] = piston.length_2 - position
