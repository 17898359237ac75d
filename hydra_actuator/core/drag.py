# SPDX-License-Identifier: Apache-2.0
"""
The sweep of oil with steady or unsteady friction: as the plain sweep, with drag at nodes.

The drag J [m/s^2] of a node is known at the old level and estimated at arrival; a characteristic
loses the mean of foot and arrival, J at the foot linear between its two neighbours. Domains
without any friction are swept plainly.
"""

import math

from hydra_actuator.core.choices import at_most
from hydra_actuator.core.compilation import formula
from hydra_actuator.core.friction import damping_at, LAST_PLACE, steady_drag
from hydra_actuator.core.lanes import load, look_up, store, WIDTH
from hydra_actuator.core.line import cubic, inner_nodes, sweep_domain


@formula
def has_drag(model, d):
    """Return whether the wall of a domain slows the oil."""
    first = model.start[d]
    return model.loss[first] > 0.0 or model.table_start[first] > 0


@formula
def sweep_with_drag(model, state, passes):
    """Write P and Q [m/s] one step later into new_p and new_q, between the ends of all domains."""
    for d in range(model.start.size):
        nodes = inner_nodes(model, state, d)
        if has_drag(model, d):
            sweep_domain_with_drag(model, state, nodes, passes)
        else:
            sweep_domain(model, state, nodes, passes)


@formula
def sweep_domain_with_drag(model, state, nodes, passes):
    """
    Sweep nodes (first, end) of a domain, WIDTH at a time; see hydra_actuator.core.line.

    The first pass takes u and J at the foot alone, further passes their means of foot and arrival.
    """
    first, end = nodes
    sigma, kappa = model.courant[first], model.slope[first]
    half_kappa, half = 0.5 * kappa, 0.5 * model.step_time
    wave_p, wave_q, drag = state.wave_p, state.wave_q, state.drag
    wall = wall_of(model, first)
    for i in range(first, end, WIDTH):
        p_behind, p_here, p_ahead = load(wave_p, i - 1), load(wave_p, i), load(wave_p, i + 1)
        q_ahead, q_here, q_behind = load(wave_q, i - 1), load(wave_q, i), load(wave_q, i + 1)
        a_1, a_2, a_3 = cubic(
            p_ahead, p_here, p_behind, load(wave_p, i - 2), model.third_order)
        b_1, b_2, b_3 = cubic(
            q_ahead, q_here, q_behind, load(wave_q, i + 2), model.third_order)
        here = p_here - q_here
        rise_p = (p_behind - q_ahead) - here
        rise_q = (p_ahead - q_behind) - here
        theta_p = sigma + kappa * (here + sigma * rise_p)
        theta_q = sigma - kappa * (here + sigma * rise_q)
        p = p_here + theta_p * (a_1 + theta_p * (a_2 + theta_p * a_3))
        q = q_here + theta_q * (b_1 + theta_q * (b_2 + theta_q * b_3))
        j = load(drag, i)
        climb_p, climb_q = load(drag, i - 1) - j, load(drag, i + 1) - j
        p -= model.step_time * (j + theta_p * climb_p)
        q += model.step_time * (j + theta_q * climb_q)
        for _ in range(len(passes) - 1):
            arrival = p - q
            j_new = drag_on_arrival(model, state, i, wall, 0.5 * arrival)
            theta_p = sigma + half_kappa * (here + theta_p * rise_p + arrival)
            theta_q = sigma - half_kappa * (here + theta_q * rise_q + arrival)
            p = p_here + theta_p * (a_1 + theta_p * (a_2 + theta_p * a_3))
            q = q_here + theta_q * (b_1 + theta_q * (b_2 + theta_q * b_3))
            p -= half * (j + theta_p * climb_p + j_new)
            q += half * (j + theta_q * climb_q + j_new)
        store(state.new_p, i, p)
        store(state.new_q, i, q)


@formula
def wall_of(model, node):
    """
    Return (lambda / 2 [1/m], liveliness [1/s], start of the table) of a node's domain.

    Read once: a loop that writes to arrays would read them again at every turn.
    """
    return 0.5 * model.loss[node], model.liveliness[node], model.table_start[node]


@formula
def drag_on_arrival(model, state, i, wall, velocity):
    """
    Return J [m/s^2] of the nodes from i on that go to `velocity` [m/s]; keep their h in `damping`.

    wall: of their domain, see `wall_of`.
    """
    half_loss, liveliness, table_start = wall
    speed = abs(velocity)
    # so put that what is no number has a place in the table too
    place = at_most(math.sqrt(speed) * model.table_scale, LAST_PLACE)
    low, high, rest = look_up(model.damping, table_start, place)
    damping = low + rest * (high - low)
    store(state.damping, i, damping)
    change = velocity - 0.5 * (load(state.wave_p, i) - load(state.wave_q, i))
    steady = velocity * (half_loss * speed + damping)
    return steady + (load(state.fading, i) + liveliness * change)


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
    for d in range(model.start.size):
        if has_drag(model, d):
            first = model.start[d]
            last = first + state.last[d]
            for i in range(first, last + 1, max(state.last[d], 1) if looked_up else 1):
                speed = abs(0.5 * (state.new_p[i] - state.new_q[i]))
                state.damping[i] = damping_at(
                    speed, (model.damping, model.table_start[i]), model.table_scale)
            remember(model, state, first, last + 1)


@formula
def remember(model, state, first, end):
    """
    Renew drag and the friction's memory at the nodes of a domain, WIDTH at a time.

    Up to WIDTH - 1 nodes beyond the end are written too; none is another domain's.
    """
    loss, inertia = model.loss[first], model.inertia[first]
    memory = state.memory
    terms, terms_too = (memory[0], memory[1], memory[2]), (memory[3], memory[4], memory[5])
    decay, decay_too = three_of(model.decay, 0, first), three_of(model.decay, 3, first)
    gain, gain_too = three_of(model.gain, 0, first), three_of(model.gain, 3, first)
    for i in range(first, end, WIDTH):
        velocity = 0.5 * (load(state.new_p, i) - load(state.new_q, i))
        drag = velocity * (0.5 * loss * abs(velocity) + load(state.damping, i))
        if inertia > 0.0:
            change = velocity - 0.5 * (load(state.wave_p, i) - load(state.wave_q, i))
            kept, fading = remember_three(terms, i, change, decay, gain)
            kept_too, fading_too = remember_three(terms_too, i, change, decay_too, gain_too)
            drag = ((drag + inertia * change) + kept) + kept_too
            store(state.fading, i, fading + fading_too)
        store(state.drag, i, drag)


@formula
def three_of(table, row, node):
    """Return three numbers of a node from a row of a table (TERMS, N) on."""
    return table[row, node], table[row + 1, node], table[row + 2, node]


@formula
def remember_three(memory, i, change, decay, gain):
    """Renew three terms [m/s^2] of nodes; return their sum and what it will be if u stays."""
    decay_1, decay_2, decay_3 = decay
    gain_1, gain_2, gain_3 = gain
    kept_1 = decay_1 * load(memory[0], i) + gain_1 * change
    kept_2 = decay_2 * load(memory[1], i) + gain_2 * change
    kept_3 = decay_3 * load(memory[2], i) + gain_3 * change
    store(memory[0], i, kept_1)
    store(memory[1], i, kept_2)
    store(memory[2], i, kept_3)
    return kept_1 + kept_2 + kept_3, decay_1 * kept_1 + decay_2 * kept_2 + decay_3 * kept_3
