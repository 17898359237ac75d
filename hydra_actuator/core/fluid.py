# SPDX-License-Identifier: Apache-2.0
"""
The oil: a barotropic liquid of constant bulk modulus (Jankovic et al., equation 6).

    rho = rho0 (1 + p / chi)      c^2 = chi / rho0      mu = c ln(1 + p / chi)

p is gauge pressure [Pa], chi the bulk modulus [Pa] at gauge zero (with the wall's elasticity in
it, so each domain has its own), c the wave speed [m/s] and mu the Riemann variable [m/s].
Neglected: temperature, dissolved gas, viscosity's dependence on pressure.
"""

import math

from hydra_actuator.core.compilation import formula

SERIES_LIMIT = 0.03


@formula
def relative_compression(z):
    """
    Return exp(z) - 1, with z = mu / c and the result p / chi, both dimensionless.

    Below 0.03 (44 MPa in mineral oil) an eight-term series: its first neglected term is
    5e-20, 2e-18 of the result, below rounding.
    """
    if abs(z) > SERIES_LIMIT:
        return math.expm1(z)
    tail = 1.0 + z * (1.0 / 7.0) * (1.0 + z * 0.125)
    tail = 1.0 + z * 0.2 * (1.0 + z * (1.0 / 6.0) * tail)
    return z * (1.0 + z * 0.5 * (1.0 + z * (1.0 / 3.0) * (1.0 + z * 0.25 * tail)))


@formula
def pressure_of(mu, wave_speed, bulk_modulus):
    """Return the gauge pressure [Pa] at the Riemann variable mu [m/s]."""
    return bulk_modulus * relative_compression(mu / wave_speed)


@formula
def riemann_variable(pressure, wave_speed, bulk_modulus):
    """Return mu [m/s] at a gauge pressure [Pa]."""
    return wave_speed * math.log1p(pressure / bulk_modulus)


@formula
def end_relation(wave, outflow_velocity, wave_speed, bulk_modulus, area):
    """
    Return (pressure, flow, impedance, slope) of a line's end at a trial outflow velocity.

    The end knows its arriving wave W = mu + v [m/s] (v = outflow velocity), so
    p = chi (exp((W - v)/c) - 1) [Pa] and the flow at reference density q = v A rho/rho0 [m^3/s].
    impedance = -dp/dq [Pa s/m^3], slope = dq/dv [m^2].
    """
    compression = relative_compression((wave - outflow_velocity) / wave_speed)
    relative_density = 1.0 + compression
    ratio = 1.0 - outflow_velocity / wave_speed
    flow = outflow_velocity * area * relative_density
    slope = area * relative_density * ratio
    impedance = bulk_modulus / (wave_speed * area * ratio)
    return bulk_modulus * compression, flow, impedance, slope
