# SPDX-License-Identifier: Apache-2.0
"""
Fewer points for a picture, without losing an extreme.

A line keeps, of every bucket of neighbouring samples, the lowest and the highest one where they
stood: no value is averaged or moved, so a spike of a single sample stays in the picture at its
instant. A field over time is reduced to two, the lowest and the highest of every bucket.
Neglected: what happens between the extremes of one bucket.
"""

from hydra_actuator.analysis.frames import blocks_of, Frames
import numpy as np


def extreme_samples(values: np.ndarray, buckets: int) -> np.ndarray:
    """
    Return the indices of samples that show a line of (n,) values in some 2 x buckets points.

    Sorted, without duplicates; the first and the last sample, the lowest and the highest of every
    bucket and one NaN of every bucket that has one (a gap stays a gap). All indices if there are
    no more than 2 x buckets.
    """
    count = len(values)
    if count <= 2 * buckets:
        return np.arange(count)
    size = -(-count // buckets)
    rows = -(-count // size)
    padded = np.pad(np.asarray(values, dtype=float), (0, rows * size - count), mode='edge')
    grid = padded.reshape(rows, size)
    starts = np.arange(rows) * size
    gaps = np.isnan(grid)
    chosen = [
        starts + np.where(gaps, np.inf, grid).argmin(axis=1),
        starts + np.where(gaps, -np.inf, grid).argmax(axis=1),
        (starts + gaps.argmax(axis=1))[gaps.any(axis=1)],
        [0, count - 1],
    ]
    return np.unique(np.minimum(np.concatenate(chosen), count - 1))


def line_samples(values: np.ndarray, budget: int, full_from: int) -> np.ndarray:
    """
    Return the indices that show a line in some `budget` points: all from `full_from` on.

    The part that is on view first keeps its full rate; the rest keeps its extremes. If the full
    part alone exceeds half the budget, it is decimated like the rest.
    """
    count = len(values)
    if count <= budget:
        return np.arange(count)
    if count - full_from > budget // 2:
        return extreme_samples(values, budget // 2)
    head = extreme_samples(values[:full_from], (budget - (count - full_from)) // 2)
    return np.concatenate([head, np.arange(full_from, count)])


def bucket_extremes(
    values: np.ndarray | Frames, buckets: int
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """
    Return (first indices, lowest, highest) of (frames, nodes) values over buckets of frames.

    NaN counts only where a whole bucket has nothing else.
    """
    frames, nodes = values.shape
    count = min(buckets, frames)
    starts = (np.arange(count) * frames) // max(count, 1)
    lowest, highest = np.full((2, count, nodes), np.nan, values.dtype)
    first = 0
    for block in blocks_of(values):
        end = first + len(block)
        # The bucket that this block begins in, and those that begin in it.
        mine = slice(int(np.searchsorted(starts, first, 'right')) - 1,
                     int(np.searchsorted(starts, end)))
        inside = np.maximum(starts[mine] - first, 0)
        lowest[mine] = np.fmin(lowest[mine], np.fmin.reduceat(block, inside, axis=0))
        highest[mine] = np.fmax(highest[mine], np.fmax.reduceat(block, inside, axis=0))
        first = end
    return starts, lowest, highest
