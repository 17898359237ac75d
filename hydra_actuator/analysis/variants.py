# SPDX-License-Identifier: Apache-2.0
"""
The same figures in several units as one: what differs stands there once for each.

    figures in MPa, in bar, in Pa, ...  ->  figures with Choice and Rescaled in them

Units are scales, so an array in other units is the first one times a factor plus an offset, and
travels once. Where that does not hold (it need not, of what a figure makes of its values), each
travels. Knows nothing of what is drawn.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

from hydra_actuator.analysis.figure import Figure
import numpy as np

# What 32-bit numbers and the steps of a page lose, of the largest value and of the range.
OF_VALUE, OF_RANGE = 1e-6, 1e-5


@dataclass(frozen=True)
class Choice:
    """A value for each of the units."""

    values: tuple


@dataclass(frozen=True)
class Rescaled:
    """An array in the first units, and (factor, offset) that give it in each of the units."""

    array: np.ndarray
    scales: tuple[tuple[float, float], ...]


def merged(variants: Sequence[Sequence[Figure]]) -> list[Figure]:
    """
    Return figures that hold all variants; each of `variants` has the same figures in its order.

    Words around a figure are those of the first variant.
    """
    return [_merged_figure(figures) for figures in zip(*variants, strict=True)]


def _merged_figure(figures: Sequence[Figure]) -> Figure:
    first = figures[0]
    if len({one.missing for one in figures}) > 1:
        raise ValueError(f'{first.key} is missing in some units only')
    return replace(first, **{
        part: _merge([getattr(one, part) for one in figures])
        for part in ('traces', 'layout', 'frames')})


def _merge(values: Sequence):
    """Return one value that holds all."""
    first = values[0]
    if isinstance(first, np.ndarray):
        return _merge_arrays(values)
    if isinstance(first, dict) and all(one.keys() == first.keys() for one in values):
        return {key: _merge([one[key] for one in values]) for key in first}
    if isinstance(first, (list, tuple)) and all(len(one) == len(first) for one in values):
        return [_merge(parts) for parts in zip(*values)]
    return first if all(one == first for one in values) else Choice(tuple(values))


def _merge_arrays(arrays: Sequence[np.ndarray]):
    scales = [scale_between(arrays[0], one) for one in arrays]
    if None in scales:
        return Choice(tuple(arrays))
    if all(scale == (1.0, 0.0) for scale in scales):
        return arrays[0]
    return Rescaled(arrays[0], tuple(scales))


def scale_between(array: np.ndarray, other: np.ndarray) -> tuple[float, float] | None:
    """Return (factor, offset) with other = factor array + offset; None if there are none."""
    if array.shape != other.shape:
        return None
    if array is other or np.array_equal(array, other, equal_nan=array.dtype.kind == 'f'):
        return 1.0, 0.0
    known = np.isfinite(array)
    if not np.array_equal(known, np.isfinite(other)) or not known.any():
        return None
    mine, theirs = array[known].astype(float), other[known].astype(float)
    low, high = int(mine.argmin()), int(mine.argmax())
    span = mine[high] - mine[low]
    factor = float((theirs[high] - theirs[low]) / span) if span else 1.0
    offset = float(theirs[low] - factor * mine[low])
    allowed = OF_VALUE * np.abs(theirs).max() + OF_RANGE * np.ptp(theirs)
    wrong = np.abs(factor * mine + offset - theirs).max() > allowed
    return None if wrong else (factor, offset)
