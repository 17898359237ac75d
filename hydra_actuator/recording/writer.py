# SPDX-License-Identifier: Apache-2.0
"""
A recording being written: a new rosbag2 directory with its metadata and its files.

    NAME/metadata.yaml   there from the start, renewed at each flush by atomic replacement
    NAME/NAME_0.mcap     a Segment; NAME_1.mcap ... where one is full or has failed

What was given before the last flush survives the death of this process. After a failure, the file
is closed with what is whole in it, and `resume` goes on in the next. Not thread-safe: see `queue`
for a writer that a real-time loop can feed.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
import os
from pathlib import Path
import shutil
import struct
import time

from hydra_actuator.recording.definitions import type_hashes
from hydra_actuator.recording.errors import RecordingError, RecordingFailure
from hydra_actuator.recording.files import Files, make_directory, remove_empty
from hydra_actuator.recording.limits import Limits, UNLIMITED
from hydra_actuator.recording.metadata import BagMetadata
from hydra_actuator.recording.segment import COMPRESSIONS, Message, Segment
from hydra_actuator.recording.topics import Topic

__all__ = ['RecordingError', 'RecordingFailure', 'RecordingStatistics', 'RecordingWriter']

# How often the disk is looked at [s].
_LOOK = 0.2
# So many messages are written between two looks at whether a file is full.
_PIECE = 64


@dataclass(frozen=True)
class RecordingStatistics:
    """Messages by topic, and bytes in the files so far (the open chunk is not in them yet)."""

    messages: Mapping[str, int]
    bytes: int


class RecordingWriter:
    """
    Writes messages into a directory of its own.

    Usable as a context manager, which closes it.
    """

    def __init__(
        self, directory: str | Path, topics: Sequence[Topic],
        custom_data: Mapping[str, str] | None = None, flush_period: float = 0.5,
        chunk_size: int = 128 * 1024, compression: str = 'none', limits: Limits = UNLIMITED,
    ):
        """
        Make the directory, with its metadata and an empty file in it.

        `topics` are all that can be written; `flush_period` [s] is how long a message may stay
        in memory, `compression` 'none' or 'zstd'. Raises RecordingError if the directory exists
        or cannot be made: nothing is ever overwritten.
        """
        if compression not in COMPRESSIONS:
            raise RecordingError(
                f'compression {compression!r} is none of {", ".join(COMPRESSIONS)}'
            )
        self.directory = Path(os.path.abspath(directory))
        self.closed = False
        self._flush_period = flush_period
        self._limits = limits
        topics, custom_data = _checked(topics), dict(custom_data or {})
        self._files = Files(
            self.directory, BagMetadata(topics, custom_data),
            lambda path: Segment(path, topics, custom_data, chunk_size, compression))
        self._made = make_directory(self.directory)
        try:
            self._files.begin()
        except OSError as error:
            shutil.rmtree(self.directory, ignore_errors=True)
            remove_empty(self._made)
            raise _failure(self.directory, error) from None
        self._flushed = self._looked = time.monotonic()

    def __enter__(self) -> 'RecordingWriter':
        return self

    def __exit__(self, *_) -> None:
        self.close()

    @property
    def statistics(self) -> RecordingStatistics:
        """What was written so far; what a failure has cost is not counted."""
        return RecordingStatistics(self._files.counts, self._files.size)

    def write(self, topic: str, log_ns: int, publish_ns: int, data: bytes) -> None:
        """Write one message; times in nanoseconds, from 0. RecordingFailure on a full disk."""
        self.write_batch(((topic, log_ns, publish_ns, data),))

    def write_batch(self, messages: Iterable[Message]) -> None:
        """
        Write messages (topic, log time [ns], publish time [ns], bytes) in their order.

        After a RecordingFailure nothing is written any more, until `resume`.
        """
        self._refuse_if_interrupted()
        try:
            if self._limits.split:
                self._write_split(list(messages))
            else:
                self._files.open.write(messages)
        except KeyError as error:
            raise RecordingError(f'{self.directory}: {error} is not a topic of it') from None
        except struct.error as error:
            raise RecordingError(f'{self.directory}: time out of range: {error}') from None
        except OSError as error:
            raise self._broken_off(error) from None
        self.flush_if_due()

    def flush_if_due(self) -> None:
        """Flush if the last time is at least a flush period ago; look at the disk now and then."""
        now = time.monotonic()
        if now - self._looked >= _LOOK:
            self._looked = now
            self._look_at_the_disk()
        if now - self._flushed >= self._flush_period:
            self.flush()

    def flush(self) -> None:
        """Hand all messages to the operating system, and renew the metadata."""
        self._refuse_if_interrupted()
        try:
            self._files.open.end_chunk()
            self._files.list_all()
        except OSError as error:
            raise self._broken_off(error) from None
        self._flushed = time.monotonic()

    def resume(self) -> None:
        """Go on in a new file after a failure; RecordingFailure while that cannot be."""
        if self.closed or self._files.open is not None:
            return
        try:
            shortage = self._limits.shortage_for_a_file(self.directory)
            if shortage:
                raise RecordingFailure(f'{self.directory} is not written: {shortage}')
            self._files.forget_missing()
            self._files.begin()
        except OSError as error:
            raise _failure(self.directory, error) from None
        self._flushed = time.monotonic()

    def close(self) -> None:
        """Finish file and metadata; a second call does nothing."""
        if self.closed:
            return
        self.closed = True
        try:
            self._files.close()
        except OSError as error:
            raise self._broken_off(error) from None

    def discard(self) -> None:
        """Remove all of the recording, and the directories that were made for it."""
        self.closed = True
        if self._files.open is not None:
            self._files.open.abandon()
        shutil.rmtree(self.directory, ignore_errors=True)
        remove_empty(self._made)

    def _refuse_if_interrupted(self) -> None:
        if self._files.open is None:
            raise RecordingFailure(f'{self.directory} is not written: it was broken off')

    def _write_split(self, messages: list[Message]) -> None:
        """Write messages, a few at a time, and begin a new file where one is full."""
        for first in range(0, len(messages), _PIECE):
            piece = messages[first:first + _PIECE]
            if self._limits.reached(self._files.open, piece[0][1]):
                self._files.finish()
                self._files.begin()
            self._files.open.write(piece)

    def _look_at_the_disk(self) -> None:
        """End the file while there is space enough to end it well."""
        self._refuse_if_interrupted()
        try:
            shortage = self._limits.shortage(self.directory)
            if not shortage:
                return
            self._files.finish()
            self._files.list_all()
        except OSError as error:
            raise self._broken_off(error) from None
        raise RecordingFailure(f'{self.directory} is not written: {shortage}')

    def _broken_off(self, error: OSError) -> RecordingFailure:
        """Save what is whole in the open file, and return what happened."""
        segment = self._files.open
        self._files.break_off()
        return _failure(self.directory if segment is None else segment.path, error)


def _checked(topics: Iterable[Topic]) -> list[Topic]:
    """Return the topics, each once; RecordingError for an unknown type, or two of one name."""
    by_name: dict[str, Topic] = {}
    for topic in topics:
        if topic.type not in type_hashes():
            raise RecordingError(f'{topic.name}: {topic.type} is no type this package can record')
        if by_name.setdefault(topic.name, topic) != topic:
            raise RecordingError(f'two different topics are named {topic.name}')
    return list(by_name.values())


def _failure(path: Path, error: OSError) -> RecordingFailure:
    return RecordingFailure(f'{path} cannot be written: {error.strerror or error}')
