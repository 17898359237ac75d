# SPDX-License-Identifier: Apache-2.0
"""
The servo-valve's curves about null, as a valve bench draws them.

Supply and tank pressure hold at the valve's own ports; each edge is the orifice with laminar
leakage of hydra_actuator.core.orifice. Every edge's flow grows with its drop, so a port's pressure
is found by bisection.

    flow gain      control ports A and B connected: load flow over spool
    pressure gain  control ports blocked: port pressures and load pressure p_A - p_B over spool
    leakage        control ports blocked: flow from supply to tank over spool
    load flow      over load pressure at fixed spools, both ports carrying the same flow

Flows are at reference density. A and B are the stations B and I of the streamline. Neglected: the
oil's compression in the valve, the lines between valve and bench.
"""

import math
from typing import NamedTuple

from hydra_actuator.assembly import assemble
from hydra_actuator.errors import InputError
from hydra_actuator.parameters import Parameters
import numpy as np

BISECTIONS = 70
POINTS = 801
# Of the stroke: half the range about null in which the null figures are read; of the supply less
# tank pressure: the step for K_c0.
NULL_STEP, PRESSURE_STEP = 1e-6, 1e-6
WAYS = (1.0, -1.0, -1.0, 1.0)


class ValveCurves(NamedTuple):
    """
    The curves over the spool [of the stroke], all (N,): flow [m^3/s], pressures [Pa, gauge].

    flow: no-load flow; pressure_1, pressure_2: of the blocked ports, NaN where nothing reaches
    them; load_pressure: their difference; leakage: flow from supply to tank.
    """

    spool: np.ndarray
    flow: np.ndarray
    pressure_1: np.ndarray
    pressure_2: np.ndarray
    load_pressure: np.ndarray
    leakage: np.ndarray


class NullFigures(NamedTuple):
    """
    Null flow gain K_q0 [m^2/s], pressure gain K_p0 [Pa/m], K_c0 [m^3/(s Pa)] and leakage [m^3/s].

    K_q0 and K_p0 are the mean slopes of both sides of null. region: 'overlap', where no edge lets
    load flow through, or 'underlap', where all edges are open, or 'none', from low to high [of the
    stroke]; most_leakage [m^3/s] at any spool.
    """

    flow_gain: float
    pressure_gain: float
    flow_pressure: float
    leakage: float
    most_leakage: float
    region: str
    low: float
    high: float


class Bench:
    """A valve between constant pressures."""

    def __init__(self, p: Parameters) -> None:
        """Take the valve and pressures of the parameters; raises InputError without a drop."""
        self.supply, self.tank = p['supply.pressure'], p['tank.pressure']
        self.span = self.supply - self.tank
        if self.span <= 0.0:
            raise InputError('supply.pressure is not above tank.pressure: no null curves')
        valve = assemble(p)[0].valve[0]
        self.gain, self.overlap = valve['flow_gain'].copy(), valve['overlap'].copy()
        self.leak, self.stroke = float(valve['leakage']), float(valve['stroke'])

    def edge(self, k: int, spool: np.ndarray, drop: np.ndarray) -> np.ndarray:
        """Return the flow [m^3/s] of edge k (PA, PB, AT, BT) at spools [of the stroke]."""
        opening = np.maximum(0.0, WAYS[k] * spool * self.stroke - self.overlap[k])
        return (self.leak * drop
                + self.gain[k] * opening * np.copysign(np.sqrt(np.abs(drop)), drop))

    def into_port(self, port: int, spool: np.ndarray, pressure: np.ndarray) -> np.ndarray:
        """Return what flows out of the valve at port 0 (A) or 1 (B) [m^3/s] at a pressure [Pa]."""
        return (self.edge(port, spool, self.supply - pressure)
                - self.edge(2 + port, spool, pressure - self.tank))

    def blocked(self, port: int, spool: np.ndarray) -> np.ndarray:
        """Return the pressure [Pa] of a blocked port, NaN where nothing reaches it."""
        pressure = bisect(lambda p: self.into_port(port, spool, p), self.tank, self.supply,
                          np.shape(spool))
        sides = [np.maximum(0.0, WAYS[k] * spool * self.stroke - self.overlap[k]) * self.gain[k]
                 + self.leak for k in (port, 2 + port)]
        return np.where(sides[0] + sides[1] > 0.0, pressure, np.nan)

    def port_gain(self, port: int) -> float:
        """Return the flow gain [m^2/s] of one port at null, half way between the pressures."""
        spool = np.array([-NULL_STEP, NULL_STEP])
        flow = self.into_port(port, spool, np.full(2, 0.5 * (self.supply + self.tank)))
        return float(flow[1] - flow[0]) / (2.0 * NULL_STEP * self.stroke)

    def load_flow(self, spool: np.ndarray, load_pressure: np.ndarray) -> np.ndarray:
        """Return the load flow [m^3/s] at a load pressure p_A - p_B [Pa]."""
        spool, load_pressure = np.broadcast_arrays(
            np.asarray(spool, float), np.asarray(load_pressure, float))

        def surplus(mean):
            return (self.into_port(0, spool, mean + 0.5 * load_pressure)
                    + self.into_port(1, spool, mean - 0.5 * load_pressure))

        mean = bisect(surplus, self.tank - self.span, self.supply + self.span, spool.shape)
        first = self.into_port(0, spool, mean + 0.5 * load_pressure)
        second = self.into_port(1, spool, mean - 0.5 * load_pressure)
        return 0.5 * (first - second)


