# SPDX-License-Identifier: Apache-2.0
"""
Four actuators side by side, one in each lane: a structure of arrays.

What all have alike (domains, junctions, where a domain's nodes begin) stands once; every number
of theirs stands WIDTH times, lane l of element e at WIDTH e + l. Their meshes differ: each lane
has its own step time and its own last node of every domain.
"""

from dataclasses import dataclass, replace

from hydra_actuator.core.handle import Handle
from hydra_actuator.core.lanes import WIDTH
from hydra_actuator.core.line import GHOSTS, GHOSTS_BEYOND_FACE, LONG
from hydra_actuator.core.records import Model
import numpy as np

# Of |u|/c: what is nearer than this to the limit is looked at alone, with the limit itself.
NEAR = 1.0 - 1e-9
LINE = 64              # [byte] of a processor's cache


@dataclass(frozen=True, eq=False)
class Ensemble(Handle):
    """Four chains; shapes: D domains, N nodes with ghosts, J junctions, L = WIDTH lanes."""

    third_order: float
    start: np.ndarray           # (D,) index of node 0
    moving: np.ndarray          # (D,) 1 where the far end is a moving face
    capacity: np.ndarray        # (D L,) largest index of a whole node
    step_time: np.ndarray       # (L,) [s]
    courant: np.ndarray         # (D L,) c dt/dx [-]
    slope: np.ndarray           # (D L,) dt/dx / 2 [s/m]
    friction: np.ndarray        # (D L,) lambda dt / 8 [s/m]
    spacing: np.ndarray         # (D L,) cell length [m]
    wave_speed: np.ndarray      # (D L,) [m/s]
    slowness: np.ndarray        # (D L,) 1/c [s/m]
    bulk_modulus: np.ndarray    # (D L,) [Pa]
    area: np.ndarray            # (D L,) [m^2]
    impedance: np.ndarray       # (D L,) rho0 c/A [Pa s/m^3]
    inverse_area: np.ndarray    # (D L,) [1/m^2]
    fastest: np.ndarray         # (D L,) |u| [m/s] that is looked at alone
    coefficient: np.ndarray     # (J L,) K' of orifices [m^3/(s sqrt(Pa))]
    leakage: np.ndarray         # (J L,) G of orifices [m^3/(s Pa)]
    wave_p: np.ndarray          # (N L,) mu + u [m/s]
    wave_q: np.ndarray          # (N L,) mu - u [m/s]
    new_p: np.ndarray           # (N L,) work: the next level
    new_q: np.ndarray           # (N L,)
    last: np.ndarray            # (D L,) int64, index of the last whole node
    place: np.ndarray           # (D L,) int64, where the last whole node is in the arrays
    length: np.ndarray          # (D L,) [m]
    old_length: np.ndarray      # (D L,) [m]
    old_velocity: np.ndarray    # (D L,) of the face [m/s]
    face_p: np.ndarray          # (D L,) P at a moving face
    face_q: np.ndarray          # (3 D L,) Q there now, one and two steps ago
    end_wave: np.ndarray        # (2 D L,) wave that arrives [m/s]
    end_velocity: np.ndarray    # (2 D L,) outflow velocity [m/s]
    end_velocity_before: np.ndarray  # (2 D L,) the same one step ago
    end_theta: np.ndarray       # (2 D L,) foot of the arriving wave [cells]
    spool: np.ndarray           # (4 L,) displacement, velocity of spool 1, of spool 2
    stroke: np.ndarray          # (L,) VALVE_PARAMETERS, as the next five
    natural_frequency: np.ndarray  # (L,)
    slew_rate: np.ndarray       # (L,)
    transition: np.ndarray      # (4 L,)
    flow_gain: np.ndarray       # (4 L,)
    overlap: np.ndarray         # (4 L,)
    edge: np.ndarray            # (4 L,) K' of the valve's edges
    relief_mu: np.ndarray       # (L,) mu at the pump's pressure [m/s]
    relief_density: np.ndarray  # (L,) rho/rho0 there
    max_flow: np.ndarray        # (L,) of the pump [m^3/s], without end for none
    tank_pressure: np.ndarray   # (L,) [Pa]
    tank_mu: np.ndarray         # (L,) [m/s]
    mass: np.ndarray            # (L,) PISTON_PARAMETERS, as the next five
    stiffness: np.ndarray       # (L,)
    viscous: np.ndarray         # (L,)
    limit: np.ndarray           # (L,)
    length_1: np.ndarray        # (L,)
    length_2: np.ndarray        # (L,)
    theta: np.ndarray           # (L,) of the momentum balance
    motion: np.ndarray          # (3 L,) the piston's position, velocity and force
    moved: np.ndarray           # (3 L,) the same at the new level
    feed: np.ndarray            # (C L,) inputs in force
    alone: np.ndarray           # (2,) int64, 1 where pump, piston are solved one by one
    work: np.ndarray            # (2 L,)
    cursor: np.ndarray          # (L,) int64 row of each lane's inputs
    exchanged: 'Ensemble | None' = None  # the same with the levels of the waves exchanged

    def __post_init__(self) -> None:
        """Let kernels see both readings of the waves: no array is copied."""
        super().__post_init__()
        if self.exchanged is None:
            self._tie('exchanged', replace(
                self, wave_p=self.new_p, wave_q=self.new_q, new_p=self.wave_p, new_q=self.wave_q,
                exchanged=self))


