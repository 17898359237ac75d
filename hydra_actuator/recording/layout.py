# SPDX-License-Identifier: Apache-2.0
"""
The numbers of messages that differ in nothing but stamps and numbers, without decoding them.

Numbers stand at the end of the messages of a running actuator. A layout is taken from one message,
which is decoded and encoded again to tell which of its bytes are stamps, numbers or padding; of
any other message all remaining bytes must be the same.
"""

from itertools import groupby

from hydra_actuator.recording import messages
from hydra_actuator.recording.cdr import Codec, HEADER
import numpy as np


def gather(content: np.ndarray, starts: np.ndarray, size: int) -> np.ndarray:
    """Return the bytes (count, size) that begin at each start; IndexError beyond the end."""
    if not len(starts) or not size:
        return np.empty((len(starts), size), np.uint8)
    # One item per place of the content, overlapping: taking some copies each in one piece.
    items = np.ndarray((max(len(content) - size + 1, 0),), f'V{size}', content, 0, (1,))
    return items[starts].view(np.uint8).reshape(len(starts), size)


class Layout:
    """Where the numbers stand in messages of one size, `count` of a `kind` in each."""

    def __init__(self, kind: np.dtype, places: list[slice], model: np.ndarray, meant: np.ndarray):
        """Take the slices of numbers in a model message, and which of its bytes are fixed."""
        self.kind = kind
        self.size = len(model)
        self.count = sum(part.stop - part.start for part in places) // kind.itemsize
        self._places = places
        self._fixed = [(part, model[part].copy()) for part in _runs(meant)]

    @classmethod
    def of(cls, type_name: str, codec: Codec, payload: bytes) -> 'Layout | None':
        """Return the layout of a message, or None for one that has to be decoded."""
        message, size = codec.decode(payload), len(payload)
        blocks = _number_blocks(type_name, message)
        if blocks is None or payload[:4] != HEADER:
            return None
        kind, ends = blocks
        places = [slice(size - end, size - end + count * kind.itemsize) for end, count in ends]
        meant = _meant(codec, message, size)
        meant[4: 12 if 'header' in message else 4] = False
        for part in places:
            meant[part] = False
        model = np.frombuffer(payload, np.uint8)
        layout = cls(kind, places, model, meant)
        expected = numbers_of(type_name, message)
        found = layout.numbers(model, np.zeros(1, np.int64))
        return layout if np.array_equal(found[0], expected, equal_nan=True) else None

    def numbers(self, content: np.ndarray, starts: np.ndarray) -> np.ndarray | None:
        """Return the numbers (messages, count) that start there; None if one is different."""
        rows = gather(content, starts, self.size)
        if any((rows[:, part] != model).any() for part, model in self._fixed):
            return None
        parts = [np.ascontiguousarray(rows[:, part]).view(self.kind) for part in self._places]
        return parts[0] if len(parts) == 1 else np.concatenate(parts, axis=1)


def numbers_of(type_name: str, message: dict) -> list[float]:
    """Return the numbers of one decoded message; TypeError for a type with anything else."""
    if type_name == messages.JOINT_STATE:
        return [*message['position'], *message['velocity'], *message['effort']]
    if type_name == messages.FLUID_PRESSURE:
        return [message['fluid_pressure'], message['variance']]
    if type_name == messages.FLOAT64:
        return [message['data']]
    if type_name in (messages.FLOAT64_ARRAY, messages.FLOAT32_ARRAY):
        return message['data']
    raise TypeError(f'{type_name} is not made of numbers alone')


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


def _meant(codec: Codec, message: dict, size: int) -> np.ndarray:
    """Return which bytes of a message of this size are not padding."""
    zeros, ones = (
        np.frombuffer(codec.encode(message, padding), np.uint8)[:size] for padding in (0, 255)
    )
    meant = np.zeros(size, bool)
    meant[: len(zeros)] = zeros == ones
    return meant


def _runs(meant: np.ndarray) -> list[slice]:
    """Return the runs of True as slices."""
    found = []
    for value, places in groupby(range(len(meant)), key=meant.__getitem__):
        if value:
            first, *rest = places
            found.append(slice(first, (rest[-1] if rest else first) + 1))
    return found
