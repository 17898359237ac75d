# SPDX-License-Identifier: Apache-2.0
"""
Memory between the solver's thread and the publishing thread: one writes, one reads.

All of it is allocated beforehand. In real time the writer never looks at the reader; a reader
that falls behind by more than the length loses the oldest entries, and counts them. A writer with
time asks `has_room` first, and loses none.
"""

from collections.abc import Callable, Iterator
import os
import select
import threading
from typing import NamedTuple
import weakref

from hydra_actuator.realtime.memory import empty_memory, fill_frame, fill_tick
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
    """
    Rows of ticks and frames of the field, with a signal that there are new ones.

    memory: where they lie; descriptor: the event descriptor that wakes the reader. Compiled code
    may write there in place of this class, but not at the same time.
    """

    def __init__(self, width: int, nodes: int, length: int = 4096, frames: int = 256):
        """Take the width of a row and the number of nodes of the field."""
        self.memory = empty_memory(width, nodes, length, frames)
        self.descriptor = os.eventfd(0, os.EFD_NONBLOCK | os.EFD_CLOEXEC)
        weakref.finalize(self, os.close, self.descriptor)
        self._news = select.poll()
        self._news.register(self.descriptor, select.POLLIN)
        self._written = self.memory.written[0]
        self._read = self._frames_read = 0
        self._taken = threading.Condition()
        self.lost = 0

    def push(
        self, number: int, stamp: int, tick: int, inputs: tuple[float, ...], row: np.ndarray
    ) -> None:
        """Add a tick; for the writer only."""
        slot = fill_tick(self.memory, number, stamp, tick, inputs)
        self.memory.rows[slot] = row
        self._written['ticks'] += 1

    def frame(self) -> np.ndarray:
        """Return the place for the next frame's values; for the writer only."""
        return self.memory.fields[self._written['frames'] % len(self.memory.frames)]

    def push_frame(self, stamp: int, time: float) -> None:
        """Add the frame whose values were put into `frame()`; for the writer only."""
        fill_frame(self.memory, stamp, time)
        self._written['frames'] += 1

    def signal(self) -> None:
        """Wake the reader; costs the writer no wait."""
        os.eventfd_write(self.descriptor, 1)

    def has_room(self, timeout: float) -> bool:
        """Wait until at most half of it is unread, at most `timeout` [s]; tell whether it is."""
        ticks, frames = len(self.memory.ticks), len(self.memory.frames)

        def roomy() -> bool:
            written, frames_written = self._counts()
            return 2 * (written - self._read) <= ticks and (
                2 * (frames_written - self._frames_read) <= frames)
        return self._wait_for(roomy, timeout)

    def is_read(self, timeout: float) -> bool:
        """
        Wait until all that is there now is read, at most `timeout` [s]; tell whether it is so.

        What is added meanwhile does not count: a reader that lags by a few ticks is never done.
        """
        ticks, frames = self._counts()
        return self._wait_for(
            lambda: self._read >= ticks and self._frames_read >= frames, timeout)

    def wait(self, timeout: float) -> None:
        """Wait until signalled, at most `timeout` [s]; for the reader only."""
        if self._news.poll(1000.0 * timeout):
            os.eventfd_read(self.descriptor)

    def ticks(self) -> Iterator[Tick]:
        """Take the ticks that are new; for the reader only."""
        memory = self.memory
        end, length = self._counts()[0], len(memory.ticks)
        # The oldest slot may be written over while it is read: it counts as lost already.
        first = max(self._read, end - length + 1)
        self.lost += first - self._read
        for place in range(first, end):
            slot = place % length
            number, stamp, tick, *inputs = memory.ticks[slot].item()
            yield Tick(number, stamp, tick, inputs, memory.rows[slot].tolist())
        with self._taken:
            self._read = end
            self._taken.notify_all()

    def frames(self) -> Iterator[Frame]:
        """Take the frames that are new; the values are good until the ring has gone round."""
        memory = self.memory
        end, length = self._counts()[1], len(memory.frames)
        for number in range(max(self._frames_read, end - length + 1), end):
            slot = number % length
            yield Frame(*memory.frames[slot].item(), memory.fields[slot])
        with self._taken:
            self._frames_read = end
            self._taken.notify_all()

    def _counts(self) -> tuple[int, int]:
        """Return how many ticks and frames were written."""
        return self._written.item()

    def _wait_for(self, reached: Callable[[], bool], timeout: float) -> bool:
        if reached():
            return True
        with self._taken:
            return self._taken.wait_for(reached, timeout)
