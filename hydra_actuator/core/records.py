# SPDX-License-Identifier: Apache-2.0
"""
What the step works on: one constant record (Model) and one changing record (State).

A model is a chain of domains (lines and chambers) and of junctions between their ends. Domain d
has two ends, 2 d (its node 0) and 2 d + 1 (its last node, or the piston's face in a chamber). A
chamber is always seen from its fixed end towards the piston, so the second chamber is mirrored.
Outflow velocities are positive out of the domain, whichever end.
"""

from dataclasses import dataclass, replace

from hydra_actuator.core.handle import Handle
import numpy as np

CLOSED, PRESSURE, FLOW, PUMP, ORIFICE, VALVE, PISTON, WALL = range(8)

# A junction names its ends in the order of its drawing, unused ones -1. `input` is the column of
# the input table it follows: pressure [Pa] (PRESSURE), outflow [m^3/s] (FLOW), velocity [m/s]
# of a moving wall (WALL), first of two spools (VALVE), load force (PISTON).
JUNCTION = np.dtype([
    ('kind', np.int64), ('end', np.int64, 4), ('input', np.int64),
    ('coefficient', np.float64), ('leakage', np.float64)], align=True)

# `null_shift` [m], `command_lost` and `stuck` (0, 1) are faults, changed only between calls.
VALVE_PARAMETERS = np.dtype([
    ('flow_gain', np.float64, 4), ('overlap', np.float64, 4), ('leakage', np.float64),
    ('stroke', np.float64), ('natural_frequency', np.float64), ('slew_rate', np.float64),
    ('transition', np.float64, 4), ('step_time', np.float64),
    ('null_shift', np.float64), ('command_lost', np.int64), ('stuck', np.int64)], align=True)

PISTON_PARAMETERS = np.dtype([
    ('mass', np.float64), ('stiffness', np.float64), ('viscous', np.float64),
    ('coulomb', np.float64), ('breakaway', np.float64), ('stribeck_velocity', np.float64),
    ('leakage', np.float64), ('restitution', np.float64), ('limit', np.float64),
    ('length_1', np.float64), ('length_2', np.float64)], align=True)

# Changed only between calls (supply pressure is a live parameter).
SOURCE_PARAMETERS = np.dtype([
    ('pressure', np.float64), ('mu', np.float64), ('relative_density', np.float64),
    ('max_flow', np.float64),
    ('accumulator_volume', np.float64), ('precharge', np.float64), ('ambient', np.float64)],
    align=True)

# `slip_1`, `slip_2` [m/s]: by how much the oil at the faces last was faster than the piston.
PISTON_STATE = np.dtype([
    ('position', np.float64), ('velocity', np.float64), ('force', np.float64),
    ('new_position', np.float64), ('new_velocity', np.float64), ('new_force', np.float64),
    ('slip_1', np.float64), ('slip_2', np.float64),
    ('hit', np.int64), ('stop_hits', np.int64)], align=True)

# Cavities open at the last whole period, opened and collapsed so far, largest volume [m^3].
CAVITY_COUNTS = np.dtype([
    ('open', np.int64), ('opened', np.int64), ('collapsed', np.int64), ('largest', np.float64)],
    align=True)

# Since the balance of mass began: net inflow now and its half sum of sizes [kg/s], both summed
# [kg], mass then and what is missing at the last weighing [kg]; see hydra_actuator.core.mass.
MASS_BALANCE = np.dtype([
    ('began', np.int64), ('net', np.float64), ('through', np.float64), ('entered', np.float64),
    ('passed', np.float64), ('at_first', np.float64), ('residual', np.float64)], align=True)


