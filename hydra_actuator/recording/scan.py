# SPDX-License-Identifier: Apache-2.0
"""
One MCAP file being read, finished or cut off anywhere.

The file is walked record by record from its start, so it needs no summary; where messages lie in
a chunk is taken from the chunk's indexes, so no message is kept until it is asked for. A chunk
whose indexes are missing or cut off is walked itself. Any writer's file will do, whatever its
chunks, compression and indexes; attachments are skipped.

A cut-off end is no error (`finished` says so); a wrong checksum inside is.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import partial
from io import BytesIO
from pathlib import Path
import struct
import zlib

from hydra_actuator.recording.block import Block, join, JOINED, MappedFile
from hydra_actuator.recording.errors import RecordingError
from hydra_actuator.recording.opening import CHECKSUMS, MAGIC, parts_before
from mcap.data_stream import ReadDataStream
from mcap.exceptions import EndOfFile
from mcap.opcode import Opcode
from mcap.records import Channel, Metadata, Schema
import numpy as np

RECORD_HEAD = struct.Struct('<BQ')
_INDEX_HEAD = struct.Struct('<HI')
CHUNK_HEAD = struct.Struct('<QQQII')

# No writer makes chunks that large [byte].
_LARGEST_CHUNK = 1 << 31
_SMALL = np.iinfo(np.int32).max


@dataclass
class ScannedFile:
    """What a file holds."""

    path: Path
    schemas: dict[int, Schema] = field(default_factory=dict)
    channels: dict[int, Channel] = field(default_factory=dict)
    metadata: dict[str, dict[str, str]] = field(default_factory=dict)
    blocks: list[Block] = field(default_factory=list)
    finished: bool = False


def scan(path: Path) -> ScannedFile:
    """Walk a file; RecordingError if it is none, or damaged before its end."""
    try:
        file = MappedFile(path)
    except OSError as error:
        raise RecordingError(f'{path} cannot be read: {error.strerror}') from None
    if file.bytes[: len(MAGIC)].tobytes() != MAGIC:
        raise RecordingError(f'{path} is not an MCAP file')
    found = ScannedFile(path)
    try:
        _Walk(found, file).run()
    except (struct.error, EndOfFile, ValueError, KeyError) as error:
        raise RecordingError(f'{path} is damaged: {error!r}') from None
    return found


class _Walk:
    """One pass over a file's records, filling a ScannedFile."""

    def __init__(self, found: ScannedFile, file: MappedFile):
        self._found = found
        self._file = file
        self._content = file.bytes
        self._outside: dict[int, list[int]] = {}

    def run(self) -> None:
        found, end, seen = self._found, len(self._content), 0
        for opcode, start, stop in records(self._content, len(MAGIC)):
            if opcode == Opcode.FOOTER:
                found.finished = self._content[stop: stop + len(MAGIC)].tobytes() == MAGIC
                break
            if opcode == Opcode.CHUNK:
                found.blocks.append(self._chunk(start, stop))
            elif opcode == Opcode.MESSAGE_INDEX and found.blocks:
                self._index(start, stop)
            elif opcode == Opcode.MESSAGE:
                number = int.from_bytes(self._content[start: start + 2].tobytes(), 'little')
                self._outside.setdefault(number, []).append(start - RECORD_HEAD.size)
            else:
                self._definition(self._content, opcode, start, stop)
            end = stop
            if end - seen > JOINED:
                self._file.forget(seen, end)
                seen = end
        self._complete(end)
        self._file.forget(0, len(self._content))

    def _complete(self, end: int) -> None:
        """Walk the chunks whose indexes are missing or may be, and add what lay in none."""
        found = self._found
        for number, block in enumerate(found.blocks):
            last = number == len(found.blocks) - 1 and not found.finished
            if last or not block.offsets or not block.offsets.keys() <= found.channels.keys():
                self._walk_chunk(block)
        found.blocks = join(found.blocks)
        if self._outside:
            outside = Block(self._file, 0, end)
            outside.offsets = {key: np.array(value) for key, value in self._outside.items()}
            found.blocks.append(outside)

    def _chunk(self, start: int, stop: int) -> Block:
        *_, size, crc, length = CHUNK_HEAD.unpack_from(self._content[start:stop])
        at = start + CHUNK_HEAD.size + length
        compression = self._content[start + CHUNK_HEAD.size: at].tobytes().decode()
        unpack = partial(decompressed, compression, size=size) if compression else None
        content = self._content[at + 8: stop]
        try:
            content = unpack(content) if unpack else content
        except RecordingError as error:
            raise RecordingError(f'{self._found.path} is damaged: {error}') from None
        if len(content) != size or (crc and zlib.crc32(content) != crc):
            raise RecordingError(f'{self._found.path} is damaged: checksum of the chunk at byte '
                                 f'{start - RECORD_HEAD.size}')
        return Block(self._file, at + 8, stop, size, unpack)

    def _index(self, start: int, stop: int) -> None:
        channel, size = _INDEX_HEAD.unpack_from(self._content, start)
        if size:
            pairs = np.frombuffer(self._content, '<i8', size // 8, start + _INDEX_HEAD.size)
            offsets = pairs[1::2].copy()
            offsets.sort()
            if 0 <= offsets[0] and offsets[-1] <= _SMALL:
                offsets = offsets.astype(np.int32)
            self._found.blocks[-1].offsets[channel] = offsets

    def _walk_chunk(self, block: Block) -> None:
        offsets: dict[int, list[int]] = {}
        with block.opened() as content:
            for opcode, start, stop in records(content, 0):
                if opcode == Opcode.MESSAGE:
                    number = int.from_bytes(content[start: start + 2].tobytes(), 'little')
                    offsets.setdefault(number, []).append(start - RECORD_HEAD.size)
                else:
                    self._definition(content, opcode, start, stop)
        block.offsets = {number: np.array(found) for number, found in offsets.items()}

    def _definition(self, content: np.ndarray, opcode: int, start: int, stop: int) -> None:
        """Keep a schema, a channel or a metadata record; of repeated ones the first."""
        if opcode not in (Opcode.SCHEMA, Opcode.CHANNEL, Opcode.METADATA):
            return
        stream = ReadDataStream(BytesIO(content[start:stop].tobytes()))
        if opcode == Opcode.SCHEMA:
            schema = Schema.read(stream)
            self._found.schemas.setdefault(schema.id, schema)
        elif opcode == Opcode.CHANNEL:
            channel = Channel.read(stream)
            self._found.channels.setdefault(channel.id, channel)
        else:
            record = Metadata.read(stream)
            self._found.metadata[record.name] = record.metadata
            if record.name == CHECKSUMS:
                self._check_opening(start - RECORD_HEAD.size, record.metadata)

    def _check_opening(self, end: int, entries: dict[str, str]) -> None:
        parts = parts_before(self._content[:end].tobytes(), end, entries)
        if None in parts.values():
            raise RecordingError(f'{self._found.path} is damaged: checksum of its definitions')


def records(content: np.ndarray, at: int) -> Iterator[tuple[int, int, int]]:
    """Yield (opcode, start, stop of the body) of each whole record."""
    view, size = memoryview(content), len(content)
    while at + RECORD_HEAD.size <= size:
        opcode, length = RECORD_HEAD.unpack_from(view, at)
        start = at + RECORD_HEAD.size
        at = start + length
        if at > size:
            return
        yield opcode, start, at


def decompressed(compression: str, data: np.ndarray, size: int) -> np.ndarray:
    """Return a chunk's records; RecordingError if it is damaged or its compression unknown."""
    if compression == '':
        return data
    if compression not in ('zstd', 'lz4'):
        raise RecordingError(f'compression {compression!r} is not known')
    if size > _LARGEST_CHUNK:
        raise RecordingError(f'a chunk says that it holds {size} bytes')
    try:
        content = (_unzstd if compression == 'zstd' else _unlz4)(data.tobytes(), size)
    except Exception as error:  # neither package names all that its C code raises
        raise RecordingError(f'a chunk cannot be decompressed: {error}') from None
    return np.frombuffer(content, np.uint8)


def _unzstd(data: bytes, size: int) -> bytes:
    import zstandard

    if zstandard.frame_content_size(data) not in (-1, size):
        raise ValueError('not of the size it says')
    return zstandard.ZstdDecompressor().decompress(data, max_output_size=size)


def _unlz4(data: bytes, size: int) -> bytes:
    import lz4.frame

    return lz4.frame.LZ4FrameDecompressor().decompress(data, max_length=size)
