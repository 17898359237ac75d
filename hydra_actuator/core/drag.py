# SPDX-License-Identifier: Apache-2.0
"""
The sweep of oil with steady or unsteady friction: as the plain sweep, with drag at nodes.

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
    velocity, place, damping = state.velocity, state.place, model.damping
    for i in range(place.size):
        wanted = math.sqrt(abs(velocity[i])) * model.table_scale
        # so put that what is no number has a place in the table too
        place[i] = wanted if wanted < LAST_PLACE else LAST_PLACE
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
def remember_drag(model, state, looked_up):
    """
    Take the velocities of new_p and new_q as the new level: renew memory and drag.

    looked_up: whether `damping` is that of the velocities a pass ago. It then serves inside the
    lines (it errs with the change of u from pass to pass, 1e-6 of u), not at the ends.
    """
    take_velocities(state)
    if not looked_up:
        look_up_damping(model, state)
    steady_drags(model, state, state.drag)
    if looked_up:
        for end in range(2 * model.start.size):
            d = end // 2
            i = model.start[d] + (end - 2 * d) * state.last[d]
            state.drag[i] = steady_drag(
                state.velocity[i], model.loss[i], (model.damping, model.table_start[i]),
                model.table_scale)
    if model.unsteady == 1:
        remember(model, state)


@formula
def remember(model, state):
    """Renew the friction's memory at all nodes and add it to the drag, three terms at a time."""
    drag, fading, change = state.drag, state.fading, state.change
    for i in range(drag.size):
        drag[i] += model.inertia[i] * change[i]
        fading[i] = 0.0
    for k in range(0, TERMS, 3):
        remember_three(state, (state.memory[k], state.memory[k + 1], state.memory[k + 2]),
                       (model.decay[k], model.decay[k + 1], model.decay[k + 2]),
                       (model.gain[k], model.gain[k + 1], model.gain[k + 2]))


@formula
def remember_three(state, memory, decay, gain):
    """Renew three terms at all nodes: one alone reads too often, six do not vectorise."""
    change, drag, fading = state.change, state.drag, state.fading
    y_1, y_2, y_3 = memory
    decay_1, decay_2, decay_3 = decay
    gain_1, gain_2, gain_3 = gain
    for i in range(drag.size):
        du, d_1, d_2, d_3 = change[i], decay_1[i], decay_2[i], decay_3[i]
        kept_1 = d_1 * y_1[i] + gain_1[i] * du
        kept_2 = d_2 * y_2[i] + gain_2[i] * du
        kept_3 = d_3 * y_3[i] + gain_3[i] * du
        y_1[i], y_2[i], y_3[i] = kept_1, kept_2, kept_3
        drag[i] += kept_1 + kept_2 + kept_3
        fading[i] += d_1 * kept_1 + d_2 * kept_2 + d_3 * kept_3
