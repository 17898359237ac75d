# SPDX-License-Identifier: Apache-2.0
"""
The field of a long recording as an array that is read when it is looked at.

A part of it (`frames[3:7]`, a mask, places) is again unread; `numpy.asarray` reads. What has to
see every frame takes a block at a time, so that a run of any length fits into memory.
"""

from collections.abc import Iterator

from hydra_actuator.recording.frames import FieldReader
import numpy as np

PRESSURE, VELOCITY = 0, 1
BLOCK = 1024            # frames of an array in memory that are seen at once


class Frames:
    """One quantity of chosen frames, of shape (frames, nodes), read when it is asked for."""

    ndim, dtype = 2, np.dtype(np.float32)

    def __init__(self, reader: FieldReader, quantity: int, chosen: np.ndarray):
        """Take the places of the frames, ascending, and which quantity of theirs."""
        self._reader = reader
        self._quantity = quantity
        self._chosen = chosen
        self.shape = (len(chosen), reader.nodes)

    def __len__(self) -> int:
        return len(self._chosen)

    def __getitem__(self, frames) -> 'Frames':
        """Return the frames of a slice, a mask or ascending places, unread."""
        return Frames(self._reader, self._quantity, self._chosen[frames])

    def __array__(self, dtype=None, copy=None) -> np.ndarray:
        """Read them, float32."""
        result, first = np.empty(self.shape, dtype or self.dtype), 0
        for block in self.blocks():
            result[first: first + len(block)] = block
            first += len(block)
        return result

    def blocks(self) -> Iterator[np.ndarray]:
        """Yield them in order, some at a time."""
        for frames in self._reader.read(self._chosen):
            yield frames[:, :, self._quantity]


def blocks_of(values: 'np.ndarray | Frames') -> Iterator[np.ndarray]:
    """Yield (frames, nodes) values in order, some frames at a time."""
    if isinstance(values, Frames):
        yield from values.blocks()
    else:
        for first in range(0, len(values), BLOCK):
            yield values[first: first + BLOCK]
