# SPDX-License-Identifier: Apache-2.0
"""
One MCAP file of a recording, being written.

    magic | opening | (Chunk | its MessageIndexes) ... | rosbag2 metadata | DataEnd |
    summary: Schemas, Channels, Statistics, ChunkIndexes, MetadataIndexes, their offsets |
    Footer | magic

Schemas and channels stand in the opening, before the first chunk, so that whatever is cut off
behind them, the rest can be read. A chunk with its indexes goes to the file in one piece. The rare
records are those of the mcap package; chunks are put together here, because fourteen thousand
messages a second through its writer cost four times the processor time.

Source: the MCAP specification, mcap.dev/spec.
"""

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
import struct
import zlib

from hydra_actuator.recording.metadata import FileInformation
from hydra_actuator.recording.opening import (
    CHECKSUMS,
    checksums,
    CUSTOM_DATA,
    definition_records,
    encoded,
    HEADER,
    MAGIC,
)
from hydra_actuator.recording.topics import Topic
from mcap.opcode import Opcode
from mcap.records import (
    Channel,
    ChunkIndex,
    DataEnd,
    Footer,
    Metadata,
    MetadataIndex,
    Schema,
    Statistics,
    SummaryOffset,
)

COMPRESSIONS = ('none', 'zstd')

Message = tuple[str, int, int, bytes]

_MESSAGE = int(Opcode.MESSAGE)
_MESSAGE_HEAD = struct.Struct('<BQHIQQ')
_HEAD_SIZE = _MESSAGE_HEAD.size
_HEAD_REST = _HEAD_SIZE - 9


class _Recorded:
    """A channel's part in the file: its id, its count, and its index of the open chunk."""

    __slots__ = ('count', 'id', 'index')

    def __init__(self, number: int):
        self.id = number
        self.count = 0
        self.index: list[int] = []


