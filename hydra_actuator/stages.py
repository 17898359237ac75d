# SPDX-License-Identifier: Apache-2.0
"""
Where the time of a step goes, and how far the sweep is from what the machine can do.

Each stage is repeated alone on a state of a moving actuator, all in turn in one run, so that what
the machine does meanwhile falls on all alike. Alone a stage finds its data at hand and nothing to
overlap with: the sum may be more or less than the step.
"""

import copy
from dataclasses import dataclass
import math

from hydra_actuator.actuator import Actuator
from hydra_actuator.benchmark import drive, PIECE, processor_time, repeat_sweep, WARM_UP
from hydra_actuator.core.advance import LOOK_EVERY
from hydra_actuator.core.boiling import note_lowest
from hydra_actuator.core.cavity import fill_cavities, read_beside_faces
from hydra_actuator.core.compilation import formula, kernel
from hydra_actuator.core.drag import remember_drag, sweep_with_drag
from hydra_actuator.core.junctions import solve_junction
from hydra_actuator.core.line import sweep_domains
from hydra_actuator.core.observe import find_limits, runs_away
from hydra_actuator.core.orifices import solve_open_orifices
from hydra_actuator.core.step import (
    arrive,
    continue_beyond_ends,
    extrapolate_ends,
    move_spools,
    take_new_level,
)
from hydra_actuator.parameters import Parameters
import numpy as np

REPEATS, CALLS = 500, 100     # of a stage, and of a call from Python, in one timed piece
JUNCTIONS = ('pump', 'valve', 'port C|D', 'piston', 'port G|H', 'tank')
# Of these, where hydra_actuator.core.orifices solves them at once.
TOGETHER = ('valve', 'port C|D', 'port G|H')
(SPOOLS, GHOSTS, SWEEP, EXTRAPOLATION, ARRIVAL, LEVEL, CAVITIES, MEMORY, LOWEST, ALARM,
 LIMITS, ORIFICES, NOTHING) = range(13)
FIRST_JUNCTION = 13
NAMES = ('spools', 'ghosts', 'sweep', 'extrapolation', 'arrival', 'new level', 'cavities',
         'memory of friction', 'lowest pressure', 'alarm', 'limits', 'valve and ports', 'nothing',
         *(f'junction: {name}' for name in JUNCTIONS))


@dataclass(frozen=True)
class Stages:
    """
    Median times [s]: of each stage as a part of one step, of a whole step, of the bare loop.

    limit: a loop over all nodes of the arrays with loads, stores and arithmetic of a plain sweep
    of two passes, but no operation that waits for another: a yardstick that stays as it is, while
    the sweep leaves out the nodes that no domain covers; bare_sweep: the plain sweep alone.
    """

    times: dict[str, float]
    step: float
    bare_sweep: float
    limit: float


@kernel
def repeat_stage(model, state, inputs, passes, stage, count):
    """Repeat one stage of the step."""
    for _ in range(count):
        if stage < CAVITIES:
            do_stage(model, state, inputs, passes, stage)
        elif stage < FIRST_JUNCTION:
            do_part(model, state, passes, stage)
        else:
            solve_junction(model, state, stage - FIRST_JUNCTION, inputs)


@formula
def do_stage(model, state, inputs, passes, stage):
    """Do a stage that hydra_actuator.core.step lists."""
    mesh = (model.courant, model.slope, model.friction)
    if stage == SPOOLS:
        move_spools(model, state, inputs)
    elif stage == GHOSTS:
        continue_beyond_ends(model, state)
    elif stage == SWEEP:
        if len(model.extras) == 0 or model.tabled == 0:
            sweep_domains(model, state, passes)
        else:
            sweep_with_drag(model, state, passes)
    elif stage == EXTRAPOLATION:
        extrapolate_ends(state)
    elif stage == ARRIVAL:
        arrive(model, state, mesh, (len(passes) == 1, True))
    elif stage == LEVEL:
        take_new_level(model, state, passes)


@formula
def do_part(model, state, passes, stage):
    """Do a part of the new level, or what follows a step."""
    if stage == CAVITIES and model.gas == 1:
        fill_cavities(model, state)
        read_beside_faces(model, state)
    elif stage == MEMORY and model.tabled == 1:
        remember_drag(model, state, len(passes) > 1)
    elif stage == LOWEST and model.gas == 1:
        note_lowest(model, state)
    elif stage == ALARM:
        # what nothing changes and nobody reads would be left out
        state.end_velocity[0] = -state.end_velocity[0]
        state.fault[2] += runs_away(model, state)
    elif stage == LIMITS:
        find_limits(model, state)
    elif stage == ORIFICES:
        solve_open_orifices(model, state)