def bisect(falling, low: float, high: float, shape: tuple) -> np.ndarray:
    """Return where a falling function of pressures is 0, the middle where it is flat there."""
    edges = []
    for beyond in (lambda v: v > 0.0, lambda v: v >= 0.0):
        a, b = np.full(shape, float(low)), np.full(shape, float(high))
        for _ in range(BISECTIONS):
            middle = 0.5 * (a + b)
            right = beyond(falling(middle))
            a, b = np.where(right, middle, a), np.where(right, b, middle)
        edges.append(0.5 * (a + b))
    return 0.5 * (edges[0] + edges[1])


def valve_curves(bench: Bench, reach: float = 1.0, points: int = POINTS) -> ValveCurves:
    """Return the curves for spools from -reach to reach [of the stroke]."""
    spool = np.linspace(-reach, reach, points)
    p_1, p_2 = bench.blocked(0, spool), bench.blocked(1, spool)
    return ValveCurves(
        spool, bench.load_flow(spool, 0.0), p_1, p_2, p_1 - p_2, _leakage(bench, spool, p_1, p_2))


def _leakage(bench: Bench, spool: np.ndarray, p_1: np.ndarray, p_2: np.ndarray) -> np.ndarray:
    """Return the flow from supply [m^3/s] with both ports blocked."""
    return sum(np.nan_to_num(bench.edge(k, spool, bench.supply - p))
               for k, p in ((0, p_1), (1, p_2)))


def null_figures(bench: Bench) -> NullFigures:
    """Return the figures of the valve at null."""
    h = np.array([-NULL_STEP, 0.0, NULL_STEP])
    curves = ValveCurves(h, bench.load_flow(h, 0.0), bench.blocked(0, h), bench.blocked(1, h),
                         np.zeros(3), np.zeros(3))
    travel = 2.0 * NULL_STEP * bench.stroke
    flow_gain = float(curves.flow[2] - curves.flow[0]) / travel
    step = PRESSURE_STEP * bench.span
    through = bench.load_flow(np.zeros(2), np.array([-step, step]))
    flow_pressure = float(through[0] - through[1]) / (2.0 * step)
    load = curves.pressure_1 - curves.pressure_2
    closed = bool(np.isnan(load[1]))
    pressure_gain = math.inf if closed else float(load[2] - load[0]) / travel
    if closed and flow_gain == 0.0:
        pressure_gain = 0.0
    everywhere = valve_curves(bench, points=POINTS)
    at_null = float(_leakage(bench, h, curves.pressure_1, curves.pressure_2)[1])
    return NullFigures(flow_gain, pressure_gain, flow_pressure, at_null,
                       float(max(everywhere.leakage.max(), at_null)), *_region(bench))


def _region(bench: Bench) -> tuple[str, float, float]:
    """Return kind and bounds [of the stroke] of the region about null."""
    lap = bench.overlap / bench.stroke
    direct, reverse = max(lap[0], lap[3]), max(lap[1], lap[2])
    if direct + reverse > 0.0:
        return 'overlap', -float(reverse), float(direct)
    low, high = float(max(lap[0], lap[3])), float(-max(lap[1], lap[2]))
    return ('underlap', low, high) if high > low else ('none', low, low)
