# SPDX-License-Identifier: Apache-2.0
"""
The actuator in equilibrium: piston at rest, steady flow everywhere; valve centred, no load.

Pressures follow from the flow that leakage and underlap let through (or a valve held open), the
position from A1 p1 - A2 p2 = k x + load, at a stop if that lies beyond. What nothing determines
is as `initial.` says:

- a chamber that nothing reaches keeps its pressure if a spring can answer it; without a spring it
  takes the pressure that balances the other, and of two such the harder pushing one gives in;
- the position without a spring, as long as the forces balance or the seals hold; else the
  piston lies at the stop it is pushed to;
- two chambers joined by nothing but the piston's leakage take the mean of their pressures, or 0
  if that pushes a piston of unequal areas without a spring.

Neglected: that trapped oil keeps its mass while the piston moves.
"""

import math
from typing import NamedTuple

from hydra_actuator.assembly import assemble
from hydra_actuator.core.friction import steady_drag
from hydra_actuator.core.model import set_domain
from hydra_actuator.core.records import Model, State
from hydra_actuator.core.source import stored_oil
from hydra_actuator.parameters import Parameters
from hydra_actuator.steady_flow import (
    AT,
    AT_B,
    AT_I,
    BT,
    CHAMBER_1,
    CHAMBER_2,
    conductances,
    LINE_1,
    LINE_2,
    line_profile,
    mu_of,
    PA,
    PAST,
    past_piston,
    PB,
    RETURN_LINE,
    solve_network,
    SUPPLY_LINE,
)
import numpy as np

# Relative to the forces on both faces: what rounding leaves of their balance.
BALANCED = 1e-9
MOST_BISECTIONS = 100


class Equilibrium(NamedTuple):
    """Gauge pressures [Pa] at pump and faces, the network, position [m] and force [N]."""

    pump: float
    face_1: float
    face_2: float
    network: np.ndarray
    position: float
    force: float


def start(parameters: Parameters) -> tuple[Model, State]:
    """Return model and state at the start: as given, or in equilibrium if that is asked for."""
    model, state = assemble(parameters)
    if not parameters['initial.equilibrium']:
        return model, state
    found = find_equilibrium(parameters, model)
    return start_at(parameters, found)


def start_at(parameters: Parameters, found: Equilibrium) -> tuple[Model, State]:
    """Return model and state at an equilibrium."""
    model, state = assemble(parameters.replace({'initial.position': found.position}))
    _set_state(parameters, model, state, found)
    return model, state


def find_equilibrium(p: Parameters, model: Model, spools: tuple[float, float] = (0.0, 0.0),
                     load: float = 0.0) -> Equilibrium:
    """
    Return the equilibrium of an assembled actuator.

    spools: where the valve is held [m]; load: external force [N], positive against x > 0.
    """
    edges = conductances(model, spools)
    lone = _lone_pressures(p, edges, load)
    pump, tank = p['supply.pressure'], p['tank.pressure']
    network = solve_network(model, pump, tank, lone, edges)
    most = p['supply.max_flow']
    if 0.0 < most < network[PA] + network[PB]:
        low, high = min(tank, pump), pump
        for _ in range(MOST_BISECTIONS):
            pump = 0.5 * (low + high)
            network = solve_network(model, pump, tank, lone, edges)
            if network[PA] + network[PB] > most:
                high = pump
            else:
                low = pump
            if high - low < 1e-9 * high:
                break
    if p['cylinder.stiffness'] == 0.0 and p['cylinder.leakage'] == 0.0:
        area_1, area_2 = p['cylinder.area_1'], p['cylinder.area_2']
        if lone[0] is None and lone[1] is not None:
            network[AT_I] = (area_1 * network[AT_B] - load) / area_2
        if lone[1] is None and lone[0] is not None:
            network[AT_B] = (area_2 * network[AT_I] + load) / area_1
    face_1, face_2, _ = past_piston(model, network[AT_B], network[PAST])
    if p['cylinder.leakage'] == 0.0:
        face_2 = float(network[AT_I])
    position, force = _position(p, face_1, face_2, load)
    return Equilibrium(pump, face_1, face_2, network, position, force)


