# SPDX-License-Identifier: Apache-2.0
"""
The end of a line as a boundary sees it: a wave that arrives and an impedance, nothing of a mesh.

With gas at the end the boundary's outflow velocity differs from the oil's by the growth of the
cavity; the relation of pressure and flow stays single-valued and falling.
"""

from typing import NamedTuple

from hydra_actuator.core.cavity import gas_balance, ROUNDS_AT_END
from hydra_actuator.core.compilation import formula
from hydra_actuator.core.fluid import relative_compression

# Of |v|/c and p/chi: where a series of three terms is still good to 2e-3; where the quotients
# 1/(1 - v/c) and 1/(1 + p/chi) come too near to their poles.
SERIES_REACH, MOST_STEERED = 0.2, 0.9


class End(NamedTuple):
    """
    What a boundary knows of a line's end: an arriving wave and constants of the oil and bore.

    wave W = mu + v_line [m/s] with v_line the oil's outflow velocity, velocity: trial v of the
    boundary [m/s], slowness 1/c [s/m], bulk_modulus [Pa], area [m^2], impedance rho0 c/A
    [Pa s/m^3], inverse_area [1/m^2]; gas at the end (see hydra_actuator.core.cavity): strength
    [Pa m/s], held [m/s], floor [Pa], strength 0 for none.
    """

    wave: float
    velocity: float
    slowness: float
    bulk_modulus: float
    area: float
    impedance: float
    inverse_area: float
    strength: float = 0.0
    held: float = 0.0
    floor: float = 0.0


@formula
def state_at(end, velocity):
    """Return (mu [m/s], p* [Pa], 0 without gas) of an end at its outflow velocity [m/s]."""
    if end.strength > 0.0:
        return gas_balance((end.wave - velocity, end.held), end.strength, end.floor,
                           (end.slowness, end.bulk_modulus), ROUNDS_AT_END)
    return end.wave - velocity, 0.0


@formula
def end_relation(end, velocity):
    """
    Return (pressure, flow, impedance, flatness) of an end at a trial outflow velocity [m/s].

    p = chi (exp((W - v)/c) - 1) [Pa], flow at reference density q = v A rho/rho0 [m^3/s].
    impedance = -dp/dq [Pa s/m^3] and flatness = dv/dq [1/m^2] steer the iteration, whose fixed
    point does not depend on them: short series, good to 1e-6 at |v|/c and p/chi of 0.03, and
    beyond SERIES_REACH the quotients they stand for, which stay positive and finite.
    """
    softness = 1.0
    if end.strength > 0.0:
        _, star = state_at(end, velocity)
        compression = (star - end.floor) / end.bulk_modulus
        steepness = end.bulk_modulus * end.slowness * (1.0 + compression)
        softness = 1.0 / (1.0 + steepness * end.strength / (star * star))
    else:
        compression = relative_compression((end.wave - velocity) * end.slowness)
    mach = velocity * end.slowness
    growth, lightness = steering_series(mach, compression)
    if abs(mach) > SERIES_REACH:
        growth = 1.0 / (1.0 - min(max(mach, -MOST_STEERED), MOST_STEERED))
    if abs(compression) > SERIES_REACH:
        lightness = 1.0 / (1.0 + max(compression, -MOST_STEERED))
    return relation_of(end, velocity, compression, (growth, lightness, softness))


@formula
def steering_series(mach, compression):
    """Return short series of 1/(1 - v/c) and 1/(1 + p/chi)."""
    growth = 1.0 + mach * (1.0 + mach * (1.0 + mach))
    lightness = 1.0 - compression * (1.0 - compression * (1.0 - compression))
    return growth, lightness


@formula
def relation_of(end, velocity, compression, steering):
    """Return what `end_relation` does, from p/chi and (1/(1 - v/c), 1/(1 + p/chi), softness)."""
    growth, lightness, softness = steering
    flow = velocity * (end.area + end.area * compression)
    flatness = growth * lightness * end.inverse_area
    return end.bulk_modulus * compression, flow, end.impedance * growth * softness, flatness


@formula
def velocity_at(end, mu, pressure):
    """Return the outflow velocity [m/s] of an end held at mu [m/s] and its gauge pressure [Pa]."""
    if end.strength > 0.0:
        return end.wave - mu - end.held + end.strength / (pressure + end.floor)
    return end.wave - mu
