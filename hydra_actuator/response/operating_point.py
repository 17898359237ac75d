# SPDX-License-Identifier: Apache-2.0
"""
The steady state of the plant about which it is linearised.

- With a load spring and no position given: the piston rests where all forces balance.
- Else it stands at the given position (or `initial.position`) and moves as fast as valve and load
  let it; the position is held fixed meanwhile (frozen), the spring's force there is part of the
  load. Chambers that nothing but the piston closes are trapped: it rests, and `initial.` gives
  their pressures, the harder pushing one lowered until it holds the load.

Seal friction is left out: the piston slides without it. Neglected: that chambers grow.
"""

import math
from typing import NamedTuple

from hydra_actuator.assembly import assemble
from hydra_actuator.core.model import Model
from hydra_actuator.core.orifice import orifice_drop
from hydra_actuator.equilibrium import balanced, Equilibrium, find_equilibrium
from hydra_actuator.errors import Failure, InputError
from hydra_actuator.parameters import Parameters
from hydra_actuator.steady_flow import (
    AT,
    AT_B,
    AT_I,
    beyond_line,
    BT,
    COARSE,
    conductances,
    LINE_1,
    LINE_2,
    PA,
    PAST,
    PB,
    PORT_1,
    PORT_2,
    RETURN_LINE,
    SUPPLY_LINE,
)
import numpy as np

SPEED, PUMP = 7, 8
# Below this the piston rests [m/s]: what the search leaves.
AT_REST = 1e-9
# Largest relative defect of a steady motion.
SOLVED = 1e-8
# Of the stroke: where the piston leans against its stop.
AT_STOP = 1e-9


class OperatingPoint(NamedTuple):
    """
    The steady state; pressures are gauge.

    spools [m], load [N], position [m], velocity [m/s], pump [Pa], limited: the pump gives all it
    can, face_1, face_2 [Pa], network: flows PA, PB, AT, BT, past the piston [m^3/s at reference
    density], pressures at B and I [Pa]; at_a, at_j [Pa]; notes: what was left out, for people.
    """

    parameters: Parameters
    model: Model
    spools: tuple[float, float]
    load: float
    position: float
    velocity: float
    pump: float
    limited: bool
    face_1: float
    face_2: float
    network: np.ndarray
    at_a: float
    at_j: float
    notes: tuple[str, ...]

    @property
    def flow_1(self) -> float:
        """Flow from the valve into line_1 [m^3/s]."""
        return float(self.network[PA] - self.network[AT])

    @property
    def flow_2(self) -> float:
        """Flow from line_2 into the valve [m^3/s]."""
        return float(self.network[BT] - self.network[PB])

    @property
    def equilibrium(self) -> Equilibrium:
        """The same as the start of a run, for a piston at rest."""
        return Equilibrium(self.pump, self.face_1, self.face_2, self.network, self.position, 0.0)


def find_operating_point(p: Parameters, spool: float | tuple[float, float] = 0.0,
                         load: float = 0.0, position: float | None = None) -> OperatingPoint:
    """
    Return the steady state at a spool position, load [N] and piston position [m].

    spool: normalised -1..1, one for all spools or a pair. Raises InputError where the plant has
    no such state: piston at a stop, cavitation, oil that leaks away under load.
    """
    pair = (spool, spool) if np.ndim(spool) == 0 else tuple(spool)
    spools = tuple(float(x) * p['valve.stroke'] for x in pair)
    limit = 0.5 * p['cylinder.stroke']
    if position is not None and not abs(position) <= limit:
        raise InputError(f'position {position:g} m is beyond the stops at +-{limit:g} m')
    place = p['initial.position'] if position is None else position
    p = p.replace({'initial.position': place})
    model, _ = assemble(p)
    edges = conductances(model, spools)
    speed = 0.0
    if position is None and p['cylinder.stiffness'] > 0.0:
        found = find_equilibrium(p, model, spools, load)
    else:
        total = load + p['cylinder.stiffness'] * place
        closed = [sum(edges[k]) == 0.0 for k in range(4)]
        if closed[PA] and closed[AT] and closed[PB] and closed[BT]:
            found = _trapped(p, place, total)
        else:
            found, speed = _in_motion(p, model, edges, total)
    if position is None and abs(found.position) >= limit * (1.0 - AT_STOP):
        raise InputError(
            f'spool {pair[0]:g}, load {load:g} N: the piston leans against its stop at '
            f'{found.position:g} m; give a position')
    p = p.replace({'initial.position': found.position})
    return _complete(p, spools, load, found, speed)


def _trapped(p: Parameters, position: float, load: float) -> Equilibrium:
    """Return the rest of a piston between two closed chambers under a load [N], spring's in it."""
    face_1, face_2 = balanced(p, load)
    if p['cylinder.leakage'] > 0.0:
        face_1 = face_2 = 0.5 * (p['initial.pressure_1'] + p['initial.pressure_2'])
        push = (p['cylinder.area_1'] - p['cylinder.area_2']) * face_1 - load
        if abs(push) > 1e-9 * (p['cylinder.area_1'] * abs(face_1) + abs(load)):
            raise InputError(
                'the valve is closed and oil leaks past the piston under load: nothing is steady; '
                'open the valve, or leave the position to the spring')
    network = np.zeros(7)
    network[AT_B], network[AT_I] = face_1, face_2
    return Equilibrium(p['supply.pressure'], face_1, face_2, network, position, 0.0)


