# SPDX-License-Identifier: Apache-2.0
"""
What is sound in one MCAP file, unfinished or damaged anywhere.

Chunks are found by their shape, wherever they stand: a head whose lengths agree with each other.
What counts is a chunk whose checksum agrees with its records; nothing else carries messages here.
A chunk without a checksum and messages outside of chunks cannot be proved and do not count, which
concerns no file of this package. What lies between two sound chunks is either whole records that
carry no messages, or a damage. A summary counts if its own checksum agrees.

Neglected: messages and attachments that are MCAP files themselves, inside of damaged chunks.
"""

from dataclasses import dataclass, field
from io import BytesIO
from pathlib import Path
import struct
import zlib

from hydra_actuator.recording.chunks import (
    chunk_messages,
    chunk_records,
    heads,
    mapped,
    SMALLEST,
)
from hydra_actuator.recording.opening import MAGIC
from hydra_actuator.recording.scan import CHUNK_HEAD, RECORD_HEAD, records
from mcap.data_stream import ReadDataStream, RecordBuilder
from mcap.exceptions import EndOfFile
from mcap.opcode import Opcode
from mcap.records import (
    Channel,
    ChunkIndex,
    DataEnd,
    Footer,
    Header,
    MessageIndex,
    Metadata,
    MetadataIndex,
    Schema,
    Statistics,
    SummaryOffset,
)
import numpy as np

_FOOTER = struct.Struct('<BQQQI')

# Records that carry no messages; attachments are left out, as anything may stand in them.
_HARMLESS = {
    Opcode.HEADER: Header, Opcode.FOOTER: Footer, Opcode.SCHEMA: Schema, Opcode.CHANNEL: Channel,
    Opcode.MESSAGE_INDEX: MessageIndex, Opcode.CHUNK_INDEX: ChunkIndex,
    Opcode.STATISTICS: Statistics, Opcode.METADATA: Metadata,
    Opcode.METADATA_INDEX: MetadataIndex, Opcode.SUMMARY_OFFSET: SummaryOffset,
    Opcode.DATA_END: DataEnd,
}


@dataclass(frozen=True)
class SoundChunk:
    """A chunk whose checksum agrees: its place in the file and the span of its messages [ns]."""

    start: int
    stop: int
    start_ns: int
    end_ns: int


@dataclass(frozen=True)
class Damage:
    """Bytes that hold no provable message, and the sound messages before and after them [ns]."""

    start: int
    stop: int
    what: str
    before_ns: int | None
    after_ns: int | None


@dataclass
class Salvage:
    """
    What one file gives, in counts by channel id.

    `sequences` is the highest sequence number plus one, `counted` what a sound summary says.
    """

    path: Path
    chunks: list[SoundChunk] = field(default_factory=list)
    damages: list[Damage] = field(default_factory=list)
    messages: dict[int, int] = field(default_factory=dict)
    sequences: dict[int, int] = field(default_factory=dict)
    counted: dict[int, int] | None = None
    first_chunk: int = 0
    summary: tuple[int, int] | None = None
    compression: str = ''


def salvage(path: Path) -> Salvage:
    """Look through a file; RecordingError if it cannot be read."""
    content = mapped(path)
    found = Salvage(path)
    _Search(found, content).run()
    return found