class Segment:
    """Writes one MCAP file; not thread-safe. OSError when the file takes no more."""

    def __init__(
        self, path: Path, topics: Sequence[Topic], custom_data: Mapping[str, str],
        chunk_size: int = 128 * 1024, compression: str = 'none',
    ):
        """Create the file (FileExistsError if it is there) with schemas and channels in it."""
        self.path = path
        self.size = 0
        self.first_ns: int | None = None
        self.start_ns: int | None = None
        self.end_ns: int | None = None
        self._chunk_size = chunk_size
        self._compress = _compressor(compression)
        self._compression = '' if compression == 'none' else compression
        self._channels = {topic.name: _Recorded(i + 1) for i, topic in enumerate(topics)}
        self._definitions = definition_records(topics)
        self._chunks = 0
        # As they will stand in the file: as records they would take ten times the memory, for
        # as long as the recording goes on.
        self._chunk_indexes = bytearray()
        self._metadata_indexes: list[MetadataIndex] = []
        self._parts: list[bytes] = []
        self._filled = 0
        self._file = open(path, 'xb', buffering=0)
        try:
            definitions = encoded(self._definitions)
            self._put(MAGIC + encoded([HEADER]) + definitions)
            custom = self.add_metadata(CUSTOM_DATA, custom_data)
            self.add_metadata(CHECKSUMS, checksums(definitions, custom))
        except BaseException:
            self.discard()
            raise

    @property
    def open_size(self) -> int:
        """Bytes of the open chunk, before compression."""
        return self._filled

    @property
    def counts(self) -> dict[str, int]:
        """Messages by topic, those of the open chunk included."""
        return {topic: channel.count for topic, channel in self._channels.items()}

    @property
    def information(self) -> FileInformation:
        """What metadata.yaml says of this file."""
        count = sum(channel.count for channel in self._channels.values())
        return FileInformation(self.path.name, self.start_ns, self.end_ns, count)

    def write(self, messages: Iterable[Message]) -> None:
        """Take (topic, log time [ns], publish time [ns], bytes); KeyError for a strange topic."""
        channels, parts, pack = self._channels, self._parts, _MESSAGE_HEAD.pack
        for topic, log_ns, publish_ns, data in messages:
            channel = channels[topic]
            if self.first_ns is None:
                self.first_ns = log_ns
            size = len(data)
            parts.append(pack(_MESSAGE, _HEAD_REST + size, channel.id, channel.count, log_ns,
                              publish_ns))
            parts.append(data)
            channel.index += (log_ns, self._filled)
            channel.count += 1
            self._filled += _HEAD_SIZE + size
            if self._filled >= self._chunk_size:
                self.end_chunk()

    def end_chunk(self) -> None:
        """Send the open chunk, if it holds anything, to the file."""
        if not self._parts:
            return
        content = b''.join(self._parts)
        indexes = {c.id: c.index for c in self._channels.values() if c.index}
        times = [time for index in indexes.values() for time in index[::2]]
        start, end = min(times), max(times)
        data = self._compress(content)
        name = self._compression.encode()
        head = struct.pack(f'<QQQII{len(name)}sQ', start, end, len(content),
                           zlib.crc32(content), len(name), name, len(data))
        chunk = b''.join((struct.pack('<BQ', Opcode.CHUNK, len(head) + len(data)), head, data))
        behind, offsets = _message_indexes(indexes, self.size + len(chunk))
        chunk_index = encoded([ChunkIndex(
            message_start_time=start, message_end_time=end, chunk_start_offset=self.size,
            chunk_length=len(chunk), message_index_offsets=offsets,
            message_index_length=len(behind), compression=self._compression,
            compressed_size=len(data), uncompressed_size=len(content),
        )])
        self._put(chunk + behind)
        self._chunks += 1
        self._chunk_indexes += chunk_index
        self._empty_chunk()
        self.start_ns = start if self.start_ns is None else min(start, self.start_ns)
        self.end_ns = end if self.end_ns is None else max(end, self.end_ns)

    def add_metadata(self, name: str, entries: Mapping[str, str]) -> bytes:
        """Write a metadata record, and return it."""
        record = encoded([Metadata(name=name, metadata=dict(entries))])
        self._metadata_indexes.append(MetadataIndex(self.size, len(record), name))
        self._put(record)
        return record

    def close(self) -> None:
        """Write the open chunk and the summary, and close the file."""
        self.end_chunk()
        end = encoded([DataEnd(0)])
        self._put(end + self._summary(self.size + len(end)) + MAGIC)
        self._file.close()

    def abandon(self) -> None:
        """Close the file as it is, without a summary; never raises."""
        try:
            self._file.close()
        except OSError:
            return

    def cut_back(self) -> None:
        """Give up the open chunk and what is behind the last whole record; never raises."""
        for channel in self._channels.values():
            channel.count -= len(channel.index) // 2
        self._empty_chunk()
        self._metadata_indexes = [
            index for index in self._metadata_indexes if index.offset < self.size]
        try:
            self._file.truncate(self.size)
            self._file.seek(self.size)
        except (OSError, ValueError):
            return

    def discard(self) -> None:
        """Close and remove the file; never raises."""
        try:
            self._file.close()
            self.path.unlink()
        except OSError:
            return

    def _empty_chunk(self) -> None:
        self._parts.clear()
        self._filled = 0
        for channel in self._channels.values():
            channel.index = []

    def _put(self, data: bytes) -> None:
        rest = memoryview(data)
        while rest:
            rest = rest[self._file.write(rest):]
        self.size += len(data)

    def _summary(self, start: int) -> bytes:
        """Return the summary section with the footer, put at a file offset."""
        counts = {channel.id: channel.count for channel in self._channels.values()}
        schemas = [record for record in self._definitions if isinstance(record, Schema)]
        channels = [record for record in self._definitions if isinstance(record, Channel)]
        statistics = Statistics(
            attachment_count=0, channel_count=len(channels), channel_message_counts=counts,
            chunk_count=self._chunks, message_count=sum(counts.values()),
            message_start_time=self.start_ns or 0, message_end_time=self.end_ns or 0,
            metadata_count=len(self._metadata_indexes), schema_count=len(schemas),
        )
        content, offsets = b'', []
        for text, opcode in (
            (encoded(schemas), Opcode.SCHEMA), (encoded(channels), Opcode.CHANNEL),
            (encoded([statistics]), Opcode.STATISTICS), (self._chunk_indexes, Opcode.CHUNK_INDEX),
            (encoded(self._metadata_indexes), Opcode.METADATA_INDEX),
        ):
            if text:
                offsets.append(SummaryOffset(opcode, start + len(content), len(text)))
            content += text
        offsets_start = start + len(content)
        content += encoded(offsets)
        crc = zlib.crc32(content + struct.pack('<BQQQ', Opcode.FOOTER, 20, start, offsets_start))
        return content + encoded([Footer(start, offsets_start, crc)])


def _message_indexes(indexes: Mapping[int, list[int]], at: int) -> tuple[bytes, dict[int, int]]:
    """Return the index records of a chunk, put at a file offset, and the offset of each."""
    parts, offsets = [], {}
    for number, index in indexes.items():
        offsets[number] = at
        size = 8 * len(index)
        parts.append(struct.pack(f'<BQHI{len(index)}Q', Opcode.MESSAGE_INDEX, 6 + size, number,
                                 size, *index))
        at += len(parts[-1])
    return b''.join(parts), offsets


def _compressor(name: str):
    """Return the function that compresses a chunk."""
    if name == 'zstd':
        import zstandard
        return zstandard.ZstdCompressor(level=1).compress
    if name == 'none':
        return bytes
    raise ValueError(f'compression {name!r}; there are {", ".join(COMPRESSIONS)}')