def fits(model: Model) -> bool:
    """
    Return whether a chain may be one of an ensemble.

    Not with gas, a friction table, leakage at the valve (its edges are a ring then), a fault of
    the valve, or a domain shorter than LONG cells.
    """
    valve = model.valve[0]
    odd = any(valve[name] for name in ('leakage', 'null_shift', 'command_lost', 'stuck'))
    return len(model.extras) == 0 and bool((model.capacity >= LONG).all()) and not odd


def build_ensemble(models: list[Model], inputs: int) -> Ensemble:
    """
    Return the ensemble of WIDTH chains of the same domains and junctions.

    The interpolation must be the same, and all must fit; inputs: how many a chain has.
    """
    first = models[0]
    domains = len(first.start)
    capacity = np.array([model.capacity for model in models])
    room = GHOSTS + capacity.max(axis=0) + 1 + np.where(
        first.moving == 1, GHOSTS_BEYOND_FACE, GHOSTS)
    start = 2 * GHOSTS + np.concatenate(([0], np.cumsum(room)[:-1])).astype(np.int64)
    nodes = int(room.sum()) + 4 * GHOSTS

    def side_by_side(values, kind=float):
        together = np.array(values, kind).T.ravel()
        aligned = _aligned(together.size, kind)
        aligned[:] = together
        return aligned

    def of_records(record, names):
        return {name: side_by_side([getattr(model, record)[name][0] for model in models])
                for name in names}

    most = [model.max_mach * model.wave_speed for model in models]
    flows = [model.source['max_flow'][0] or np.inf for model in models]
    rooms = {
        'wave_p': nodes, 'wave_q': nodes, 'new_p': nodes, 'new_q': nodes, 'length': domains,
        'old_length': domains, 'old_velocity': domains, 'face_p': domains,
        'face_q': 3 * domains, 'end_wave': 2 * domains, 'end_velocity': 2 * domains,
        'end_velocity_before': 2 * domains, 'end_theta': 2 * domains, 'spool': 4, 'edge': 4,
        'relief_mu': 1, 'relief_density': 1, 'tank_pressure': 1, 'tank_mu': 1, 'theta': 1,
        'motion': 3, 'moved': 3, 'feed': inputs, 'work': 2}
    return Ensemble(
        third_order=first.third_order, start=start, moving=first.moving.copy(),
        capacity=side_by_side(capacity, np.int64),
        step_time=side_by_side([model.step_time for model in models]),
        **{name: side_by_side([getattr(model, name)[model.start] for model in models])
           for name in ('courant', 'slope', 'friction')},
        **{name: side_by_side([getattr(model, name) for model in models]) for name in (
            'spacing', 'wave_speed', 'slowness', 'bulk_modulus', 'area', 'impedance',
            'inverse_area')},
        fastest=NEAR * side_by_side(most), max_flow=side_by_side(flows),
        **{name: side_by_side([model.junctions[name] for model in models])
           for name in ('coefficient', 'leakage')},
        **of_records('valve', ('stroke', 'natural_frequency', 'slew_rate', 'transition',
                               'flow_gain', 'overlap')),
        **of_records('piston', ('mass', 'stiffness', 'viscous', 'limit', 'length_1', 'length_2')),
        alone=np.array([any(model.source['accumulator_volume'][0] > 0.0 for model in models),
                        any(_is_held(model.piston[0]) for model in models)], np.int64),
        **{name: _aligned(size * WIDTH) for name, size in rooms.items()},
        last=_aligned(WIDTH * domains, np.int64), place=_aligned(WIDTH * domains, np.int64),
        cursor=_aligned(WIDTH, np.int64))


def _is_held(piston: np.void) -> bool:
    """Return whether seals rub or leak."""
    return bool(piston['coulomb'] > 0.0 or piston['breakaway'] > 0.0 or piston['leakage'] > 0.0)


def _aligned(size: int, kind: type = float) -> np.ndarray:
    """Return zeros of which no WIDTH in a row from a multiple of WIDTH cross a line of cache."""
    spare = LINE // 8
    plain = np.zeros(size + spare, kind)
    return plain[-plain.ctypes.data % LINE // 8:][:size]