@kernel
def are_together(model, state):
    """Return whether the valve's edges and the ports are solved at once."""
    return solve_open_orifices(model, state)


@kernel
def repeat_limit(waves, new_waves, mesh, count):
    """
    Load, store and calculate as a sweep may, 38 multiply-adds and 31 additions a node.

    The sums run side by side in ten chains, so nothing waits.
    """
    wave_p, wave_q = waves
    new_p, new_q = new_waves
    courant, slope, friction = mesh
    for _ in range(count):
        for i in range(wave_p.size - 4):
            a, b, c, d = wave_p[i], wave_p[i + 1], wave_p[i + 2], wave_p[i + 3]
            e, f, g, h = wave_q[i + 1], wave_q[i + 2], wave_q[i + 3], wave_q[i + 4]
            x, y, z = courant[i + 2], slope[i + 2], friction[i + 2]
            for _ in range(4):
                a, b, c, d = a * x + y, b * x + y, c * x + y, d * x + y
                e, f, g, h = e * x + y, f * x + y, g * x + y, h * x + y
                a, b, c, d = a + z, b + z, c + z, d + z
                e, f, g = e + z, f + z, g + z
            a, b, c, d, e, f = a * x + b, b * x + c, c * x + d, d * x + e, e * x + f, f * x + g
            new_p[i + 2] = (a + b) + c
            new_q[i + 2] = (d + e) + (f + h)


def measure_stages(parameters: Parameters | None = None, pieces: int = 40) -> Stages:
    """Time all stages in turn, `pieces` times, by this thread's processor time."""
    actuator = Actuator(parameters)
    drive(actuator, math.ceil(WARM_UP / actuator.period))
    model, state = actuator._model, actuator._state
    passes, inputs = actuator._passes, actuator._inputs
    bare = (model, copy.deepcopy(state), passes)
    loop = plain_arrays(model, state)
    spent = {name: [] for name in NAMES}
    others = {'step': [], 'bare': [], 'limit': [], 'observe': [], 'call': []}
    repeat_limit(*loop, 1)
    repeat_sweep(*bare, 1)
    for k in range(len(NAMES)):
        repeat_stage(model, copy.deepcopy(state), inputs, passes, k, 1)
    steps = actuator.steps_per_period
    for _ in range(pieces):
        for k, name in enumerate(NAMES):
            trial = copy.deepcopy(state)
            spent[name].append(_clock(
                REPEATS, repeat_stage, model, trial, inputs, passes, k, REPEATS))
        others['bare'].append(_clock(REPEATS, repeat_sweep, *bare, REPEATS))
        others['limit'].append(_clock(REPEATS, repeat_limit, *loop, REPEATS))
        others['observe'].append(_clock(CALLS * steps, _call, actuator._observe))
        others['call'].append(_clock(
            CALLS * steps, _call, actuator._advance, actuator._schedule, 0))
        drive(actuator, 1)
        others['step'].append(_clock(PIECE * steps, drive, actuator, PIECE))
    times = {name: float(np.median(column)) for name, column in spent.items()}
    call = times.pop('nothing')
    times = {name: max(took - call, 0.0) for name, took in times.items()}
    times['new level'] -= times['cavities'] + times['memory of friction']
    times['limits'] /= LOOK_EVERY
    together = are_together(model, copy.deepcopy(state))
    for name in [f'junction: {name}' for name in TOGETHER] if together else ['valve and ports']:
        del times[name]
    times['observation'] = float(np.median(others['observe']))
    times['calls from Python'] = float(np.median(others['call']))
    return Stages(times, *(float(np.median(others[key])) for key in ('step', 'bare', 'limit')))


def plain_arrays(model, state) -> tuple[tuple, tuple, tuple]:
    """Return (waves, new waves, mesh) for the bare loop, copies but for the mesh."""
    waves = (state.wave_p.copy(), state.wave_q.copy())
    return (waves, (waves[0].copy(), waves[1].copy()),
            (model.courant, model.slope, model.friction))


def _call(function, *arguments) -> None:
    """Call CALLS times: once alone would be the cost of the clock and of what is not at hand."""
    for _ in range(CALLS):
        function(*arguments)


def _clock(parts: int, function, *arguments) -> float:
    """Return the processor time [s] of a call, divided by its parts."""
    return processor_time(function, *arguments) / parts
