# SPDX-License-Identifier: Apache-2.0
"""
The oil: a barotropic liquid of constant bulk modulus (Jankovic et al., equation 6).

    rho = rho0 (1 + p / chi)      c^2 = chi / rho0      mu = c ln(1 + p / chi)

p is gauge pressure [Pa], chi the bulk modulus [Pa] at gauge zero (with the wall's elasticity in
it, so each domain has its own), c the wave speed [m/s] and mu the Riemann variable [m/s].
Neglected: temperature, dissolved gas, viscosity's dependence on pressure.
"""

import math
from typing import NamedTuple

from hydra_actuator.core.compilation import formula

SERIES_LIMIT = 0.03


@formula
def relative_compression(z):
    """
    Return exp(z) - 1, with z = mu / c and the result p / chi, both dimensionless.

    Below 0.03 (44 MPa in mineral oil) an eight-term series, summed in pairs to shorten the chain
    of operations: its first neglected term is 2e-18 of the result, below rounding.
    """
    if abs(z) > SERIES_LIMIT:
        return math.expm1(z)
    square = z * z
    tail = (1.0 / 5040.0) + z * (1.0 / 40320.0)
    tail = ((1.0 / 120.0) + z * (1.0 / 720.0)) + square * tail
    tail = ((1.0 / 6.0) + z * (1.0 / 24.0)) + square * tail
    return z * ((1.0 + 0.5 * z) + square * tail)


@formula
def pressure_of(mu, wave_speed, bulk_modulus):
    """Return the gauge pressure [Pa] at the Riemann variable mu [m/s]."""
    return bulk_modulus * relative_compression(mu / wave_speed)


@formula
def riemann_variable(pressure, wave_speed, bulk_modulus):
    """Return mu [m/s] at a gauge pressure [Pa]."""
    return wave_speed * math.log1p(pressure / bulk_modulus)


class End(NamedTuple):
    """
    What a boundary knows of a line's end: an arriving wave and constants of the oil and bore.

    wave W = mu + v [m/s] with v the outflow velocity, velocity: trial v [m/s], slowness 1/c
    [s/m], bulk_modulus [Pa], area [m^2], impedance rho0 c/A [Pa s/m^3], inverse_area [1/m^2].
    """

    wave: float
    velocity: float
    slowness: float
    bulk_modulus: float
    area: float
    impedance: float
    inverse_area: float


@formula
def end_relation(end, velocity):
    """
    Return (pressure, flow, impedance, flatness) of an end at a trial outflow velocity [m/s].

    p = chi (exp((W - v)/c) - 1) [Pa], flow at reference density q = v A rho/rho0 [m^3/s].
    impedance = -dp/dq [Pa s/m^3] and flatness = dv/dq [1/m^2] are short series, good to 1e-6:
    they steer the iteration, whose fixed point does not depend on them.
    """
    compression = relative_compression((end.wave - velocity) * end.slowness)
    mach = velocity * end.slowness
    growth = 1.0 + mach * (1.0 + mach * (1.0 + mach))
    lightness = 1.0 - compression * (1.0 - compression * (1.0 - compression))
    flow = velocity * (end.area + end.area * compression)
    flatness = growth * lightness * end.inverse_area
    return end.bulk_modulus * compression, flow, end.impedance * growth, flatness
