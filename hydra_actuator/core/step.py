# SPDX-License-Identifier: Apache-2.0
"""
One time step of a chain, as a list of stages; formulas live in the files they are named after.

    spools move -> ghosts -> sweep of all nodes -> (arriving waves -> junctions) per pass
    -> ends and chamber meshes take the new level
"""

import math

from hydra_actuator.core.cavity import fill_cavities, read_beside_faces, share_face_gas
from hydra_actuator.core.chamber import extend_to_face, renew_last_nodes, wave_at_face
from hydra_actuator.core.compilation import formula
from hydra_actuator.core.drag import drag_at, remember_drag, sweep_with_drag
from hydra_actuator.core.end import state_at
from hydra_actuator.core.junctions import end_of, solve_junctions
from hydra_actuator.core.line import arriving_wave, fill_ghost, sweep_domains
from hydra_actuator.core.records import VALVE
from hydra_actuator.core.valve import edge_coefficients, move_spool


@formula
def step(model, state, inputs, passes):
    """
    Advance the chain by one step time under the inputs of the new level, into new_p and new_q.

    Pass 1 takes u at the foot; at the ends, pass 2 takes the mean of foot and an arrival
    extrapolated from two steps (also second order), so the junctions are solved once; each
    further pass solves them again.
    """
    mesh = (model.courant, model.slope, model.friction)
    move_spools(model, state, inputs)
    continue_beyond_ends(model, state)
    if len(model.extras) == 0 or model.tabled == 0:
        sweep_domains(model, state, passes)
    else:
        sweep_with_drag(model, state, passes)
    extrapolate_ends(state)
    for k in range(max(1, len(passes) - 1)):
        arrive(model, state, mesh, (len(passes) == 1, k == 0))
        solve_junctions(model, state, inputs)
    take_new_level(model, state, passes)
    state.step[0] += 1


@formula
def extrapolate_ends(state):
    """Let the outflow velocities of all ends go on as they went in the last step."""
    for end in range(state.end_velocity.size):
        velocity = state.end_velocity[end]
        state.end_velocity[end] = velocity + (velocity - state.end_velocity_before[end])
        state.end_velocity_before[end] = velocity


@formula
def move_spools(model, state, inputs):
    """Move the valve's spools and set the opening of its edges."""
    for j in range(model.junctions.size):
        junction = model.junctions[j]
        if junction.kind == VALVE:
            valve = model.valve[0]
            for k in range(2):
                if valve.stuck == 1:
                    state.spool[2 * k + 1] = 0.0
                    continue
                command = inputs[junction.input + k] * valve.stroke
                if valve.command_lost == 1:
                    command = 0.0
                if valve.null_shift != 0.0:
                    command += valve.null_shift
                state.spool[2 * k], state.spool[2 * k + 1] = move_spool(
                    valve, state.spool[2 * k], state.spool[2 * k + 1], command)
            edge_coefficients(valve, state.spool[0], state.spool[2], state.edge_coefficient)


@formula
def continue_beyond_ends(model, state):
    """Fill the ghost nodes of all domains."""
    for d in range(model.start.size):
        first, cells = model.start[d], state.last[d]
        last = first + cells
        fill_ghost(state.wave_p, first, 1, cells, True)
        fill_ghost(state.wave_q, first, 1, cells, False)
        if model.moving[d] == 1:
            fraction = state.old_length[d] / model.spacing[d] - cells
            extend_to_face(state.wave_p, last, cells, (state.face_p[d], fraction), False)
            extend_to_face(state.wave_q, last, cells, (state.face_q[d, 0], fraction), True)
        else:
            fill_ghost(state.wave_p, last, -1, cells, False)
            fill_ghost(state.wave_q, last, -1, cells, True)


