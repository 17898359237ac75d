# SPDX-License-Identifier: Apache-2.0
"""
Free gas and vapour: a cavity at every node and at every end (discrete gas cavity).

    V p* = alpha0 (ambient - p_v) A dx        p* = absolute pressure - p_v, gas at constant heat
    inside a line   V_new - V_old = (A dx/c) (2 mu - P - Q)
    at an end       V_new - V_old = dt A (v_boundary - v_line),  v_line = W - mu, half a cell

The last whole node of a chamber has no gas of its own: less than a cell lies between it and the
moving face, and gas at both would throw waves to and fro within a step. The face has it all, half
a cell and what lies beyond that node, and hands a cell's over to a node that gets another
neighbour. What is kept is volume; the amount grows and shrinks with the chamber.

P, Q, W are the waves that arrive; what leaves a node is 2 mu - Q and 2 mu - P. It is A dx/c, not
A dt, which on an interpolated grid would be too strong by one over the Courant number. In
velocity units both read

    mu = free - held + strength / p*

where free is (P + Q)/2 or W - v, held stands for the old volume and strength for the gas. Sources:
Wylie, "Simulation of vaporous and gaseous cavitation", J. Fluids Eng. 106, 1984, 307-311.
Neglected: growth of bubbles, solution and release of gas, vapour's own mass.
"""

import math

from hydra_actuator.core.choices import all_at_most, at_least, at_most, where_positive
from hydra_actuator.core.compilation import formula
from hydra_actuator.core.fluid import compression_series, relative_compression
from hydra_actuator.core.lanes import load, store, WIDTH

# Most rounds of `gas_balance` inside a line, where two leave 3e-9 of p* at a jump of 1 m/s in one
# step and 2e-13 at 0.1 m/s, and at ends, where the laws of the boundaries hold to 1e-10.
ROUNDS_INSIDE, ROUNDS_AT_END = 2, 3
# Of mu/c: where the series for the oil's pressure still is good to 3e-6, far beyond any oil.
STIFFEST = 1.5
# Of mu/c: over so short a way the oil's pressure is a straight line to rounding.
STRAIGHT = 1e-8
# Of a cell: a face that has just passed its last whole node keeps this much gas at least.
FARTHEST_INSIDE = -0.4


@formula
def quadratic(about, waves, strength, floor, oil):
    """
    Return (twice the steepness, linear term, root) of the balance, linear about a mu.

    For one node or for lanes; arguments as those of `gas_balance`. The oil's pressure is what is
    linear.
    """
    free, held = waves
    slowness, bulk_modulus = oil
    compression = compression_series(about * slowness)
    steepness = bulk_modulus * slowness * (1.0 + compression)
    linear = bulk_modulus * compression + floor - steepness * (about - free + held)
    twice = 2.0 * steepness
    root = abs(linear) + math.sqrt(linear * linear + twice * (2.0 * strength))
    return twice, linear, root


@formula
def gas_balance(waves, strength, floor, oil, rounds):
    """
    Return (mu [m/s], p* [Pa]) where oil and gas of a node agree.

    waves: (free, held) [m/s], strength [Pa m/s] as above; floor: ambient - p_v [Pa], which makes
    p* = p + floor; oil: (slowness 1/c [s/m], bulk modulus [Pa]). The unknown is the new volume
    strength/p*: each round takes the oil's pressure as linear in it, which leaves a quadratic
    with one positive root. The first is about oil that the gas leaves alone, but never about a
    pressure below vapour's, where oil cannot be. The volume balances to rounding, whatever the
    rounds.
    """
    free, held = waves
    slowness, bulk_modulus = oil
    mu = free
    volume = held
    deepest, stiffest = -floor / (bulk_modulus * slowness), STIFFEST / slowness
    for _ in range(rounds):
        about = min(max(mu, deepest), stiffest)
        steep, linear, root = quadratic(about, waves, strength, floor, oil)
        above = linear >= 0.0
        volume = (2.0 * strength if above else root) / (root + 1e-300 if above else steep)
        mu = free + (volume - held)
        # the few ends may stop at once; nodes stop together
        if rounds == ROUNDS_AT_END and abs(mu - about) * slowness <= STRAIGHT:
            break
    return mu, strength / (volume + 1e-300)


