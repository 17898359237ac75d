# SPDX-License-Identifier: Apache-2.0
"""
The way of an actuator's state into its lane, and back.

What only junctions that are solved one by one change goes into a shadow of the state, so that the
state is as it was until its lane is left.
"""

import math

from hydra_actuator.core.compilation import formula
from hydra_actuator.core.junctions import end_of
from hydra_actuator.core.lanes import WIDTH
from hydra_actuator.core.piston import implicitness
from hydra_actuator.core.records import PISTON


@formula
def enter(ensemble, lane, model, state, shadow):
    """Bring the state of an actuator into its lane and its shadow."""
    copy_counts(state, shadow)
    for d in range(ensemble.start.size):
        at = WIDTH * d + lane
        ensemble.last[at] = state.last[d]
        ensemble.place[at] = WIDTH * (ensemble.start[d] + state.last[d]) + lane
        ensemble.length[at], ensemble.old_length[at] = state.length[d], state.old_length[d]
        ensemble.old_velocity[at], ensemble.face_p[at] = state.old_velocity[d], state.face_p[d]
        for k in range(3):
            ensemble.face_q[WIDTH * (3 * d + k) + lane] = state.face_q[d, k]
        first, own = WIDTH * ensemble.start[d] + lane, model.start[d]
        for k in range(state.last[d] + 1):
            ensemble.wave_p[first + WIDTH * k] = state.wave_p[own + k]
            ensemble.wave_q[first + WIDTH * k] = state.wave_q[own + k]
    for end in range(state.end_wave.size):
        at = WIDTH * end + lane
        ensemble.end_wave[at] = state.end_wave[end]
        ensemble.end_velocity[at] = state.end_velocity[end]
        ensemble.end_velocity_before[at] = state.end_velocity_before[end]
    for k in range(4):
        ensemble.spool[WIDTH * k + lane] = state.spool[k]
        ensemble.edge[WIDTH * k + lane] = state.edge_coefficient[k]
    enter_records(ensemble, lane, model, state)


@formula
def enter_records(ensemble, lane, model, state):
    """Bring the piston's motion, and what the source is now, into a lane."""
    motion, source = state.piston[0], model.source[0]
    ensemble.motion[lane] = motion.position
    ensemble.motion[WIDTH + lane] = motion.velocity
    ensemble.motion[2 * WIDTH + lane] = motion.force
    ensemble.relief_mu[lane], ensemble.relief_density[lane] = source.mu, source.relative_density
    # no pressure is that of the step before
    ensemble.tank_pressure[lane] = math.nan
    for j in range(model.junctions.size):
        junction = model.junctions[j]
        if junction.kind == PISTON:
            ends = (end_of(model, state, junction.end[0]), end_of(model, state, junction.end[1]))
            ensemble.theta[lane] = implicitness(ends, model.piston[0], model.step_time)


@formula
def leave(now, lane, model, state, shadow):
    """Take the state of an actuator from its lane and its shadow; now: with the newest waves."""
    copy_counts(shadow, state)
    for d in range(now.start.size):
        at = WIDTH * d + lane
        state.last[d] = now.last[at]
        state.length[d], state.old_length[d] = now.length[at], now.old_length[at]
        state.old_velocity[d], state.face_p[d] = now.old_velocity[at], now.face_p[at]
        for k in range(3):
            state.face_q[d, k] = now.face_q[WIDTH * (3 * d + k) + lane]
        first, own = WIDTH * now.start[d] + lane, model.start[d]
        for k in range(state.last[d] + 1):
            state.wave_p[own + k] = now.wave_p[first + WIDTH * k]
            state.wave_q[own + k] = now.wave_q[first + WIDTH * k]
    for end in range(state.end_wave.size):
        at = WIDTH * end + lane
        state.end_wave[end] = now.end_wave[at]
        state.end_velocity[end] = now.end_velocity[at]
        state.end_velocity_before[end] = now.end_velocity_before[at]
    for k in range(4):
        state.spool[k] = now.spool[WIDTH * k + lane]
        state.edge_coefficient[k] = now.edge[WIDTH * k + lane]
    motion = state.piston[0]
    motion.position = motion.new_position = now.motion[lane]
    motion.velocity = motion.new_velocity = now.motion[WIDTH + lane]
    motion.force = motion.new_force = now.motion[2 * WIDTH + lane]
    # what passed the ends was not added up: the balance begins anew
    state.mass[0].began = 0


@formula
def copy_counts(source, target):
    """Copy what only junctions that are solved one by one change, and the count of steps."""
    for k in range(4):
        target.valve_velocity[k] = source.valve_velocity[k]
        for i in range(6):
            target.ring[i, k] = source.ring[i, k]
    old, new = source.piston[0], target.piston[0]
    new.hit, new.stop_hits = old.hit, old.stop_hits
    new.slip_1, new.slip_2 = old.slip_1, old.slip_2
    target.oil_stored[0], target.oil_stored[1] = source.oil_stored[0], source.oil_stored[1]
    target.step[0] = source.step[0]
