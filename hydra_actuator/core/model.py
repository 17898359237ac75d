# SPDX-License-Identifier: Apache-2.0
"""
Build a chain of domains and junctions, and its state at rest, from a plain description.

The mesh: one step time for all; a line has floor(length / (c (1 + max_mach) dt)) cells of its
own length, so neither length nor wave speed is altered; a chamber has cells of c (1 + max_mach) dt
from its fixed end and a partial one at the face.
"""

from dataclasses import dataclass
import math

from hydra_actuator.core.friction import TERMS
from hydra_actuator.core.gas import place_gas
from hydra_actuator.core.lanes import WIDTH
from hydra_actuator.core.line import GHOSTS, GHOSTS_BEYOND_FACE
from hydra_actuator.core.oil import friction_constants, gas_constants, has_table, Oil
from hydra_actuator.core.orifices import EDGES, orifice_arrays, port_coefficients
from hydra_actuator.core.records import (
    CAVITY_COUNTS,
    JUNCTION,
    MASS_BALANCE,
    Model,
    PISTON_PARAMETERS,
    PISTON_STATE,
    SOURCE_PARAMETERS,
    State,
    VALVE_PARAMETERS,
)
import numpy as np

# Spare nodes before the first ghost of the arrays, and after the last: the sweep goes WIDTH nodes
# at a time and reads two beyond.
SPARE, SPARE_BEHIND = 1, WIDTH - 1


@dataclass(frozen=True)
class Domain:
    """
    A line, or (longest > 0) a chamber that its moving face may stretch to `longest` [m].

    origin: streamline coordinate of node 0 [m]; direction -1 where node 0 is downstream.
    pressure: initial gauge pressure [Pa], velocity: initial velocity from node 0 on [m/s].
    """

    name: str
    length: float
    area: float
    wave_speed: float
    loss_coefficient: float = 0.0
    pressure: float = 0.0
    velocity: float = 0.0
    longest: float = 0.0
    friction: str = 'constant'
    roughness: float = 0.0
    origin: float = 0.0
    direction: float = 1.0


@dataclass(frozen=True)
class Junction:
    """A junction of one to four ends; see hydra_actuator.core.records for what each kind uses."""

    kind: int
    ends: tuple[int, ...]
    input: int = 0
    coefficient: float = 0.0
    leakage: float = 0.0


@dataclass(frozen=True)
class Mesh:
    """How a chain is discretised."""

    step_time: float
    max_mach: float = 0.025
    iterations: int = 2
    interpolation: str = 'cubic'


def build_chain(oil: Oil, domains: list[Domain], junctions: list[Junction], mesh: Mesh,
                **records: np.ndarray) -> tuple[Model, State]:
    """
    Return model and state at rest of a chain.

    records: `valve`, `piston`, `source` of their dtypes, shape (1,), where a junction uses them.
    Raises ValueError for a domain shorter than one cell.
    """
    count = len(domains)
    spacing = np.empty(count)
    capacity, last = np.empty((2, count), np.int64)
    for d, domain in enumerate(domains):
        spacing[d], last[d], capacity[d] = _cells(domain, mesh)
    moving = np.array([int(domain.longest > 0.0) for domain in domains])
    # loops that go WIDTH nodes at a time may write beyond the last one, not into the next domain
    after = np.where(moving == 1, GHOSTS_BEYOND_FACE, max(GHOSTS, WIDTH - 1 - GHOSTS))
    room = GHOSTS + capacity + 1 + after
    start = GHOSTS + SPARE + np.concatenate(([0], np.cumsum(room)[:-1])).astype(np.int64)
    of_node = np.concatenate((
        np.zeros(SPARE, np.int64), np.repeat(np.arange(count), room),
        np.full(SPARE_BEHIND, count - 1)))
    wave_speed = np.array([domain.wave_speed for domain in domains])
    area = np.array([domain.area for domain in domains])
    tabled = has_table(domains)
    loss = np.array([domain.loss_coefficient if domain.friction == 'constant' else 0.0
                     for domain in domains])
    strength, end_strength = gas_constants(oil, wave_speed, spacing, mesh.step_time)
    model = Model(
        step_time=mesh.step_time, max_mach=mesh.max_mach,
        third_order=1.0 if mesh.interpolation == 'cubic' else 0.0,
        origin=np.array([domain.origin for domain in domains]),
        direction=np.array([domain.direction for domain in domains]),
        start=start, capacity=capacity,
        moving=moving,
        spacing=spacing, wave_speed=wave_speed, bulk_modulus=oil.density * wave_speed ** 2,
        area=area, slowness=1.0 / wave_speed, impedance=oil.density * wave_speed / area,
        inverse_area=1.0 / area,
        courant=(wave_speed * mesh.step_time / spacing)[of_node],
        slope=(0.5 * mesh.step_time / spacing)[of_node],
        friction=(0.125 * mesh.step_time * (not tabled) * loss)[of_node],
        extras=(1,) if tabled or oil.air_fraction > 0.0 else (),
        gas=int(oil.air_fraction > 0.0), floor=oil.floor, tabled=int(tabled),
        **friction_constants(
            oil, domains, mesh.step_time, mesh.max_mach * float(np.max(wave_speed)), of_node),
        strength=_inner(strength, of_node, start, capacity, moving), end_strength=end_strength,
        node_slowness=(1.0 / wave_speed)[of_node],
        node_bulk_modulus=(oil.density * wave_speed ** 2)[of_node],
        junctions=_junction_records(junctions),
        **orifice_arrays(junctions, oil.density, wave_speed, area),
        valve=records.get('valve', np.zeros(1, VALVE_PARAMETERS)),
        piston=records.get('piston', np.zeros(1, PISTON_PARAMETERS)),
        source=records.get('source', np.zeros(1, SOURCE_PARAMETERS)))
    state = _empty_state(count, len(of_node), port_coefficients(junctions))
    state.last[:] = last
    state.length[:] = state.old_length[:] = [domain.length for domain in domains]
    for d, domain in enumerate(domains):
        mu = domain.wave_speed * math.log1p(domain.pressure / model.bulk_modulus[d])
        set_domain(model, state, d, mu + domain.velocity, mu - domain.velocity)
    return model, state