class _Search:
    """One pass over a file, filling a Salvage."""

    def __init__(self, found: Salvage, content: np.ndarray):
        self._found = found
        self._content = content
        self._open: list[tuple[int, int, str]] = []
        self._before: int | None = None

    def run(self) -> None:
        found, size = self._found, len(self._content)
        found.first_chunk = size
        begin = at = len(MAGIC)
        if self._content[: len(MAGIC)].tobytes() != MAGIC:
            self._open.append((0, min(begin, size), 'damaged start'))
        for start, stop in heads(self._content, at):
            if start < at or stop > size:
                continue
            content = chunk_records(self._content, start, stop)
            if content is not None or self._record_at(stop):
                self._between(begin, start)
                begin = at = stop
            if content is not None:
                self._sound(start, stop, content)
            elif at == stop:
                self._open.append((start, stop, 'damaged chunk'))
        self._between(begin, size)
        self._settle(None)
        self._summary()

    def _record_at(self, at: int) -> bool:
        """Tell whether a record of a known kind, or nothing more, stands there."""
        if at + RECORD_HEAD.size > len(self._content):
            return True
        opcode, length = RECORD_HEAD.unpack_from(self._content, at)
        return opcode in {*Opcode} and at + RECORD_HEAD.size + length <= len(self._content)

    def _between(self, begin: int, end: int) -> None:
        """Take note of a damage where the bytes are not records without messages."""
        size = len(self._content)
        begin = _behind_harmless(self._content, begin, end)
        rest = self._content[begin:end]
        if end == size and _cut_off_harmlessly(rest):
            return
        if end == size and len(rest):
            self._open.append((begin, end, 'cut-off chunk' if rest[0] == Opcode.CHUNK
                               else 'damaged end'))
        elif len(rest) >= SMALLEST:
            self._open.append((begin, end, 'damaged bytes'))

    def _sound(self, start: int, stop: int, content: np.ndarray) -> None:
        found = self._found
        times = []
        for channel, sequence, log_ns, *_ in chunk_messages(content):
            found.messages[channel] = found.messages.get(channel, 0) + 1
            found.sequences[channel] = max(found.sequences.get(channel, 0), sequence + 1)
            times.append(log_ns)
        if not found.chunks:
            found.first_chunk = start
            name = self._content[start + RECORD_HEAD.size + CHUNK_HEAD.size:][:4].tobytes()
            found.compression = 'zstd' if name == b'zstd' else ''
        if times:
            self._settle(min(times))
            self._before = max(times)
        found.chunks.append(SoundChunk(start, stop, min(times, default=0), max(times, default=0)))

    def _settle(self, after_ns: int | None) -> None:
        """Close the damages that were found since the last sound chunk."""
        for start, stop, what in self._open:
            self._found.damages.append(Damage(start, stop, what, self._before, after_ns))
        self._open.clear()

    def _summary(self) -> None:
        """Take the counts of the summary, if it is there and sound: then nothing is unknown."""
        found, size = self._found, len(self._content)
        at = size - len(MAGIC) - _FOOTER.size
        if at < 0 or self._content[size - len(MAGIC):].tobytes() != MAGIC:
            return
        opcode, length, start, _, crc = _FOOTER.unpack_from(self._content, at)
        covered = self._content[min(start, at): at + _FOOTER.size - 4]
        if opcode != Opcode.FOOTER or length != 20 or not crc or zlib.crc32(covered) != crc:
            return
        found.summary = (start, at)
        for opcode, begin, stop in records(self._content[:at], start):
            if opcode == Opcode.STATISTICS:
                stream = ReadDataStream(BytesIO(self._content[begin:stop].tobytes()))
                found.counted = Statistics.read(stream).channel_message_counts


def _behind_harmless(content: np.ndarray, begin: int, end: int) -> int:
    """Return where the records without messages end that begin here."""
    at = begin
    for opcode, start, stop in records(content[:end], begin):
        if opcode not in _HARMLESS or not _well_formed(opcode, content[start:stop].tobytes()):
            break
        at = stop
    return at


def _cut_off_harmlessly(rest: np.ndarray) -> bool:
    """Tell whether the last bytes of a file are the beginning of what carries no messages."""
    if MAGIC.startswith(rest[: len(MAGIC) + 1].tobytes()):
        return True
    if len(rest) >= RECORD_HEAD.size:
        _, length = RECORD_HEAD.unpack_from(rest)
        if RECORD_HEAD.size + length <= len(rest):
            return False
    return int(rest[0]) in _HARMLESS


def _well_formed(opcode: int, body: bytes) -> bool:
    """Tell whether a record is what its opcode says, so that no chunk hides behind it."""
    if opcode == Opcode.MESSAGE_INDEX:
        size = int.from_bytes(body[2:6], 'little')
        return len(body) >= 6 and size == len(body) - 6 and size % 16 == 0
    builder = RecordBuilder()
    try:
        _HARMLESS[Opcode(opcode)].read(ReadDataStream(BytesIO(body))).write(builder)
    except (struct.error, EndOfFile, UnicodeDecodeError):
        return False
    return builder.end()[RECORD_HEAD.size:] == body
