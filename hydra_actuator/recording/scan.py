# SPDX-License-Identifier: Apache-2.0
"""
One MCAP file being read, finished or cut off anywhere.

The file is walked record by record from its start, so it needs no summary; where messages lie in
a chunk is taken from the chunk's indexes, so no message is touched until it is asked for. A chunk
whose indexes are missing or cut off is walked itself. Any writer's file will do, whatever its
chunks, compression and indexes; attachments are skipped.

A cut-off end is no error (`finished` says so); a wrong checksum inside is.
"""

from dataclasses import dataclass, field
from io import BytesIO
from pathlib import Path
import struct
import zlib

from hydra_actuator.recording.errors import RecordingError
from hydra_actuator.recording.segment import MAGIC
from mcap.data_stream import ReadDataStream
from mcap.exceptions import EndOfFile
from mcap.opcode import Opcode
from mcap.records import Channel, Metadata, Schema
import numpy as np

_RECORD = struct.Struct('<BQ')
_CHUNK = struct.Struct('<QQQII')


@dataclass
class Chunk:
    """Records that lie together; `offsets` are those of its messages by channel id."""

    content: np.ndarray
    offsets: dict[int, np.ndarray] = field(default_factory=dict)


@dataclass
class ScannedFile:
    """What a file holds."""

    path: Path
    schemas: dict[int, Schema] = field(default_factory=dict)
    channels: dict[int, Channel] = field(default_factory=dict)
    metadata: dict[str, dict[str, str]] = field(default_factory=dict)
    chunks: list[Chunk] = field(default_factory=list)
    finished: bool = False


def scan(path: Path) -> ScannedFile:
    """Walk a file; RecordingError if it is none, or damaged before its end."""
    try:
        size = path.stat().st_size
        content = np.memmap(path, np.uint8, 'r') if size else np.empty(0, np.uint8)
    except OSError as error:
        raise RecordingError(f'{path} cannot be read: {error.strerror}') from None
    if content[: len(MAGIC)].tobytes() != MAGIC:
        raise RecordingError(f'{path} is not an MCAP file')
    found = ScannedFile(path)
    try:
        _Walk(found, content).run()
    except (struct.error, EndOfFile, UnicodeDecodeError, KeyError) as error:
        raise RecordingError(f'{path} is damaged: {error!r}') from None
    return found


class _Walk:
    """One pass over a file's records, filling a ScannedFile."""

    def __init__(self, found: ScannedFile, content: np.ndarray):
        self._found = found
        self._content = content
        self._outside: dict[int, list[int]] = {}

    def run(self) -> None:
        found, end = self._found, len(self._content)
        for opcode, start, stop in _records(self._content, len(MAGIC)):
            if opcode == Opcode.FOOTER:
                found.finished = self._content[stop: stop + len(MAGIC)].tobytes() == MAGIC
                break
            if opcode == Opcode.CHUNK:
                found.chunks.append(self._chunk(start, stop))
            elif opcode == Opcode.MESSAGE_INDEX and found.chunks:
                self._index(start, stop)
            elif opcode == Opcode.MESSAGE:
                number = int.from_bytes(self._content[start: start + 2].tobytes(), 'little')
                self._outside.setdefault(number, []).append(start - _RECORD.size)
            else:
                self._definition(self._content, opcode, start, stop)
            end = stop
        self._complete(end)

    def _complete(self, end: int) -> None:
        """Walk the chunks whose indexes are missing or may be, and add what lay in none."""
        found = self._found
        for number, chunk in enumerate(found.chunks):
            last = number == len(found.chunks) - 1 and not found.finished
            if last or not chunk.offsets or not chunk.offsets.keys() <= found.channels.keys():
                self._walk_chunk(chunk)
        if self._outside:
            offsets = {key: np.array(value) for key, value in self._outside.items()}
            found.chunks.append(Chunk(self._content[:end], offsets))

    def _chunk(self, start: int, stop: int) -> Chunk:
        body = self._content[start:stop]
        *_, size, crc, length = _CHUNK.unpack_from(body)
        at = _CHUNK.size + length
        compression = body[_CHUNK.size: at].tobytes().decode()
        content = _decompressed(compression, body[at + 8:], size)
        if len(content) != size or (crc and zlib.crc32(content) != crc):
            raise RecordingError(f'{self._found.path} is damaged: checksum of the chunk at byte '
                                 f'{start - _RECORD.size}')
        return Chunk(content)

    def _index(self, start: int, stop: int) -> None:
        channel, size = struct.unpack_from('<HI', self._content, start)
        pairs = np.frombuffer(self._content[start + 6: stop].tobytes(), '<u8', size // 8)
        if size:
            offsets = pairs[1::2].astype(np.int64)
            self._found.chunks[-1].offsets[channel] = np.sort(offsets)

    def _walk_chunk(self, chunk: Chunk) -> None:
        offsets: dict[int, list[int]] = {}
        for opcode, start, stop in _records(chunk.content, 0):
            if opcode == Opcode.MESSAGE:
                number = int.from_bytes(chunk.content[start: start + 2].tobytes(), 'little')
                offsets.setdefault(number, []).append(start - _RECORD.size)
            else:
                self._definition(chunk.content, opcode, start, stop)
        chunk.offsets = {number: np.array(found) for number, found in offsets.items()}

    def _definition(self, content: np.ndarray, opcode: int, start: int, stop: int) -> None:
        """Keep a schema, a channel or a metadata record."""
        if opcode not in (Opcode.SCHEMA, Opcode.CHANNEL, Opcode.METADATA):
            return
        stream = ReadDataStream(BytesIO(content[start:stop].tobytes()))
        if opcode == Opcode.SCHEMA:
            schema = Schema.read(stream)
            self._found.schemas[schema.id] = schema
        elif opcode == Opcode.CHANNEL:
            channel = Channel.read(stream)
            self._found.channels[channel.id] = channel
        else:
            record = Metadata.read(stream)
            self._found.metadata[record.name] = record.metadata


def _records(content: np.ndarray, at: int):
    """Yield (opcode, start, stop of the body) of each whole record."""
    view, size = memoryview(content), len(content)
    while at + _RECORD.size <= size:
        opcode, length = _RECORD.unpack_from(view, at)
        start = at + _RECORD.size
        at = start + length
        if at > size:
            return
        yield opcode, start, at


def _decompressed(compression: str, data: np.ndarray, size: int) -> np.ndarray:
    if compression == '':
        return data
    if compression == 'zstd':
        import zstandard
        content = zstandard.ZstdDecompressor().decompress(data.tobytes(), max_output_size=size)
    elif compression == 'lz4':
        import lz4.frame
        content = lz4.frame.decompress(data.tobytes())
    else:
        raise RecordingError(f'compression {compression!r} is not known')
    return np.frombuffer(content, np.uint8)