def _in_motion(p: Parameters, model: Model, edges: list,
               load: float) -> tuple[Equilibrium, float]:
    """Return the steady motion under a load [N], the spring's force in it, and its speed [m/s]."""
    supply, most = p['supply.pressure'], p['supply.max_flow']
    x = _solve_motion(p, model, edges, load, False)
    if 0.0 < most < x[PA] + x[PB]:
        x = _solve_motion(p, model, edges, load, True)
        supply = float(x[PUMP])
    face_1, face_2 = _faces(model, x)
    speed = float(x[SPEED]) if abs(x[SPEED]) > AT_REST else 0.0
    return Equilibrium(supply, face_1, face_2, x[:7].copy(), p['initial.position'], 0.0), speed


def _solve_motion(p: Parameters, model: Model, edges: list, load: float,
                  limited: bool) -> np.ndarray:
    """Return five flows [m^3/s], pressures at B and I [Pa], speed [m/s] and pump pressure [Pa]."""
    from scipy.optimize import root

    supply, tank = p['supply.pressure'], p['tank.pressure']
    span = max(abs(supply - tank), 1.0)
    areas = float(model.area[2]), float(model.area[3])
    flow = max(gain * math.sqrt(0.5 * span) + leak * span for gain, leak in edges)
    if limited:
        flow = min(flow, p['supply.max_flow'])
    scale = np.array([flow] * 5 + [span] * 2 + [flow / max(areas), span])

    def defects(z: np.ndarray) -> np.ndarray:
        x = z * scale
        pump = x[PUMP] if limited else supply
        at_a = beyond_line(model, SUPPLY_LINE, pump, x[PA] + x[PB])
        at_j = beyond_line(model, RETURN_LINE, tank, x[AT] + x[BT], -COARSE)
        drops = (at_a - x[AT_B], at_a - x[AT_I], x[AT_B] - at_j, x[AT_I] - at_j)
        face_1, face_2 = _faces(model, x)
        out = np.empty(9)
        for k, (gain, leak) in enumerate(edges):
            open_ = gain > 0.0 or leak > 0.0
            out[k] = ((drops[k] - orifice_drop.py_func(x[k], gain, leak)[0]) / span
                      if open_ else x[k] / flow)
        out[PAST] = (x[PAST] - model.piston[0]['leakage'] * (face_1 - face_2)) / flow
        out[5] = (x[PA] - x[AT] - x[PAST]
                  - areas[0] * x[SPEED] * (1.0 + face_1 / model.bulk_modulus[2])) / flow
        out[6] = (x[BT] - x[PB] - x[PAST]
                  - areas[1] * x[SPEED] * (1.0 + face_2 / model.bulk_modulus[3])) / flow
        out[SPEED] = (areas[0] * face_1 - areas[1] * face_2 - load
                      - p['cylinder.viscous_friction'] * x[SPEED]) / (max(areas) * span)
        out[PUMP] = (x[PA] + x[PB] - p['supply.max_flow']) / flow if limited else z[PUMP] - 1.0
        return out

    best = None
    for way in (0.0, 0.3, -0.3, 0.8, -0.8):
        guess = np.array([way, -way, -way, way, 0.0, 0.0, 0.0, way, supply / span])
        guess[5:7] = 0.5 * (supply + tank) / span
        for method in ('hybr', 'lm'):
            found = root(defects, guess, method=method, tol=1e-13)
            size = np.abs(defects(found.x)).max()
            if best is None or size < best[0]:
                best = size, found.x * scale
        if best[0] < SOLVED:
            return best[1]
    raise Failure('no steady motion was found at this operating point')


def _faces(model: Model, x: np.ndarray) -> tuple[float, float]:
    """Return the pressures [Pa] at E and F of a trial solution."""
    ports = [model.junctions[k]['coefficient'] for k in (PORT_1, PORT_2)]
    in_1, out_2 = x[PA] - x[AT], x[BT] - x[PB]
    face_1 = beyond_line(model, LINE_1, x[AT_B], in_1)
    face_2 = beyond_line(model, LINE_2, x[AT_I], out_2, -COARSE)
    return (face_1 - orifice_drop.py_func(in_1, ports[0], 0.0)[0],
            face_2 + orifice_drop.py_func(out_2, ports[1], 0.0)[0])


def _complete(p: Parameters, spools: tuple, load: float, found: Equilibrium,
              speed: float) -> OperatingPoint:
    """Return the point with pressures at A and J and its notes; refuse one that cavitates."""
    model, _ = assemble(p)
    x = found.network
    drawn = float(x[PA] + x[PB])
    at_a = beyond_line(model, SUPPLY_LINE, found.pump, drawn)
    at_j = beyond_line(model, RETURN_LINE, p['tank.pressure'], float(x[AT] + x[BT]), -COARSE)
    pressures = {'O': found.pump, 'A': at_a, 'B': x[AT_B], 'E': found.face_1,
                 'F': found.face_2, 'I': x[AT_I], 'J': at_j}
    station = min(pressures, key=lambda name: pressures[name])
    absolute = pressures[station] + p['ambient_pressure']
    if absolute <= p['fluid.vapour_pressure']:
        raise InputError(
            f'the oil cavitates at this operating point: station {station} would be at '
            f'{absolute:.4g} Pa absolute; raise tank.pressure or lower spool and load')
    notes = []
    sticks = max(p['cylinder.coulomb_friction'], p['cylinder.static_friction'])
    if sticks > 0.0:
        notes.append('seal friction is left out, as if the piston slid without it; in truth it '
                     f'sticks where less than {sticks:g} N moves it')
    if speed != 0.0:
        notes.append(f'the piston passes at {speed:.4g} m/s, its position held fixed')
    limited = found.pump < p['supply.pressure'] * (1.0 - 1e-12)
    if limited:
        notes.append(f'the pump gives all it can, at {found.pump / 1e6:.4g} MPa')
    return OperatingPoint(p, model, spools, load, found.position, speed, found.pump, limited,
                          found.face_1, found.face_2, x, at_a, at_j, tuple(notes))
