# SPDX-License-Identifier: Apache-2.0
"""
Free gas and vapour: a cavity at every node and at every end (discrete gas cavity).

    V p* = alpha0 (ambient - p_v) A dx        p* = absolute pressure - p_v, gas at constant heat
    inside a line   V_new - V_old = (A dx/c) (2 mu - P - Q)
    at an end       V_new - V_old = dt A (v_boundary - v_line),  v_line = W - mu, half a cell

P, Q, W are the waves that arrive; what leaves a node is 2 mu - Q and 2 mu - P. It is A dx/c, not
A dt, which on an interpolated grid would be too strong by one over the Courant number. In
velocity units both read

    mu = free - held + strength / p*

where free is (P + Q)/2 or W - v, held stands for the old volume and strength for the gas. Sources:
Wylie, "Simulation of vaporous and gaseous cavitation", J. Fluids Eng. 106, 1984, 307-311.
Neglected: growth of bubbles, solution and release of gas, vapour's own mass.
"""

import math

from hydra_actuator.core.compilation import formula
from hydra_actuator.core.fluid import compression_series

# Rounds of `gas_balance` inside a line, where two leave 3e-9 of p* at a jump of 1 m/s in one step
# and 2e-13 at 0.1 m/s, and at ends, where the laws of the boundaries hold to 1e-10.
ROUNDS_INSIDE, ROUNDS_AT_END = 2, 3


@formula
def gas_balance(waves, strength, floor, oil, rounds):
    """
    Return (mu [m/s], p* [Pa]) where oil and gas of a node agree.

    waves: (free, held) [m/s], strength [Pa m/s] as above; floor: ambient - p_v [Pa], which makes
    p* = p + floor; oil: (slowness 1/c [s/m], bulk modulus [Pa]). The unknown is the new volume
    strength/p*: each round takes the oil's pressure as linear in it, which leaves a quadratic
    with one positive root. The volume balances to rounding, whatever the rounds.
    """
    free, held = waves
    slowness, bulk_modulus = oil
    mu = free
    volume = held
    for _ in range(rounds):
        compression = compression_series(mu * slowness)
        steepness = bulk_modulus * slowness * (1.0 + compression)
        linear = bulk_modulus * compression + floor - steepness * (mu - free + held)
        root = abs(linear) + math.sqrt(linear * linear + 4.0 * steepness * strength)
        above = linear >= 0.0
        volume = ((2.0 * strength if above else root)
                  / (root + 1e-300 if above else 2.0 * steepness))
        mu = free + (volume - held)
    return mu, strength / (volume + 1e-300)


@formula
def fill_cavities(model, state):
    """
    Let the gas of all inner nodes answer the waves that arrived, in new_p, new_q and star.

    Where strength is 0 (ends, spare nodes) the waves stay as they are.
    """
    new_p, new_q, star, strength = state.new_p, state.new_q, state.star, model.strength
    slowness, bulk_modulus = model.node_slowness, model.node_bulk_modulus
    for i in range(new_p.size):
        p, q = new_p[i], new_q[i]
        mu, pressure = gas_balance(
            (0.5 * (p + q), strength[i] / star[i]), strength[i], model.floor,
            (slowness[i], bulk_modulus[i]), ROUNDS_INSIDE)
        empty = strength[i] == 0.0
        new_p[i] = p if empty else 2.0 * mu - q
        new_q[i] = q if empty else 2.0 * mu - p
        star[i] = star[i] if empty else pressure
