# SPDX-License-Identifier: Apache-2.0
"""
The messages of one topic, as arrays where they allow it.

The messages of a running actuator have one layout from first to last: such a topic is seen as
numbers without decoding a message. Any other topic is decoded message by message. The file is
read block by block, and of a topic no more than was asked for is kept.
"""

from collections.abc import Iterable, Iterator
from functools import cached_property
from heapq import merge
from operator import attrgetter
from typing import NamedTuple

from hydra_actuator.recording.block import Block
from hydra_actuator.recording.cdr import Codec
from hydra_actuator.recording.errors import RecordingError
from hydra_actuator.recording.layout import gather, Layout, numbers_of
from mcap.opcode import Opcode
import numpy as np

_HEAD = np.dtype([
    ('opcode', 'u1'), ('length', '<u8'), ('channel', '<u2'), ('sequence', '<u4'),
    ('log', '<u8'), ('publish', '<u8'),
])
_REST_OF_HEAD = _HEAD.itemsize - 9


class Numbers(NamedTuple):
    """Some messages of a series: stamps [ns], numbers (messages, n), where in the file."""

    series: 'Series'
    stamps: np.ndarray
    numbers: np.ndarray
    place: tuple[int, int]


class Series:
    """All messages of one topic in the order of the file."""

    def __init__(self, topic: str, type_name: str, definition: str):
        self.topic = topic
        self.type = type_name
        self._definition = definition
        self._parts: list[tuple[Block, np.ndarray]] = []

    def __len__(self) -> int:
        return sum(len(offsets) for _, offsets in self._parts)

    def add(self, block: Block, channel: int) -> None:
        """Append the messages a block holds for a channel."""
        if channel in block.offsets:
            offsets = block.offsets[channel]
            if offsets.min() < 0 or offsets.max() > block.size - _HEAD.itemsize:
                raise RecordingError(f'damaged: the index of {self.topic} points nowhere')
            self._parts.append((block, offsets))

    @property
    def stamps(self) -> np.ndarray:
        """Log times [ns], int64."""
        return self._times[0]

    @property
    def publish_stamps(self) -> np.ndarray:
        """Publish times [ns], int64."""
        return self._times[1]

    def payloads(self) -> Iterator[bytes]:
        """Yield the messages as they were recorded."""
        for part in self._read():
            yield from part.payloads()

    def decoded(self) -> Iterator[dict]:
        """Yield the messages as dictionaries."""
        return map(self._codec.decode, self.payloads())

    def first(self) -> dict:
        """Return the first message as a dictionary; StopIteration if there is none."""
        return next(self.decoded())

    def numbers(self) -> np.ndarray:
        """
        Return the numbers of all messages, one row each.

        Float64: the value. Multi-arrays: the data (float32 stays float32 where all messages have
        one layout). FluidPressure: pressure and variance. JointState: all positions, all
        velocities, all efforts. Where a message is shorter than others its row ends in NaN.
        TypeError for any other type.
        """
        layout = self._layout
        if layout is None:
            return _rows([numbers_of(self.type, message) for message in self.decoded()])
        result, first = np.empty((len(self), layout.count), layout.kind), 0
        for part in self._read():
            found = part.numbers(layout)
            if found is None:
                return _rows([numbers_of(self.type, message) for message in self.decoded()])
            result[first: first + len(found)] = found
            first += len(found)
        return result

    def number_blocks(self, chosen: np.ndarray | None = None) -> Iterator['Numbers']:
        """
        Yield the numbers of some messages at a time, of all in the end.

        chosen: places of the messages wanted, ascending. The rows are as long as the first
        message's: longer messages are cut, shorter ones end in NaN.
        """
        if not len(self):
            return
        layout = self._layout
        width = layout.count if layout else len(numbers_of(self.type, self.first()))
        for part in self._read(chosen):
            found = part.numbers(layout) if layout else None
            if found is None:
                found = _rows([numbers_of(self.type, self._codec.decode(payload))
                               for payload in part.payloads()], width)
            yield Numbers(self, part.heads['log'].astype(np.int64), found, part.place)

    @cached_property
    def _codec(self) -> Codec:
        return Codec(self.type, self._definition)

    @cached_property
    def _layout(self) -> Layout | None:
        """The layout of the first message; None if it has none, or there is no message."""
        return Layout.of(self.type, self._codec, next(self.payloads())) if len(self) else None

    @cached_property
    def _times(self) -> np.ndarray:
        """Log and publish times [ns], shape (2, messages)."""
        result, first = np.empty((2, len(self)), np.int64), 0
        for part in self._read():
            last = first + len(part.heads)
            result[0, first:last], result[1, first:last] = part.heads['log'], part.heads['publish']
            first = last
        return result

    def _read(self, chosen: np.ndarray | None = None) -> Iterator['_Part']:
        """Yield the messages block by block; of each nothing may be kept without a copy."""
        before = 0
        for block, offsets in self._parts:
            mine = offsets
            if chosen is not None:
                within = slice(*np.searchsorted(chosen, [before, before + len(offsets)]))
                mine = offsets[chosen[within] - before]
            before += len(offsets)
            if len(mine):
                with block.opened() as content:
                    yield _Part(self.topic, content, mine, block.place)


class _Part:
    """Messages of one topic in one open block."""

    def __init__(self, topic: str, content: np.ndarray, offsets: np.ndarray,
                 place: tuple[int, int]):
        self.place = place
        self._content = content
        self._starts = offsets + _HEAD.itemsize
        self.heads = gather(content, offsets, _HEAD.itemsize).view(_HEAD)[:, 0]
        if (self.heads['opcode'] != Opcode.MESSAGE).any():
            raise RecordingError(f'damaged: the index of {topic} points beside its messages')
        self._sizes = self.heads['length'].astype(np.int64) - _REST_OF_HEAD
        if (self._sizes > len(content) - self._starts).any() or (self._sizes < 0).any():
            raise RecordingError(f'damaged: the index of {topic} points beside its messages')

    def payloads(self) -> Iterator[bytes]:
        for start, size in zip(self._starts.tolist(), self._sizes.tolist()):
            yield self._content[start: start + size].tobytes()

    def numbers(self, layout: Layout) -> np.ndarray | None:
        """Return the numbers, or None if a message has another layout."""
        if (self._sizes != layout.size).any():
            return None
        return layout.numbers(self._content, self._starts)


def in_one_pass(wanted: Iterable[Series]) -> Iterator[Numbers]:
    """Yield the numbers of several topics, reading what they share of a file once."""
    return merge(*(series.number_blocks() for series in wanted), key=attrgetter('place'))


def _rows(found: list[list[float]], width: int | None = None) -> np.ndarray:
    """Return lists of numbers as rows of one width, by default that of the longest."""
    width = max(map(len, found), default=0) if width is None else width
    result = np.full((len(found), width), np.nan)
    for target, row in zip(result, found):
        target[: len(row)] = row[:width]
    return result