def _lone_pressures(p: Parameters, edges: list, load: float) -> tuple[float | None, float | None]:
    """Return the pressures [Pa] of chambers that no edge of the valve reaches, else None."""
    reached = [any(sum(edges[k]) > 0.0 for k in pair) for pair in ((PA, AT), (PB, BT))]
    given = [p['initial.pressure_1'], p['initial.pressure_2']]
    if p['cylinder.leakage'] > 0.0:
        if any(reached):
            return None, None
        mean = 0.5 * (given[0] + given[1])
        if p['cylinder.stiffness'] == 0.0 and p['cylinder.area_1'] != p['cylinder.area_2']:
            mean = 0.0
        return mean, None
    if not any(reached) and p['cylinder.stiffness'] == 0.0:
        given = list(balanced(p, load))
    return tuple(None if r else float(g) for r, g in zip(reached, given))


def balanced(p: Parameters, load: float) -> tuple[float, float]:
    """Return the initial pressures [Pa], the harder pushing one lowered to hold a load [N]."""
    given = p['initial.pressure_1'], p['initial.pressure_2']
    area_1, area_2 = p['cylinder.area_1'], p['cylinder.area_2']
    lowered = (area_2 * given[1] + load) / area_1, (area_1 * given[0] - load) / area_2
    floor = p['fluid.vapour_pressure'] - p['ambient_pressure']
    lower_1 = lowered[0] < given[0]
    if lowered[0 if lower_1 else 1] < floor:
        lower_1 = not lower_1
    return (lowered[0], given[1]) if lower_1 else (given[0], lowered[1])


def _position(p: Parameters, face_1: float, face_2: float,
              load: float) -> tuple[float, float]:
    """Return position [m] and the force [N] on the piston there, friction left out."""
    push_1, push_2 = p['cylinder.area_1'] * face_1, p['cylinder.area_2'] * face_2
    push, limit = push_1 - push_2 - load, 0.5 * p['cylinder.stroke']
    stiffness = p['cylinder.stiffness']
    if stiffness > 0.0:
        position = min(limit, max(-limit, push / stiffness))
        return position, push - stiffness * position
    seals = max(p['cylinder.static_friction'],
                BALANCED * (abs(push_1) + abs(push_2) + abs(load)))
    if abs(push) <= seals:
        return p['initial.position'], push
    return math.copysign(limit, push), push


def _set_state(p: Parameters, model: Model, state: State, found: Equilibrium) -> None:
    """Write the steady profiles of all domains, the piston and the accumulator."""
    x = found.network
    past = float(x[PAST])
    at = {
        SUPPLY_LINE: (found.pump, x[PA] + x[PB], 1), LINE_1: (x[AT_B], past, 1),
        CHAMBER_1: (found.face_1, past, 1), CHAMBER_2: (found.face_2, -past, 1),
        LINE_2: (x[AT_I], past, -1), RETURN_LINE: (p['tank.pressure'], x[AT] + x[BT], -1)}
    for d, (pressure, flow, way) in at.items():
        flow = float(flow)
        mu = mu_of(model, d, pressure)
        if not model.moving[d]:
            mu = line_profile(model, d, mu, flow, way * int(state.last[d]))[::way]
        velocity = flow * model.inverse_area[d] * np.exp(-mu * model.slowness[d])
        set_domain(model, state, d, mu + velocity, mu - velocity)
    for i, velocity in enumerate(0.5 * (state.wave_p - state.wave_q)):
        state.drag[i] = steady_drag.py_func(
            velocity, model.loss[i], (model.damping, model.table_start[i]), model.table_scale)
    state.ring[5] = x[:4]
    state.piston[0]['force'] = found.force
    state.oil_stored[:] = stored_oil.py_func(found.pump, model.source.view(np.recarray)[0])