@formula
def arrive(model, state, mesh, stage):
    """
    Carry the waves to all ends.

    stage: (whether the foot alone gives u, whether this is the first pass at the ends).
    """
    foot_alone, first_pass = stage
    waves = (state.wave_p, state.wave_q)
    for d in range(model.start.size):
        first, left = model.start[d], 2 * d
        right, last = left + 1, first + state.last[d]
        state.end_wave[left], state.end_theta[left] = arriving_wave(
            state.wave_q, state.wave_p, first, 0, mesh, model.third_order,
            guess_at(state, left, foot_alone, first_pass))
        guess = guess_at(state, right, foot_alone, first_pass)
        if model.moving[d] == 1:
            if first_pass:
                state.length[d] = state.old_length[d] + 0.5 * model.step_time * (
                    state.old_velocity[d] + state.end_velocity[right])
            distance = state.length[d] / model.spacing[d] - state.last[d]
            state.end_wave[right], state.end_theta[right] = wave_at_face(
                waves, last, distance, mesh, model.third_order, guess)
        else:
            state.end_wave[right], state.end_theta[right] = arriving_wave(
                state.wave_p, state.wave_q, last, 1, mesh, model.third_order, guess)
        if len(model.extras) > 0 and model.tabled == 1 and model.moving[d] == 0:
            lose_to_drag(model, state, left, first, foot_alone)
            lose_to_drag(model, state, right, last, foot_alone)


@formula
def lose_to_drag(model, state, end, node, foot_alone):
    """Take the wall's friction from the wave that arrived at a fixed end."""
    back = 1 if end % 2 == 0 else -1
    sign = -1.0 if end % 2 == 0 else 1.0
    drag = state.drag[node] + state.end_theta[end] * (state.drag[node + back] - state.drag[node])
    if not foot_alone:
        drag = 0.5 * (drag + drag_at(model, state, node, sign * state.end_velocity[end]))
    state.end_wave[end] -= model.step_time * sign * drag


@formula
def guess_at(state, end, foot_alone, first_pass):
    """Return (outflow velocity, theta) an arriving wave starts from, NaN for what is not used."""
    velocity = math.nan if foot_alone else state.end_velocity[end]
    theta = math.nan if first_pass else state.end_theta[end]
    return velocity, theta


@formula
def returned_wave(model, state, end):
    """Return the wave [m/s] that leaves an end after the junctions, and keep its gas pressure."""
    if len(model.extras) == 0 or model.end_strength[end // 2] == 0.0:
        return state.end_wave[end] - 2.0 * state.end_velocity[end]
    at = end_of(model, state, end)
    mu, state.end_star[end] = state_at(at, state.end_velocity[end])
    if model.moving[end // 2] == 1 and end % 2 == 1:
        state.face_held[end // 2] = at.strength / state.end_star[end]
    return 2.0 * mu - state.end_wave[end]


@formula
def take_new_level(model, state, passes):
    """Write the ends into the field, move the meshes with their faces, keep the new level."""
    for d in range(model.start.size):
        first, left = model.start[d], 2 * d
        right = left + 1
        before = state.last[d]
        new_last = before
        state.new_q[first] = state.end_wave[left]
        state.new_p[first] = returned_wave(model, state, left)
        returned = returned_wave(model, state, right)
        if len(model.extras) > 0:
            state.star[first] = state.end_star[left]
        if model.moving[d] == 1:
            new_last = int(state.length[d] / model.spacing[d])
            if new_last >= 1 and new_last <= model.capacity[d]:
                renew_last_nodes(model, state, d, new_last, returned, passes)
                state.last[d] = new_last
            for k in range(2, 0, -1):
                state.face_q[d, k] = state.face_q[d, k - 1]
            state.face_q[d, 0] = returned
            state.face_p[d] = state.end_wave[right]
            state.old_length[d] = state.length[d]
            state.old_velocity[d] = state.end_velocity[right]
            if len(model.extras) > 0 and model.end_strength[d] > 0.0:
                share_face_gas(model, state, d, before)
        else:
            state.new_p[first + new_last] = state.end_wave[right]
            state.new_q[first + new_last] = returned
            if len(model.extras) > 0:
                state.star[first + new_last] = state.end_star[right]
    if len(model.extras) > 0:
        if model.gas == 1:
            fill_cavities(model, state)
            read_beside_faces(model, state)
        if model.tabled == 1:
            remember_drag(model, state, len(passes) > 1)
    motion = state.piston[0]
    motion.position, motion.velocity = motion.new_position, motion.new_velocity
    motion.force = motion.new_force
    motion.stop_hits += motion.hit
    motion.hit = 0
    state.oil_stored[0] = state.oil_stored[1]
