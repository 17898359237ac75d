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
# Far beyond any oil: keeps what has already left the method finite until that is noticed.
LARGEST = 30.0


@formula
def compression_series(z):
    """
    Return exp(z) - 1 by eight terms, summed in pairs to shorten the chain of operations.

    The first neglected term is 2e-18 of the result at |z| = 0.03, 3e-14 at 0.1 (155 MPa).
    """
    square = z * z
    tail = (1.0 / 5040.0) + z * (1.0 / 40320.0)
    tail = ((1.0 / 120.0) + z * (1.0 / 720.0)) + square * tail
    tail = ((1.0 / 6.0) + z * (1.0 / 24.0)) + square * tail
    return z * ((1.0 + 0.5 * z) + square * tail)


@formula
def relative_compression(z):
    """
    Return exp(z) - 1, with z = mu / c and the result p / chi, both dimensionless.

    A series to |z| = 0.03 (44 MPa in mineral oil), where it is good to rounding.
    """
    if abs(z) > SERIES_LIMIT:
        return math.expm1(LARGEST if z > LARGEST else z)
    return compression_series(z)


@formula
def pressure_of(mu, wave_speed, bulk_modulus):
    """Return the gauge pressure [Pa] at the Riemann variable mu [m/s]."""
    return bulk_modulus * relative_compression(mu / wave_speed)


@formula
def riemann_variable(pressure, wave_speed, bulk_modulus):
    """Return mu [m/s] at a gauge pressure [Pa]."""
    return wave_speed * math.log1p(pressure / bulk_modulus)
