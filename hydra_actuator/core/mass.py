# SPDX-License-Identifier: Apache-2.0
"""
The balance of the oil's mass while it runs: what came in, what left, what is there.

    residual = in - out - (mass now - mass when the balance began)

Flows through the outer ends are summed at every step (trapezoid in time); the oil is weighed once
in WEIGH_EVERY periods. Nothing in the method enforces the balance, so the residual is its error,
and that of the weighing: sums over nodes are of fourth order, a face's last part of a cell third.
Gas of volume V in a cell keeps oil out of it, the integral of rho dV with p = K/V - floor, in
closed form from V = 0 at a pressure p* of REST_STAR on; see hydra_actuator.core.cavity.
"""

import math

from hydra_actuator.core.cavity import face_strength
from hydra_actuator.core.compilation import formula
from hydra_actuator.core.fluid import relative_compression
from hydra_actuator.core.records import FLOW, PRESSURE, PUMP

WEIGH_EVERY = 50
REST_STAR = 10e6        # [Pa] absolute less vapour pressure


@formula
def compression_at(model, state, d, i):
    """Return rho/rho0 - 1 of the oil at a whole node of a domain."""
    if len(model.extras) > 0 and model.end_strength[d] > 0.0:
        return (state.star[i] - model.floor) / model.bulk_modulus[d]
    return relative_compression(0.5 * (state.wave_p[i] + state.wave_q[i]) * model.slowness[d])


@formula
def inflow(model, state):
    """Return net inflow [kg/s] at the outer ends, and half the sum of its sizes."""
    net, through = 0.0, 0.0
    for j in range(model.junctions.size):
        junction = model.junctions[j]
        kind = junction.kind
        if kind == PUMP or kind == PRESSURE or kind == FLOW:
            end = junction.end[0]
            d = end // 2
            i = model.start[d] + (state.last[d] if end % 2 == 1 else 0)
            flow = (1.0 + compression_at(model, state, d, i)) * reference_density(model, d) * (
                model.area[d] * state.end_velocity[end])
            net -= flow
            through += 0.5 * abs(flow)
    return net, through


@formula
def reference_density(model, d):
    """Return rho0 [kg/m^3] = chi/c^2."""
    return model.bulk_modulus[d] * model.slowness[d] * model.slowness[d]


@formula
def begin_balance(model, state):
    """Begin the balance with the oil that is there, if it has not begun."""
    mass = state.mass[0]
    if mass.began == 0:
        mass.began = 1
        mass.net, mass.through = inflow(model, state)
        mass.entered = mass.passed = mass.residual = 0.0
        mass.at_first = oil_mass(model, state)


@formula
def add_flows(model, state):
    """Add what passed the outer ends in the step that ends now."""
    mass = state.mass[0]
    net, through = inflow(model, state)
    half = 0.5 * model.step_time
    mass.entered += half * (mass.net + net)
    mass.passed += half * (mass.through + through)
    mass.net, mass.through = net, through


@formula
def strike_balance(model, state):
    """Weigh the oil and keep the residual [kg]."""
    mass = state.mass[0]
    mass.residual = mass.entered - (oil_mass(model, state) - mass.at_first)


@formula
def oil_mass(model, state):
    """Return the mass of the oil [kg] in all domains."""
    total = 0.0
    for d in range(model.start.size):
        whole = model.area[d] * (state.length[d] + compression_along(model, state, d))
        if len(model.extras) > 0 and model.end_strength[d] > 0.0:
            whole -= displaced_volume(model, state, d)
        total += reference_density(model, d) * whole
    return total


@formula
def compression_along(model, state, d):
    """Return the integral of rho/rho0 - 1 [m] over a domain, up to its face if that moves."""
    first, cells = model.start[d], state.last[d]
    last = first + cells
    total = 0.0
    for i in range(first, last + 1):
        total += compression_at(model, state, d, i)
    here, there = compression_at(model, state, d, last), compression_at(model, state, d, first)
    total -= 0.5 * (here + there)
    rise, bend = 0.0, 0.0
    if cells >= 1:
        rise = here - compression_at(model, state, d, last - 1)
    if cells >= 2:
        # what the trapezoid lacks at both ends, in differences of first and second order (Gregory)
        bend = rise - (compression_at(model, state, d, last - 1)
                       - compression_at(model, state, d, last - 2))
        next_to = compression_at(model, state, d, first + 1)
        fall = there - next_to
        sag = fall - (next_to - compression_at(model, state, d, first + 2))
        total -= (rise + fall) * (1.0 / 12.0) + (bend + sag) * (1.0 / 24.0)
    part = 0.0
    if model.moving[d] == 1:
        part = state.length[d] / model.spacing[d] - cells
    total += part * (here + part * (0.5 * rise + (0.25 + part * (1.0 / 6.0)) * bend))
    return model.spacing[d] * total


@formula
def displaced_volume(model, state, d):
    """Return the oil at reference density [m^3] whose place the gas of a domain takes."""
    first, last = model.start[d], model.start[d] + state.last[d]
    total = displaced_per_strength(model, d, state.end_star[2 * d])
    if model.moving[d] == 1:
        strength = face_strength(model, state, d)
        total += strength / model.end_strength[d] * displaced_per_strength(
            model, d, strength / state.face_held[d])
    else:
        total += displaced_per_strength(model, d, state.end_star[2 * d + 1])
    for i in range(first + 1, last):
        total += 2.0 * displaced_per_strength(model, d, state.star[i])
    return model.end_strength[d] * model.step_time * model.area[d] * total


@formula
def displaced_per_strength(model, d, star):
    """Return displaced oil over held room [1/Pa] of gas at p* [Pa]."""
    work = (math.log(REST_STAR / star) + model.floor * (1.0 / REST_STAR - 1.0 / star)
            + (REST_STAR - model.floor) / REST_STAR)
    return 1.0 / star + work / model.bulk_modulus[d]
