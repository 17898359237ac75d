# SPDX-License-Identifier: Apache-2.0
"""The frames of a recorded field, some at a time: all of a long run are more than memory has."""

from collections.abc import Iterator
from functools import cached_property

from hydra_actuator.recording.series import Series
import numpy as np


class FieldReader:
    """Frames of absolute pressure [Pa] and velocity [m/s], read when they are asked for."""

    def __init__(self, series: Series):
        """Take the messages of the topic of the field."""
        self._series = series

    @cached_property
    def nodes(self) -> int:
        """How many nodes the first frame has; 0 if there is none."""
        return next((frames.shape[1] for frames in self.read(np.zeros(1, int))), 0)

    def read(self, chosen: np.ndarray | None = None) -> Iterator[np.ndarray]:
        """
        Yield (frames, nodes, 2) float32, some frames at a time: all, or those at ascending places.

        A frame is as long as the first one.
        """
        for part in self._series.number_blocks(chosen):
            yield frames_of(part.numbers)


def frames_of(numbers: np.ndarray) -> np.ndarray:
    """Return the messages of a field, their times left out, as (frames, nodes, 2)."""
    values = numbers[:, 1:]
    return values.reshape(len(values), values.shape[1] // 2, 2).astype('f4', copy=False)
