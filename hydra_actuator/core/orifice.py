# SPDX-License-Identifier: Apache-2.0
"""
An orifice between two ends of lines (Jankovic et al., equation 8), solved once for all users.

        end 1  --W1, Z1-->  )(  <--W2, Z2--  end 2        q > 0 from end 1 to end 2

    p1 - p2 = rho0 q|q| / (2 K^2), K = C_d x area; laminar leakage in parallel:
    q = G dp + K' sqrt(dp), K' = K sqrt(2/rho0); rho A u equal on both sides.
Neglected: the oil inside the orifice, the change of C_d with Reynolds number and cavitation.
"""

import math

from hydra_actuator.core.compilation import formula
from hydra_actuator.core.end import end_relation
from hydra_actuator.core.lanes import multiply_add

# Largest last step of Newton, relative. A step dv leaves dv^2/2c, and 4e-7 dv of the short series
# at 35 MPa: with this, law and mass at a junction hold to 1e-10. Below the second, in m/s, is the
# rounding of oil at rest.
STEP_TOLERANCE = 3e-5
NO_STEP = 1e-10
MOST_PASSES = 12


@formula
def settled(velocity, change):
    """Return whether a Newton step `change` to an end's velocity [m/s] was the last needed."""
    return abs(change) <= STEP_TOLERANCE * abs(velocity) + NO_STEP


@formula
def orifice_flow(difference, impedance, coefficient, leakage):
    """
    Return the flow [m^3/s] that a wave difference drives through an orifice between two ends.

    difference D [Pa] = pressure difference at zero flow, impedance Z [Pa s/m^3] = sum of both,
    coefficient K' [m^3/(s sqrt(Pa))], leakage G [m^3/(s Pa)]. The root is a quotient of positive
    terms: odd in D, finite slope at zero, no regularisation.
    """
    size = abs(difference)
    turbulent = impedance * coefficient
    root = 2.0 * size / (
        turbulent
        + math.sqrt(multiply_add(
            turbulent, turbulent, 4.0 * (1.0 + impedance * leakage) * size))
        + 1e-300)
    flow = (leakage * root + coefficient) * root
    return math.copysign(flow, difference)


@formula
def orifice_drop(flow, coefficient, leakage):
    """
    Return (pressure drop [Pa], its slope d dp/dq [Pa s/m^3]) at a flow [m^3/s].

    The inverse of q = G dp + K' sqrt(dp); the slope is finite at zero flow, 1/G or 0.
    """
    size = abs(flow)
    root = 2.0 * size / (
        coefficient + math.sqrt(coefficient * coefficient + 4.0 * leakage * size) + 1e-300)
    slope = 2.0 * root / (2.0 * leakage * root + coefficient + 1e-300)
    if root == 0.0 and coefficient == 0.0:
        slope = 1.0 / leakage
    return math.copysign(root * root, flow), slope


@formula
def solve_orifice(end_1, end_2, coefficient, leakage):
    """
    Return the outflow velocities [m/s] of two Ends at which law and mass balance hold.

    Each pass replaces both ends by pressure and impedance and solves the orifice exactly.
    """
    v_1, v_2 = end_1.velocity, end_2.velocity
    if coefficient == 0.0 and leakage == 0.0:
        return 0.0, 0.0
    for _ in range(MOST_PASSES):
        p_1, q_1, z_1, flatness_1 = end_relation(end_1, v_1)
        p_2, q_2, z_2, flatness_2 = end_relation(end_2, v_2)
        flow = orifice_flow(
            multiply_add(z_1, q_1, p_1) - multiply_add(z_2, q_2, p_2), z_1 + z_2,
            coefficient, leakage)
        change_1 = (flow - q_1) * flatness_1
        change_2 = -(flow + q_2) * flatness_2
        v_1 += change_1
        v_2 += change_2
        if settled(v_1, change_1) and settled(v_2, change_2):
            break
    return v_1, v_2