@formula
def balance_in_lanes(waves, strength, floor, oil):
    """
    Return what `gas_balance` does in ROUNDS_INSIDE rounds, of WIDTH nodes with gas.

    Most of the time the first leaves nothing to do for any of them.
    """
    free, held = waves
    slowness, bulk_modulus = oil
    mu, volume = free, held
    deepest, stiffest = -floor / (bulk_modulus * slowness), STIFFEST / slowness
    straight = STRAIGHT / slowness
    for _ in range(ROUNDS_INSIDE):
        about = at_most(at_least(mu, deepest), stiffest)
        steep, linear, root = quadratic(about, waves, strength, floor, oil)
        volume = (where_positive(linear, 2.0 * strength, root)
                  / where_positive(linear, root, steep))
        mu = free + (volume - held)
        if all_at_most(abs(mu - about), straight):
            break
    return mu, strength / volume


@formula
def fill_cavities(model, state):
    """
    Let the gas of all inner nodes answer the waves that arrived, in new_p, new_q and star.

    The last whole node of a chamber has none.
    """
    for d in range(model.start.size):
        if model.end_strength[d] > 0.0:
            first = model.start[d] + 1
            fill_nodes(state, (first, first + state.last[d] - 1), model.floor,
                       (model.slowness[d], model.bulk_modulus[d]))


@formula
def fill_nodes(state, nodes, floor, oil):
    """
    Let the gas of nodes (first, end), all with gas, answer in place, WIDTH at a time.

    What lies beyond is put back at the end: a choice at every store would be one of the slowest
    instructions of some processors.
    """
    first, end = nodes
    new_p, new_q, star = state.new_p, state.new_q, state.star
    p_beyond, q_beyond, star_beyond = load(new_p, end), load(new_q, end), load(star, end)
    for i in range(first, end, WIDTH):
        p, q, strength = load(new_p, i), load(new_q, i), load(state.strength, i)
        mu, pressure = balance_in_lanes(
            (0.5 * (p + q), strength / load(star, i)), strength, floor, oil)
        store(new_p, i, 2.0 * mu - q)
        store(new_q, i, 2.0 * mu - p)
        store(star, i, pressure)
    store(new_p, end, p_beyond)
    store(new_q, end, q_beyond)
    store(star, end, star_beyond)


@formula
def face_strength(model, state, d):
    """Return the gas's strength [Pa m/s] at a moving face, at the level before the step."""
    beyond = state.old_length[d] / model.spacing[d] - state.last[d]
    return model.end_strength[d] * (1.0 + 2.0 * max(beyond, FARTHEST_INSIDE))


@formula
def share_face_gas(model, state, d, before):
    """
    Give gas to nodes that are no longer next to the moving face, or take it from one that is now.

    before: the last whole node at the old level. old_length, last and end_star are new.
    """
    start, last = model.start[d], state.last[d]
    cell = 2.0 * model.end_strength[d]
    if last > before:
        # one pressure for all that shares the old volume
        share = face_strength(model, state, d)
        star = (share + cell * (last - before)) / state.face_held[d]
        for i in range(start + before, start + last):
            state.strength[i] = model.strength[i]
            state.star[i] = star
        state.face_held[d] = share / star
    for i in range(start + last, start + before):
        state.strength[i] = 0.0
        state.face_held[d] += cell / state.star[i]


@formula
def read_beside_faces(model, state):
    """Write p* [Pa] of the last whole node of chambers: the oil's own, where that is not lower."""
    for d in range(model.start.size):
        if model.moving[d] == 1:
            i = model.start[d] + state.last[d]
            z = 0.5 * (state.new_p[i] + state.new_q[i]) * model.slowness[d]
            own = model.bulk_modulus[d] * relative_compression(z) + model.floor
            state.star[i] = max(own, min(state.end_star[2 * d + 1], state.star[i - 1]))