@dataclass(frozen=True, eq=False)
class Model(Handle):
    """
    Constants of a chain; shapes: D domains, N nodes with ghosts, J junctions.

    The length of `extras` is part of the type: a plain chain is compiled alone, without a trace
    of what it does not need.
    """

    step_time: float
    max_mach: float
    third_order: float
    origin: np.ndarray          # (D,) streamline coordinate of node 0 [m]
    direction: np.ndarray       # (D,) +1, or -1 where the domain is mirrored
    start: np.ndarray           # (D,) index of node 0 in the node arrays
    capacity: np.ndarray        # (D,) largest index of a whole node within the domain
    moving: np.ndarray          # (D,) 1 where the far end is a moving face
    spacing: np.ndarray         # (D,) cell length [m]
    wave_speed: np.ndarray      # (D,) [m/s]
    bulk_modulus: np.ndarray    # (D,) [Pa]
    area: np.ndarray            # (D,) [m^2]
    slowness: np.ndarray        # (D,) 1/c [s/m]
    impedance: np.ndarray       # (D,) rho0 c/A [Pa s/m^3]
    inverse_area: np.ndarray    # (D,) [1/m^2]
    courant: np.ndarray         # (N,) c dt/dx [-]
    slope: np.ndarray           # (N,) dt/dx / 2 [s/m], for velocities 2 u
    friction: np.ndarray        # (N,) lambda dt / 8 [s/m], for velocities 2 u
    extras: tuple               # () with constant friction or none and no gas, else (1,)
    floor: float                # ambient less vapour pressure [Pa]
    loss: np.ndarray            # (N,) lambda [1/m]
    damping: np.ndarray         # tables of h [1/s], one line's after the other's
    table_start: np.ndarray     # (N,) where the node's table begins
    table_scale: float          # table entries per sqrt(m/s)
    decay: np.ndarray           # (TERMS, N) exp(-z) of the friction's memory
    gain: np.ndarray            # (TERMS, N) of a change of u on it [1/s]
    inertia: np.ndarray         # (N,) of a change of u on the drag [1/s]
    liveliness: np.ndarray      # (N,) inertia and all gains [1/s]
    tabled: int                 # 1: some line's friction has a table, 0: `friction` has it all
    unsteady: int               # 1: some line's friction has a memory
    gas: int                    # 1: there is gas in the oil
    strength: np.ndarray        # (N,) of the gas at inner nodes [Pa m/s], 0 at ends
    end_strength: np.ndarray    # (D,) of the gas at ends [Pa m/s]
    node_slowness: np.ndarray   # (N,) 1/c [s/m]
    node_bulk_modulus: np.ndarray  # (N,) [Pa]
    junctions: np.ndarray       # (J,) JUNCTION
    orifice_ends: np.ndarray    # (16,) or (0,): see hydra_actuator.core.orifices
    orifice_edges: np.ndarray   # (8,) or (0,)
    orifice_constants: np.ndarray  # (80,) or (0,)
    orifice_leakage: np.ndarray  # (4,) or (0,) [m^3/(s Pa)]
    valve: np.ndarray           # (1,) VALVE_PARAMETERS
    piston: np.ndarray          # (1,) PISTON_PARAMETERS
    source: np.ndarray          # (1,) SOURCE_PARAMETERS


@dataclass(frozen=True, eq=False)
class State(Handle):
    """What a step changes."""

    wave_p: np.ndarray          # (N,) mu + u [m/s], u away from node 0
    wave_q: np.ndarray          # (N,) mu - u [m/s]
    new_p: np.ndarray           # (N,) work: the next level
    new_q: np.ndarray           # (N,)
    last: np.ndarray            # (D,) index of the last whole node
    length: np.ndarray          # (D,) length at the new level [m]
    old_length: np.ndarray      # (D,) length at the old level [m]
    old_velocity: np.ndarray    # (D,) outflow velocity of the face at the old level [m/s]
    end_wave: np.ndarray        # (2 D,) wave that arrives [m/s]
    end_velocity: np.ndarray    # (2 D,) outflow velocity [m/s]
    end_velocity_before: np.ndarray  # (2 D,) the same one step ago
    end_theta: np.ndarray       # (2 D,) foot of the arriving wave [cells]
    end_held: np.ndarray        # (2 D, 2) pressure [Pa] an end is held at, its mu [m/s]
    face_p: np.ndarray          # (D,) P at a moving face
    face_q: np.ndarray          # (D, 3) Q at a moving face now, one and two steps ago
    drag: np.ndarray            # (N,) J of the wall's friction [m/s^2]
    memory: np.ndarray          # (TERMS, N) of the friction, as drag [m/s^2]
    fading: np.ndarray          # (N,) what the memory will be if u stays [m/s^2]
    damping: np.ndarray         # (N,) work: h [1/s]
    star: np.ndarray            # (N,) absolute less vapour pressure where there is gas [Pa]
    end_star: np.ndarray        # (2 D,) the same at the ends
    strength: np.ndarray        # (N,) the model's, 0 where a moving face has the node's gas
    face_held: np.ndarray       # (D,) gas at moving faces by volume, as a velocity [m/s]
    lowest_star: np.ndarray     # (N + D,) lowest since cavities were counted, faces last [Pa]
    was_open: np.ndarray        # (N + D,) int64: 1 where a cavity was open then
    cavities: np.ndarray        # (1,) CAVITY_COUNTS
    mass: np.ndarray            # (1,) MASS_BALANCE
    spool: np.ndarray           # (4,) displacement, velocity of spool 1, of spool 2
    edge_coefficient: np.ndarray  # (6,) K' of the valve's edges, of two ports
    valve_velocity: np.ndarray  # (4,) work: outflow at A, B, I, J
    ring: np.ndarray            # (6, 4) work of the valve; row 5 the edge flows [m^3/s]
    piston: np.ndarray          # (1,) PISTON_STATE
    oil_stored: np.ndarray      # (2,) accumulator: now, next [m^3]
    step: np.ndarray            # (1,) int64 steps done
    fault: np.ndarray           # (3,) status: code, domain, value
    exchanged: 'State | None' = None  # the same with the two levels of the waves exchanged

    def __post_init__(self) -> None:
        """Let kernels see both readings of the waves: no array is copied."""
        super().__post_init__()
        if self.exchanged is None:
            self._tie('exchanged', replace(
                self, wave_p=self.new_p, wave_q=self.new_q, new_p=self.wave_p, new_q=self.wave_q,
                exchanged=self))
