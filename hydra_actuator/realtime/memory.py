# SPDX-License-Identifier: Apache-2.0
"""Rows of ticks and frames of the field in a ring of arrays: one writes, one reads."""

from typing import NamedTuple

import numpy as np

WRITTEN = np.dtype([('ticks', np.int64), ('frames', np.int64)], align=True)
TICK = np.dtype([
    ('number', np.int64), ('stamp', np.int64), ('tick', np.int64), ('spool_1', np.float64),
    ('spool_2', np.float64), ('load_force', np.float64)], align=True)
FRAME = np.dtype([('stamp', np.int64), ('time', np.float64)], align=True)


class Memory(NamedTuple):
    """
    What the writer fills.

    written (1,): how many entries so far; ticks (N,) of TICK with rows (N, width); frames (M,)
    of FRAME with fields (M, nodes, 2).
    """

    written: np.ndarray
    ticks: np.ndarray
    rows: np.ndarray
    frames: np.ndarray
    fields: np.ndarray


def empty_memory(width: int, nodes: int, length: int, frames: int) -> Memory:
    """Return memory for so many ticks of rows of a width, and frames of so many nodes."""
    return Memory(
        np.zeros(1, WRITTEN), np.zeros(length, TICK), np.zeros((length, width)),
        np.zeros(frames, FRAME), np.zeros((frames, nodes, 2), np.float32))


def fill_tick(memory, number, stamp, tick, inputs):
    """Describe the next tick, not yet counted as written; return its slot, for the row."""
    slot = memory.written[0]['ticks'] % memory.ticks.size
    entry = memory.ticks[slot]
    entry['number'], entry['stamp'], entry['tick'] = number, stamp, tick
    entry['spool_1'], entry['spool_2'], entry['load_force'] = inputs[0], inputs[1], inputs[2]
    return slot


def fill_frame(memory, stamp, time):
    """Say of what instant the next frame is, not yet counted as written."""
    entry = memory.frames[memory.written[0]['frames'] % memory.frames.size]
    entry['stamp'], entry['time'] = stamp, time


def frame_is_due(share, number):
    """Tell whether the row of that number comes with a frame; share: frames per tick, to 1."""
    if share <= 0.0:
        return False
    return number == 0 or int(number * share) != int((number - 1) * share)
