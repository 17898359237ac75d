# SPDX-License-Identifier: Apache-2.0
"""
The sweep of oil with steady, unsteady friction or gas: as the plain sweep, with drag at nodes.

The drag J [m/s^2] of a node is known at the old level and estimated at arrival; a characteristic
loses the mean of foot and arrival, J at the foot linear between its two neighbours. Each stage is
a loop over all nodes with offsets that start at 0, so that it vectorises.
"""

import math

from hydra_actuator.core.compilation import formula
from hydra_actuator.core.friction import LAST_PLACE, steady_drag, TERMS
from hydra_actuator.core.line import cubic


@formula
def sweep_with_drag(model, state, passes):
    """Write P and Q [m/s] one step later into new_p and new_q, all nodes but two at each end."""
    leave_feet(model, state)
    for _ in range(len(passes) - 1):
        estimate_drag(model, state)
        return_to_feet(model, state)


@formula
def leave_feet(model, state):
    """Do the first pass: u and J at the foot alone; keep the feet in theta_p, theta_q."""
    wave_p, wave_q, drag = state.wave_p, state.wave_q, state.drag
    courant, slope = model.courant, model.slope
    for i in range(wave_p.size - 4):
        p_behind, p_here, p_ahead = wave_p[i + 1], wave_p[i + 2], wave_p[i + 3]
        q_ahead, q_here, q_behind = wave_q[i + 1], wave_q[i + 2], wave_q[i + 3]
        a_1, a_2, a_3 = cubic(p_ahead, p_here, p_behind, wave_p[i], model.third_order)
        b_1, b_2, b_3 = cubic(q_ahead, q_here, q_behind, wave_q[i + 4], model.third_order)
        sigma, kappa = courant[i + 2], slope[i + 2]
        here = p_here - q_here
        theta_p = sigma + kappa * (here + sigma * ((p_behind - q_ahead) - here))
        theta_q = sigma - kappa * (here + sigma * ((p_ahead - q_behind) - here))
        p = p_here + theta_p * (a_1 + theta_p * (a_2 + theta_p * a_3))
        q = q_here + theta_q * (b_1 + theta_q * (b_2 + theta_q * b_3))
        j = drag[i + 2]
        state.new_p[i + 2] = p - model.step_time * (j + theta_p * (drag[i + 1] - j))
        state.new_q[i + 2] = q + model.step_time * (j + theta_q * (drag[i + 3] - j))
        state.theta_p[i + 2] = theta_p
        state.theta_q[i + 2] = theta_q


@formula
def return_to_feet(model, state):
    """Do a further pass: the mean of foot and arrival for u and for J."""
    wave_p, wave_q, drag = state.wave_p, state.wave_q, state.drag
    courant, slope, half = model.courant, model.slope, 0.5 * model.step_time
    for i in range(wave_p.size - 4):
        p_behind, p_here, p_ahead = wave_p[i + 1], wave_p[i + 2], wave_p[i + 3]
        q_ahead, q_here, q_behind = wave_q[i + 1], wave_q[i + 2], wave_q[i + 3]
        a_1, a_2, a_3 = cubic(p_ahead, p_here, p_behind, wave_p[i], model.third_order)
        b_1, b_2, b_3 = cubic(q_ahead, q_here, q_behind, wave_q[i + 4], model.third_order)
        sigma, kappa = courant[i + 2], 0.5 * slope[i + 2]
        theta_p, theta_q = state.theta_p[i + 2], state.theta_q[i + 2]
        here = p_here - q_here
        arrival = state.new_p[i + 2] - state.new_q[i + 2]
        theta_p = sigma + kappa * (here + theta_p * ((p_behind - q_ahead) - here) + arrival)
        theta_q = sigma - kappa * (here + theta_q * ((p_ahead - q_behind) - here) + arrival)
        p = p_here + theta_p * (a_1 + theta_p * (a_2 + theta_p * a_3))
        q = q_here + theta_q * (b_1 + theta_q * (b_2 + theta_q * b_3))
        j, j_new = drag[i + 2], state.new_drag[i + 2]
        state.new_p[i + 2] = p - half * (j + theta_p * (drag[i + 1] - j) + j_new)
        state.new_q[i + 2] = q + half * (j + theta_q * (drag[i + 3] - j) + j_new)
        state.theta_p[i + 2] = theta_p
        state.theta_q[i + 2] = theta_q


@formula
def estimate_drag(model, state):
    """Write J [m/s^2] at the velocities of new_p and new_q into new_drag."""
    take_velocities(state)
    look_up_damping(model, state)
    steady_drags(model, state, state.new_drag)
    if model.unsteady == 1:
        new_drag, fading, change = state.new_drag, state.fading, state.change
        for i in range(new_drag.size):
            new_drag[i] += fading[i] + model.liveliness[i] * change[i]


@formula
def take_velocities(state):
    """Write u of new_p and new_q [m/s] and its change over the step, by node."""
    new_p, new_q, wave_p, wave_q = state.new_p, state.new_q, state.wave_p, state.wave_q
    for i in range(new_p.size):
        velocity = 0.5 * (new_p[i] - new_q[i])
        state.velocity[i] = velocity
        state.change[i] = velocity - 0.5 * (wave_p[i] - wave_q[i])


@formula
def look_up_damping(model, state):
    """
    Write h [1/s] at the nodes' velocities; lines without a table keep 0.

    Two loops: the place in the table vectorises, the look-up does not.
    """
    if model.tabled == 0:
        return
    velocity, place, damping = state.velocity, state.place, model.damping
    for i in range(place.size):
        place[i] = min(math.sqrt(abs(velocity[i])) * model.table_scale, LAST_PLACE)
    for i in range(place.size):
        k = int(place[i])
        start = model.table_start[i] + k
        state.damping[i] = damping[start] + (place[i] - k) * (damping[start + 1] - damping[start])


@formula
def steady_drags(model, state, drag):
    """Write the steady J [m/s^2] at the nodes' velocities into `drag`."""
    velocity, damping, loss = state.velocity, state.damping, model.loss
    for i in range(drag.size):
        u = velocity[i]
        drag[i] = u * (0.5 * loss[i] * abs(u) + damping[i])


@formula
def drag_at(model, state, i, velocity):
    """Return J [m/s^2] of a node that goes from its old velocity to `velocity` [m/s]."""
    change = velocity - 0.5 * (state.wave_p[i] - state.wave_q[i])
    steady = steady_drag(
        velocity, model.loss[i], (model.damping, model.table_start[i]), model.table_scale)
    return steady + state.fading[i] + model.liveliness[i] * change


@formula
def remember_drag(model, state):
    """Take the velocities of new_p and new_q as the new level: renew memory and drag."""
    take_velocities(state)
    look_up_damping(model, state)
    steady_drags(model, state, state.drag)
    if model.unsteady == 0:
        return
    drag, fading, change = state.drag, state.fading, state.change
    for i in range(drag.size):
        drag[i] += model.inertia[i] * change[i]
        fading[i] = 0.0
    for k in range(TERMS):
        remember_term(state, state.memory[k], model.decay[k], model.gain[k])


@formula
def remember_term(state, memory, decay, gain):
    """Renew one term of the friction's memory at all nodes."""
    change, drag, fading = state.change, state.drag, state.fading
    for i in range(memory.size):
        kept = decay[i] * memory[i] + gain[i] * change[i]
        memory[i] = kept
        drag[i] += kept
        fading[i] += decay[i] * kept
