# SPDX-License-Identifier: Apache-2.0
"""All of a study about one operating point: responses, modes, gains, valve, by each method."""

from collections.abc import Callable
import math
from typing import NamedTuple

from hydra_actuator.errors import InputError
from hydra_actuator.response.distributed import (
    linear_plant,
    Plant,
    respond,
    Responses,
    spool_dynamics,
)
from hydra_actuator.response.lumped import (
    Lumped,
    lumped_modes,
    lumped_plant,
    respond_lumped,
    textbook_mode,
)
from hydra_actuator.response.modes import find_modes, Mode
from hydra_actuator.response.operating_point import OperatingPoint
from hydra_actuator.response.position_loop import largest_gain
from hydra_actuator.response.valve_curves import Bench, null_figures, NullFigures
import numpy as np

# Frequencies of the solver's sines, and below which they would take long [Hz].
SOLVER_POINTS, SOLVER_LOWEST = 12, 5.0
# Relative change with the amplitude from which the solver's response is not linear.
LINEAR = 1e-3


class Study(NamedTuple):
    """
    What came out; `solver*` are None where it was not asked for or cannot be driven.

    modes: of the distributed plant, lowest first; mode, lumped_mode, solver_mode: the one nearest
    to the textbook's; gains: largest of a position loop, distributed and lumped [m/m].
    """

    point: OperatingPoint
    plant: Plant
    lumped_plant: Lumped
    distributed: Responses
    dynamics: np.ndarray
    lumped: Responses
    solver: Responses | None
    modes: list[Mode]
    textbook: Mode | None
    mode: Mode | None
    lumped_mode: Mode | None
    solver_mode: Mode | None
    linearity: float | None
    gains: tuple[float, float]
    bench: Bench
    null: NullFigures
    notes: tuple[str, ...]


def study(point: OperatingPoint, frequencies: np.ndarray, solver: bool = True,
          progress: Callable[[float], None] = lambda share: None) -> Study:
    """Return the study of an operating point over increasing frequencies [Hz]."""
    plant = linear_plant(point)
    lumped = lumped_plant(plant)
    distributed, dynamics = respond(plant, frequencies), spool_dynamics(plant, frequencies)
    low = respond_lumped(lumped, frequencies)
    textbook = textbook_mode(lumped)
    modes = find_modes(plant, float(frequencies[-1]))
    driven, rang, linear, notes = None, None, None, list(point.notes)
    if point.velocity != 0.0 and solver:
        notes.append('the solver is left out: it is driven about a piston at rest only')
    elif solver:
        driven, rang, linear = _drive(point, frequencies, textbook, progress)
        if linear > LINEAR:
            notes.append(f'the solver is not linear here: {linear:.2g} between two small sines')
    if not np.abs(plant.valve.gain).any():
        notes.append(_why_idle(plant))
    if (plant.valve.conducts & (plant.valve.resistance == 0.0)).any():
        notes.append('an open edge sees no pressure drop, where its law has no slope: responses '
                     'hold for vanishing amplitudes only, and no lumped plant has them')
    bench = Bench(point.parameters)
    return Study(
        point, plant, lumped, distributed, dynamics, low, driven, modes, textbook,
        _nearest(modes, textbook), _nearest(lumped_modes(lumped), textbook), rang, linear,
        (largest_gain(distributed, dynamics), largest_gain(low, dynamics)), bench,
        null_figures(bench), tuple(notes))


def frequency_grid(low: float, high: float, points: int) -> np.ndarray:
    """Return `points` frequencies [Hz] in equal ratios; raises InputError for a rubbish range."""
    if not 0.0 < low < high < math.inf:
        raise InputError(f'frequencies from {low:g} to {high:g} Hz are no range above 0')
    if points < 3:
        raise InputError(f'{points} points are too few, at least 3')
    return np.geomspace(low, high, points)


def _drive(point: OperatingPoint, frequencies: np.ndarray, textbook: Mode | None,
           progress: Callable[[float], None]) -> tuple:
    from hydra_actuator.response.solver import linearity, solver_mode, solver_responses

    low, high = max(SOLVER_LOWEST, float(frequencies[0])), float(frequencies[-1])
    if low >= high:
        low = 0.5 * high
    chosen = np.geomspace(low, high, SOLVER_POINTS)
    driven = solver_responses(point, chosen, progress)
    rang = solver_mode(point, textbook.frequency) if textbook is not None else None
    middle = chosen[len(chosen) // 2] if textbook is None else textbook.frequency
    return driven, rang, linearity(point, middle)


def _nearest(modes: list[Mode], textbook: Mode | None) -> Mode | None:
    if textbook is None:
        return None
    return min(modes, key=lambda m: abs(math.log(m.frequency / textbook.frequency)), default=None)


def _why_idle(plant: Plant) -> str:
    if plant.valve.overlapped.all():
        return ('the spool lies within the overlap: nothing answers a small motion of it; '
                'take an operating point beyond it with --spool')
    return 'no open edge sees a pressure drop: nothing answers a small motion of the spool'
