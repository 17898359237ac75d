# SPDX-License-Identifier: Apache-2.0
"""The chunks of an MCAP file that may be damaged anywhere: found by their shape, read if sound."""

from collections.abc import Iterator
from pathlib import Path
import struct
import zlib

from hydra_actuator.recording.errors import RecordingError
from hydra_actuator.recording.scan import CHUNK_HEAD, decompressed, RECORD_HEAD, records
from mcap.opcode import Opcode
import numpy as np

_COMPRESSIONS = {b'': '', b'lz4': 'lz4', b'zstd': 'zstd'}
# The head of a chunk without a record in it [byte].
SMALLEST = RECORD_HEAD.size + CHUNK_HEAD.size + 8
_BLOCK = 1 << 22


def mapped(path: Path) -> np.ndarray:
    """Return the bytes of a file without reading them; RecordingError if it cannot be read."""
    try:
        return np.memmap(path, np.uint8, 'r') if path.stat().st_size else np.empty(0, np.uint8)
    except (OSError, ValueError) as error:
        raise RecordingError(f'{path} cannot be read: {error}') from None


def chunk_records(content: np.ndarray, start: int, stop: int) -> np.ndarray | None:
    """Return the records of the chunk between two places, or None if it is not sound."""
    body = content[start + RECORD_HEAD.size: stop]
    *_, size, crc, length = CHUNK_HEAD.unpack_from(body)
    at = CHUNK_HEAD.size + length
    name = body[CHUNK_HEAD.size: at].tobytes()
    try:
        found = decompressed(_COMPRESSIONS[name], body[at + 8:], size)
    except RecordingError:
        return None
    return found if crc and len(found) == size and zlib.crc32(found) == crc else None


def chunk_messages(content: np.ndarray) -> Iterator[tuple[int, int, int, int, np.ndarray]]:
    """Yield (channel, sequence, log time [ns], publish time [ns], bytes) of a chunk's records."""
    for opcode, start, stop in records(content, 0):
        if opcode == Opcode.MESSAGE:
            yield *struct.unpack_from('<HIQQ', content, start), content[start + 22: stop]


def heads(content: np.ndarray, at: int) -> Iterator[tuple[int, int]]:
    """Yield (start, stop) of whatever has the head of a chunk; the stop may be out of reach."""
    while at < len(content):
        block = content[at: at + _BLOCK + RECORD_HEAD.size]
        places = np.flatnonzero(block[:_BLOCK] == Opcode.CHUNK)
        reachable = places[places + RECORD_HEAD.size <= len(block)]
        # No chunk is longer than 2^40 bytes.
        small = ~(block[reachable + 6] | block[reachable + 7] | block[reachable + 8]).astype(bool)
        for start in (at + reachable[small]).tolist():
            stop = _chunk_end(content, start)
            if stop is not None:
                yield start, stop
        at += _BLOCK


def _chunk_end(content: np.ndarray, start: int) -> int | None:
    """Return where a chunk that starts here would end, or None if its head contradicts itself."""
    if start + SMALLEST > len(content):
        return None
    _, length = RECORD_HEAD.unpack_from(content, start)
    *_, size, _, name_length = CHUNK_HEAD.unpack_from(content, start + RECORD_HEAD.size)
    at = start + RECORD_HEAD.size + CHUNK_HEAD.size + name_length
    if name_length > 4 or at + 8 > len(content):
        return None
    name = content[at - name_length: at].tobytes()
    (data,) = struct.unpack_from('<Q', content, at)
    if name not in _COMPRESSIONS or length != CHUNK_HEAD.size + name_length + 8 + data:
        return None
    return None if name == b'' and data != size else at + 8 + data
