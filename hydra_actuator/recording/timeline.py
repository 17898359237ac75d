# SPDX-License-Identifier: Apache-2.0
"""
Which step of the solver a recorded state belongs to.

Stamps in simulated time are steps since the first. In real time they hold slip and pauses as
well: what was applied, and the field, say at some stamps which step it was, and between two of
these a state is counted from whichever holds; where they disagree, the step from one to the other
lies at the widest gap between states. A tick that is no later than the one before is a reset, and
begins a new piece.
"""

from dataclasses import dataclass

from hydra_actuator.recording.errors import RecordingError
from hydra_actuator.recording.reader import Recording
import numpy as np

# A stamp this far from a tick [ticks] is not counted from there.
_NEAR = 0.02


@dataclass(frozen=True)
class Piece:
    """
    States (N,) from one initial state on, and what was applied.

    stamps [ns] and steps of the states, in their order; changes: steps (M,) from which on the
    inputs (M, 3: spool 1, spool 2, load [N]) hold.
    """

    stamps: np.ndarray
    steps: np.ndarray
    changes: np.ndarray
    inputs: np.ndarray


def pieces(recording: Recording, step_time: float, steps_per_tick: int) -> list[Piece]:
    """Return the pieces of a run; RecordingError where it does not begin with the first tick."""
    stamps, applied = recording.applied
    if not len(stamps):
        raise RecordingError(f'{recording.path} does not say what was applied')
    if applied[0, 0] != 0.0:
        raise RecordingError(
            f'{recording.path} begins with tick {applied[0, 0]:.0f}, not at the initial state')
    ticks = applied[:, 0].astype(np.int64)
    inputs = np.column_stack([applied[:, 1], applied[:, -2], applied[:, -1]])
    # Inputs that change before the first step stand at tick 0 twice, at one stamp.
    later = np.diff(stamps) > 0.5e9 * step_time * steps_per_tick
    begins = np.flatnonzero(np.append(True, later & (np.diff(ticks) <= 0)))
    states = np.unique(recording.row_stamps)
    found = []
    for begin, end in zip(begins, [*begins[1:], len(ticks)]):
        last = stamps[end] if end < len(stamps) else np.iinfo(np.int64).max
        own = states[(states >= stamps[begin]) & (states < last)]
        steps = _steps(recording, own, (stamps[begin:end], ticks[begin:end]),
                       (step_time, steps_per_tick))
        found.append(Piece(own, steps, ticks[begin:end] * steps_per_tick, inputs[begin:end]))
    return found


def _steps(
    recording: Recording, states: np.ndarray, anchors: tuple[np.ndarray, np.ndarray],
    grid: tuple[float, int],
) -> np.ndarray:
    """Return the step of each state."""
    step_time, steps_per_tick = grid
    if recording.custom_data.get('source') == 'simulate':
        return np.round((states - anchors[0][0]) * 1e-9 / step_time).astype(np.int64)
    period_ns = step_time * steps_per_tick * 1e9
    stamps, ticks = _with_field(recording, states, anchors, period_ns)
    return _ticks(states, stamps, ticks, period_ns) * steps_per_tick


def _with_field(
    recording: Recording, states: np.ndarray, anchors: tuple[np.ndarray, np.ndarray],
    period_ns: float,
) -> tuple[np.ndarray, np.ndarray]:
    """Return the anchors and those that the field gives in addition, by their stamps."""
    name = next((name for name in recording.topics if name.endswith('/field')), '')
    if not name or not recording.topics[name].count or not len(states):
        return anchors
    series = recording.series(name)
    at = (series.stamps >= states[0]) & (series.stamps <= states[-1])
    ticks = np.round(series.numbers()[at, 0].astype(float) * 1e9 / period_ns).astype(np.int64)
    stamps = np.append(anchors[0], series.stamps[at])
    order = np.argsort(stamps, kind='stable')
    return stamps[order], np.append(anchors[1], ticks)[order]


def _ticks(
    states: np.ndarray, stamps: np.ndarray, ticks: np.ndarray, period_ns: float
) -> np.ndarray:
    """Return the tick of each state, from the anchors before and after it."""
    before = np.searchsorted(stamps, states, 'right') - 1
    after = np.minimum(before + 1, len(stamps) - 1)
    by_before = ticks[before] + (states - stamps[before]) / period_ns
    by_after = ticks[after] - (stamps[after] - states) / period_ns
    result = np.round(by_before).astype(np.int64)
    unsure = np.abs(by_before - by_after) > _NEAR
    for anchor in np.unique(before[unsure]):
        if anchor == len(stamps) - 1:
            continue
        places = np.flatnonzero(before == anchor)
        edges = np.concatenate([[stamps[anchor]], states[places], [stamps[anchor + 1]]])
        gap = int(np.argmax(np.diff(edges)))
        result[places[gap:]] = np.round(by_after[places[gap:]])
    return result
