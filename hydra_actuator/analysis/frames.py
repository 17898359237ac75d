# SPDX-License-Identifier: Apache-2.0
"""
The field of a long recording as an array that is read when it is looked at.

A part of it (`frames[3:7]`, a mask, places) is again unread; `numpy.asarray` reads. What has to
see every frame takes a block at a time, so that a run of any length fits into memory.
"""

from collections.abc import Iterator
from typing import Protocol

import numpy as np

PRESSURE, VELOCITY = 0, 1
BLOCK = 1024            # frames of an array in memory that are seen at once


class FrameSource(Protocol):
    """What frames are read from: a recording."""

    def field_frames(self, chosen: np.ndarray | None = None) -> Iterator[np.ndarray]:
        """Yield frames (some, nodes, 2) at a time, those at ascending places."""


class Frames:
    """One quantity of chosen frames, of shape (frames, nodes), read when it is asked for."""

    ndim, dtype = 2, np.dtype(np.float32)

    def __init__(self, source: FrameSource, quantity: int, chosen: np.ndarray, nodes: int):
        self._source = source
        self._quantity = quantity
        self._chosen = chosen
        self.shape = (len(chosen), nodes)

    def __len__(self) -> int:
        return len(self._chosen)

    def __getitem__(self, frames) -> 'Frames':
        """Return the frames of a slice, a mask or ascending places, unread."""
        return Frames(self._source, self._quantity, self._chosen[frames], self.shape[1])

    def __array__(self, dtype=None, copy=None) -> np.ndarray:
        """Read them, float32."""
        result, first = np.empty(self.shape, dtype or self.dtype), 0
        for block in self.blocks():
            result[first: first + len(block)] = block
            first += len(block)
        return result

    def blocks(self) -> Iterator[np.ndarray]:
        """Yield them in order, some at a time."""
        for frames in self._source.field_frames(self._chosen):
            yield frames[:, :, self._quantity]


def blocks_of(values: 'np.ndarray | Frames') -> Iterator[np.ndarray]:
    """Yield (frames, nodes) values in order, some frames at a time."""
    if isinstance(values, Frames):
        yield from values.blocks()
    else:
        for first in range(0, len(values), BLOCK):
            yield values[first: first + BLOCK]
