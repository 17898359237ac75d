# SPDX-License-Identifier: Apache-2.0
"""
The four edges of the valve, linear about an operating point.

An edge exactly at its kink (opening 0) has half the slope of its open side: what a small sine
that opens it half the time has as its first harmonic.
"""

import math
from typing import NamedTuple

from hydra_actuator.core.orifice import orifice_drop
from hydra_actuator.response.operating_point import OperatingPoint
from hydra_actuator.steady_flow import AT_B, AT_I, conductances
import numpy as np

WAYS = (1.0, -1.0, -1.0, 1.0)
# Of the stroke: what rounding leaves of a spool at the kink of an edge.
AT_KINK = 1e-9
# Of a line's impedance: what rounding leaves of an open edge without flow.
NO_RESISTANCE = 1e-9


class ValveSlopes(NamedTuple):
    """
    Slopes of the edges PA, PB, AT, BT, each (4,).

    conducts: whether pressure moves oil through it; resistance: d drop/d flow [Pa s/m^3] where it
    conducts; gain: d flow/d spool [m^2/s] at constant pressures; overlapped: whether it is
    closed and stays so for a small motion.
    """

    conducts: np.ndarray
    resistance: np.ndarray
    gain: np.ndarray
    overlapped: np.ndarray

    @property
    def conductance(self) -> np.ndarray:
        """Slope of flow over pressure drop [m^3/(s Pa)]; infinite without a drop."""
        with np.errstate(divide='ignore'):
            return np.where(self.conducts, 1.0 / self.resistance, 0.0)


def edge_drops(point: OperatingPoint) -> np.ndarray:
    """Return the pressure drops [Pa] over PA, PB, AT, BT."""
    at_b, at_i = point.network[AT_B], point.network[AT_I]
    return np.array([point.at_a - at_b, point.at_a - at_i, at_b - point.at_j, at_i - point.at_j])


def valve_slopes(point: OperatingPoint) -> ValveSlopes:
    """Return the slopes of the edges at an operating point, all spools moved together."""
    model = point.model
    valve, stroke = model.valve[0], float(model.valve[0]['stroke'])
    spools = (point.spools[0], point.spools[1], point.spools[0], point.spools[1])
    edges, drops = conductances(model, point.spools), edge_drops(point)
    conducts, resistance, gain, overlapped = (np.zeros(4) for _ in range(4))
    for k, (coefficient, leakage) in enumerate(edges):
        conducts[k] = coefficient > 0.0 or leakage > 0.0
        if conducts[k]:
            slope = orifice_drop.py_func(point.network[k], coefficient, leakage)[1]
            resistance[k] = slope if slope > NO_RESISTANCE * model.impedance[0] else 0.0
        opening = WAYS[k] * spools[k] - valve['overlap'][k]
        share = 0.5 * (1.0 + np.sign(opening)) if abs(opening) > AT_KINK * stroke else 0.5
        overlapped[k] = share == 0.0 or valve['flow_gain'][k] == 0.0
        drive = math.copysign(math.sqrt(abs(drops[k])), drops[k])
        gain[k] = share * WAYS[k] * valve['flow_gain'][k] * drive
    return ValveSlopes(conducts > 0.0, resistance, gain, overlapped > 0.0)
