# SPDX-License-Identifier: Apache-2.0
"""
The messages of one topic, as arrays where they allow it.

The messages of a running actuator have one layout from first to last, numbers at their ends:
such a topic is gathered into one matrix of bytes and seen as numbers, without decoding a
message. Any other topic is decoded message by message.
"""

from collections.abc import Iterator
from functools import cached_property

from hydra_actuator.recording import messages
from hydra_actuator.recording.cdr import Codec, HEADER
from hydra_actuator.recording.errors import RecordingError
from hydra_actuator.recording.scan import Chunk
from mcap.opcode import Opcode
import numpy as np

_HEAD = np.dtype([
    ('opcode', 'u1'), ('length', '<u8'), ('channel', '<u2'), ('sequence', '<u4'),
    ('log', '<u8'), ('publish', '<u8'),
])
_REST_OF_HEAD = _HEAD.itemsize - 9

# Above this size [byte] copying message by message is faster than gathering byte by byte.
_LARGE = 256


class Series:
    """All messages of one topic in the order of the file."""

    def __init__(self, topic: str, type_name: str, definition: str):
        self.topic = topic
        self.type = type_name
        self._definition = definition
        self._parts: list[tuple[np.ndarray, np.ndarray]] = []

    def __len__(self) -> int:
        return sum(len(offsets) for _, offsets in self._parts)

    def add(self, chunk: Chunk, channel: int) -> None:
        """Append the messages a chunk holds for a channel."""
        if channel in chunk.offsets:
            offsets = chunk.offsets[channel]
            if offsets.max() > len(chunk.content) - _HEAD.itemsize:
                raise RecordingError(f'damaged: the index of {self.topic} points nowhere')
            self._parts.append((chunk.content, offsets))

    @cached_property
    def stamps(self) -> np.ndarray:
        """Log times [ns], int64."""
        return self._heads['log'].astype(np.int64)

    @cached_property
    def publish_stamps(self) -> np.ndarray:
        """Publish times [ns], int64."""
        return self._heads['publish'].astype(np.int64)

    def payloads(self) -> Iterator[bytes]:
        """Yield the messages as they were recorded."""
        sizes = iter(self._sizes.tolist())
        for content, offsets in self._parts:
            for start in (offsets + _HEAD.itemsize).tolist():
                yield content[start: start + next(sizes)].tobytes()

    def decoded(self) -> Iterator[dict]:
        """Yield the messages as dictionaries."""
        decode = Codec(self.type, self._definition).decode
        return map(decode, self.payloads())

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
        if not len(self):
            return np.empty((0, 0))
        one_layout = self._numbers_of_one_layout()
        return self._numbers_one_by_one() if one_layout is None else one_layout

    @cached_property
    def _heads(self) -> np.ndarray:
        parts = [_gather(content, offsets, _HEAD.itemsize) for content, offsets in self._parts]
        joined = np.concatenate(parts) if parts else np.empty((0, _HEAD.itemsize), np.uint8)
        heads = joined.view(_HEAD)[:, 0]
        if (heads['opcode'] != Opcode.MESSAGE).any():
            raise RecordingError(f'damaged: the index of {self.topic} points beside its messages')
        return heads

    @cached_property
    def _sizes(self) -> np.ndarray:
        return self._heads['length'].astype(np.int64) - _REST_OF_HEAD

    def _matrix(self) -> np.ndarray | None:
        """Return the messages as bytes (count, size), or None if their sizes differ."""
        sizes = self._sizes
        if (sizes != sizes[0]).any():
            return None
        return np.concatenate([
            _gather(content, offsets + _HEAD.itemsize, int(sizes[0]))
            for content, offsets in self._parts
        ])

    def _numbers_of_one_layout(self) -> np.ndarray | None:
        """Return the numbers if all messages differ in nothing but stamps and numbers."""
        first = self.first()
        blocks = _number_blocks(self.type, first)
        matrix = self._matrix() if blocks else None
        if matrix is None or matrix[0, :4].tobytes() != HEADER:
            return None
        kind, places = blocks
        size = matrix.shape[1]
        same = self._meant(first, size)
        same[4: 12 if 'header' in first else 4] = False
        columns = []
        for from_end, count in places:
            block = slice(size - from_end, size - from_end + count * kind.itemsize)
            same[block] = False
            columns.append(np.ascontiguousarray(matrix[:, block]).view(kind))
        numbers = np.concatenate(columns, axis=1)
        if (matrix[:, same] != matrix[0, same]).any():
            return None
        expected = _numbers(self.type, first)
        return numbers if np.array_equal(numbers[0], expected, equal_nan=True) else None

    def _meant(self, message: dict, size: int) -> np.ndarray:
        """Return which bytes of a message of this size are not padding."""
        codec = Codec(self.type, self._definition)
        zeros, ones = (
            np.frombuffer(codec.encode(message, padding), np.uint8)[:size] for padding in (0, 255)
        )
        meant = np.zeros(size, bool)
        meant[: len(zeros)] = zeros == ones
        return meant

    def _numbers_one_by_one(self) -> np.ndarray:
        rows = [_numbers(self.type, message) for message in self.decoded()]
        result = np.full((len(rows), max(map(len, rows))), np.nan)
        for target, row in zip(result, rows):
            target[: len(row)] = row
        return result


def _gather(content: np.ndarray, starts: np.ndarray, size: int) -> np.ndarray:
    """Return the bytes (count, size) that begin at each start."""
    if size <= _LARGE:
        return content[starts[:, None] + np.arange(size)]
    joined = b''.join([content[start: start + size].tobytes() for start in starts.tolist()])
    return np.frombuffer(joined, np.uint8).reshape(len(starts), size)


def _number_blocks(
    type_name: str, first: dict
) -> tuple[np.dtype, list[tuple[int, int]]] | None:
    """Return the number type and its blocks (bytes from the message's end, count)."""
    double, single = np.dtype('<f8'), np.dtype('<f4')
    if type_name == messages.FLOAT64:
        return double, [(8, 1)]
    if type_name == messages.FLUID_PRESSURE:
        return double, [(16, 2)]
    if type_name in (messages.FLOAT64_ARRAY, messages.FLOAT32_ARRAY):
        kind = double if type_name == messages.FLOAT64_ARRAY else single
        count = len(first['data'])
        return (kind, [(kind.itemsize * count, count)]) if count else None
    if type_name == messages.JOINT_STATE:
        count = len(first['name'])
        full = all(len(first[part]) == count for part in ('position', 'velocity', 'effort'))
        places = [(24 * count + 16, count), (16 * count + 8, count), (8 * count, count)]
        return (double, places) if full and count else None
    return None


def _numbers(type_name: str, message: dict) -> list[float]:
    """Return the numbers of one decoded message."""
    if type_name == messages.JOINT_STATE:
        return [*message['position'], *message['velocity'], *message['effort']]
    if type_name == messages.FLUID_PRESSURE:
        return [message['fluid_pressure'], message['variance']]
    if type_name == messages.FLOAT64:
        return [message['data']]
    if type_name in (messages.FLOAT64_ARRAY, messages.FLOAT32_ARRAY):
        return message['data']
    raise TypeError(f'{type_name} is not made of numbers alone')