def set_domain(model: Model, state: State, d: int, wave_p, wave_q) -> None:
    """
    Set P and Q [m/s] of a whole domain, scalars or arrays over its whole nodes.

    A moving face takes the values of the last node.
    """
    after = GHOSTS_BEYOND_FACE if model.moving[d] else GHOSTS
    nodes = slice(model.start[d] - GHOSTS, model.start[d] + model.capacity[d] + 1 + after)
    whole = slice(model.start[d], model.start[d] + state.last[d] + 1)
    for field, wave in ((state.wave_p, wave_p), (state.wave_q, wave_q)):
        field[nodes] = np.asarray(wave).flat[-1]
        field[whole] = wave
    last = model.start[d] + state.last[d]
    state.face_p[d], state.face_q[d] = state.wave_p[last], state.wave_q[last]
    state.old_velocity[d] = 0.5 * (state.wave_p[last] - state.wave_q[last])
    state.end_velocity[2 * d + 1] = state.old_velocity[d]
    first = model.start[d]
    state.end_velocity[2 * d] = -0.5 * (state.wave_p[first] - state.wave_q[first])
    state.end_wave[2 * d], state.end_wave[2 * d + 1] = state.wave_q[first], state.wave_p[last]
    state.end_velocity_before[:] = state.end_velocity
    state.new_p[:], state.new_q[:] = state.wave_p, state.wave_q
    star = model.floor + model.bulk_modulus[d] * np.expm1(
        0.5 * (state.wave_p[nodes] + state.wave_q[nodes]) / model.wave_speed[d])
    if model.end_strength[d] > 0.0:
        state.star[nodes] = star
        state.end_star[2 * d], state.end_star[2 * d + 1] = state.star[first], state.star[last]
        place_gas(model, state, d)


def node_positions(model: Model, state: State, d: int) -> np.ndarray:
    """Return the distance [m] of a domain's whole nodes from its node 0."""
    return model.spacing[d] * np.arange(state.last[d] + 1)


def _cells(domain: Domain, mesh: Mesh) -> tuple[float, int, int]:
    shortest = domain.wave_speed * (1.0 + mesh.max_mach) * mesh.step_time
    cells = int(domain.length / shortest + 1e-9)
    if cells < 1:
        raise ValueError(
            f'{domain.name}: {domain.length:g} m is shorter than one cell of {shortest:.4g} m')
    if domain.longest > 0.0:
        return shortest, int(domain.length / shortest), int(domain.longest / shortest) + 1
    return domain.length / cells, cells, cells


def _inner(strength: np.ndarray, of_node: np.ndarray, start: np.ndarray,
           capacity: np.ndarray, moving: np.ndarray) -> np.ndarray:
    inner = np.zeros(len(of_node))
    for d, first in enumerate(start):
        inner[first + 1:first + capacity[d] + moving[d]] = strength[d]
    return inner


def _junction_records(junctions: list[Junction]) -> np.ndarray:
    records = np.zeros(len(junctions), JUNCTION)
    for record, junction in zip(records, junctions):
        ends = junction.ends + (-1,) * (4 - len(junction.ends))
        record['kind'], record['end'], record['input'] = junction.kind, ends, junction.input
        record['coefficient'], record['leakage'] = junction.coefficient, junction.leakage
    return records


def _empty_state(domains: int, nodes: int, ports: list[float]) -> State:
    return State(
        wave_p=np.zeros(nodes), wave_q=np.zeros(nodes), new_p=np.zeros(nodes),
        new_q=np.zeros(nodes), last=np.zeros(domains, np.int64), length=np.zeros(domains),
        old_length=np.zeros(domains), old_velocity=np.zeros(domains),
        end_wave=np.zeros(2 * domains), end_velocity=np.zeros(2 * domains),
        end_velocity_before=np.zeros(2 * domains), end_theta=np.zeros(2 * domains),
        end_held=np.full((2 * domains, 2), np.nan),
        face_p=np.zeros(domains), face_q=np.zeros((domains, 3)),
        drag=np.zeros(nodes), memory=np.zeros((TERMS, nodes)), fading=np.zeros(nodes),
        damping=np.zeros(nodes), star=np.ones(nodes),
        end_star=np.ones(2 * domains), strength=np.zeros(nodes), face_held=np.zeros(domains),
        lowest_star=np.full(nodes + domains, np.inf),
        was_open=np.zeros(nodes + domains, np.int64), cavities=np.zeros(1, CAVITY_COUNTS),
        mass=np.zeros(1, MASS_BALANCE),
        spool=np.zeros(4), edge_coefficient=np.array([0.0] * EDGES + ports),
        valve_velocity=np.zeros(4), ring=np.zeros((6, 4)), piston=np.zeros(1, PISTON_STATE),
        oil_stored=np.zeros(2), step=np.zeros(1, np.int64), fault=np.zeros(3))
