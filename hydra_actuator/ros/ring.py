# SPDX-License-Identifier: Apache-2.0
"""
Memory between the solver's thread and the publishing thread: one writes, one reads.

All of it is allocated beforehand. In real time the writer never looks at the reader; a reader
that falls behind by more than the length loses the oldest entries, and counts them. A writer with
time asks `has_room` first, and loses none.
"""

from collections.abc import Callable, Iterator
import threading
from typing import NamedTuple

import numpy as np


class Tick(NamedTuple):
    """
    One tick as it was solved.

    number: rows since simulated time began; a row shown again has its number again; stamp [ns];
    tick: of the simulation, at its begin; inputs: (spool 1, spool 2, load [N]) held during it;
    row: the observation at its end.
    """

    number: int
    stamp: int
    tick: int
    inputs: list[float]
    row: list[float]


class Frame(NamedTuple):
    """The whole field at one instant: stamp [ns], simulated time [s], (nodes, 2) values."""

    stamp: int
    time: float
    values: np.ndarray


class Ring:
    """Rows of ticks and frames of the field, with a signal that there are new ones."""

    def __init__(self, width: int, nodes: int, length: int = 4096, frames: int = 256):
        """Take the width of a row and the number of nodes of the field."""
        self._numbers = np.zeros(length, np.int64)
        self._stamps = np.zeros(length, np.int64)
        self._ticks = np.zeros(length, np.int64)
        self._inputs = np.zeros((length, 3))
        self._rows = np.zeros((length, width))
        self._field_stamps = np.zeros(frames, np.int64)
        self._field_times = np.zeros(frames)
        self._field = np.zeros((frames, nodes, 2), np.float32)
        self._written = self._read = 0
        self._frames_written = self._frames_read = 0
        self._news = threading.Lock()
        self._news.acquire()
        self._taken = threading.Condition()
        self.lost = 0

    def push(
        self, number: int, stamp: int, tick: int, inputs: tuple[float, ...], row: np.ndarray
    ) -> None:
        """Add a tick; for the writer only."""
        slot = self._written % len(self._stamps)
        self._numbers[slot] = number
        self._stamps[slot] = stamp
        self._ticks[slot] = tick
        self._inputs[slot] = inputs
        self._rows[slot] = row
        self._written += 1

    def frame(self) -> np.ndarray:
        """Return the place for the next frame's values; for the writer only."""
        return self._field[self._frames_written % len(self._field)]

    def push_frame(self, stamp: int, time: float) -> None:
        """Add the frame whose values were put into `frame()`; for the writer only."""
        slot = self._frames_written % len(self._field)
        self._field_stamps[slot] = stamp
        self._field_times[slot] = time
        self._frames_written += 1

    def signal(self) -> None:
        """Wake the reader; costs the writer no wait."""
        if self._news.locked():
            self._news.release()

    def has_room(self, timeout: float) -> bool:
        """Wait until at most half of it is unread, at most `timeout` [s]; tell whether it is."""
        return self._wait_for(lambda: 2 * (self._written - self._read) <= len(self._stamps) and (
            2 * (self._frames_written - self._frames_read) <= len(self._field)), timeout)

    def is_read(self, timeout: float) -> bool:
        """
        Wait until all that is there now is read, at most `timeout` [s]; tell whether it is so.

        What is added meanwhile does not count: a reader that lags by a few ticks is never done.
        """
        ticks, frames = self._written, self._frames_written
        return self._wait_for(
            lambda: self._read >= ticks and self._frames_read >= frames, timeout)

    def wait(self, timeout: float) -> None:
        """Wait until signalled, at most `timeout` [s]; for the reader only."""
        self._news.acquire(timeout=timeout)

    def ticks(self) -> Iterator[Tick]:
        """Take the ticks that are new; for the reader only."""
        end, length = self._written, len(self._stamps)
        # The oldest slot may be written over while it is read: it counts as lost already.
        first = max(self._read, end - length + 1)
        self.lost += first - self._read
        for place in range(first, end):
            slot = place % length
            yield Tick(
                int(self._numbers[slot]), int(self._stamps[slot]), int(self._ticks[slot]),
                self._inputs[slot].tolist(), self._rows[slot].tolist(),
            )
        with self._taken:
            self._read = end
            self._taken.notify_all()

    def frames(self) -> Iterator[Frame]:
        """Take the frames that are new; the values are good until the ring has gone round."""
        end, length = self._frames_written, len(self._field)
        for number in range(max(self._frames_read, end - length + 1), end):
            slot = number % length
            yield Frame(
                int(self._field_stamps[slot]), float(self._field_times[slot]), self._field[slot])
        with self._taken:
            self._frames_read = end
            self._taken.notify_all()

    def _wait_for(self, reached: Callable[[], bool], timeout: float) -> bool:
        if reached():
            return True
        with self._taken:
            return self._taken.wait_for(reached, timeout)
