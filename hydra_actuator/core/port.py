# SPDX-License-Identifier: Apache-2.0
"""
A port of the cylinder: the sudden change of area between line and chamber.

Jankovic et al., equation 12: dp = rho0 eta0/2 (u_M|u_M| + u_N|u_N|), which with A u equal on both
sides is an orifice of K = [eta0 (1/A_M^2 + 1/A_N^2)]^(-1/2). eta0 = 0 is a port without loss.
"""

import math

LOSSLESS_COEFFICIENT = 1e3


def port_coefficient(loss: float, area_line: float, area_chamber: float) -> float:
    """
    Return K [m^2] of a port with loss coefficient eta0 [-] between two areas [m^2].

    Without loss a K of 1000 m^2 stands for infinity: its drop is below 1e-12 Pa at any flow.
    """
    if loss == 0.0:
        return LOSSLESS_COEFFICIENT
    return 1.0 / math.sqrt(loss * (1.0 / area_line ** 2 + 1.0 / area_chamber ** 2))
