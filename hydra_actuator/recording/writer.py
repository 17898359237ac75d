# SPDX-License-Identifier: Apache-2.0
"""
A recording being written: a new rosbag2 directory with its metadata and its file.

    NAME/metadata.yaml   there from the start, renewed at each flush by atomic replacement
    NAME/NAME_0.mcap     a Segment

What was given before the last flush survives the death of this process. Not thread-safe: see
`queue` for a writer that a real-time loop can feed.
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
from hydra_actuator.recording.metadata import BagMetadata, FILE_NAME
from hydra_actuator.recording.segment import COMPRESSIONS, Message, Segment
from hydra_actuator.recording.topics import Topic

__all__ = ['RecordingError', 'RecordingFailure', 'RecordingStatistics', 'RecordingWriter']


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
        chunk_size: int = 128 * 1024, compression: str = 'none',
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
        topics, custom_data = _checked(topics), dict(custom_data or {})
        self._metadata = BagMetadata(topics, custom_data)
        self._made = _make_directory(self.directory)
        try:
            self._segment = Segment(
                self.directory / f'{self.directory.name}_0.mcap', topics, custom_data,
                chunk_size, compression,
            )
            self._write_metadata()
        except OSError as error:
            shutil.rmtree(self.directory, ignore_errors=True)
            _remove(self._made)
            raise _failure(self.directory, error) from None
        self._flushed = time.monotonic()

    def __enter__(self) -> 'RecordingWriter':
        return self

    def __exit__(self, *_) -> None:
        self.close()

    @property
    def statistics(self) -> RecordingStatistics:
        """What was written so far."""
        return RecordingStatistics(self._segment.counts, self._segment.size)

    def write(self, topic: str, log_ns: int, publish_ns: int, data: bytes) -> None:
        """Write one message; times in nanoseconds, from 0. RecordingFailure on a full disk."""
        self.write_batch(((topic, log_ns, publish_ns, data),))

    def write_batch(self, messages: Iterable[Message]) -> None:
        """Write messages (topic, log time [ns], publish time [ns], bytes) in their order."""
        try:
            self._segment.write(messages)
        except KeyError as error:
            raise RecordingError(f'{self.directory}: {error} is not a topic of it') from None
        except struct.error as error:
            raise RecordingError(f'{self.directory}: time out of range: {error}') from None
        except OSError as error:
            raise _failure(self._segment.path, error) from None
        self.flush_if_due()

    def flush_if_due(self) -> None:
        """Flush if the last time is at least a flush period ago."""
        if time.monotonic() - self._flushed >= self._flush_period:
            self.flush()

    def flush(self) -> None:
        """Hand all messages to the operating system, and renew the metadata."""
        try:
            self._segment.end_chunk()
            self._write_metadata()
        except OSError as error:
            raise _failure(self._segment.path, error) from None
        self._flushed = time.monotonic()

    def close(self) -> None:
        """Finish file and metadata; a second call does nothing."""
        if self.closed:
            return
        self.closed = True
        segment = self._segment
        try:
            segment.end_chunk()
            text = self._metadata.information([segment.information], segment.counts)
            segment.add_metadata('rosbag2', {'serialized_metadata': text})
            segment.close()
            self._write_metadata()
        except OSError as error:
            segment.abandon()
            raise _failure(segment.path, error) from None

    def discard(self) -> None:
        """Remove all of the recording, and the directories that were made for it."""
        self.closed = True
        self._segment.abandon()
        shutil.rmtree(self.directory, ignore_errors=True)
        _remove(self._made)

    def _write_metadata(self) -> None:
        """Replace metadata.yaml as a whole: a reader never meets half of it."""
        text = self._metadata.text([self._segment.information], self._segment.counts)
        path = self.directory / FILE_NAME
        new = path.with_suffix('.yaml.new')
        new.write_text(text, 'utf-8')
        os.replace(new, path)


def _checked(topics: Iterable[Topic]) -> list[Topic]:
    """Return the topics, each once; RecordingError for an unknown type, or two of one name."""
    by_name: dict[str, Topic] = {}
    for topic in topics:
        if topic.type not in type_hashes():
            raise RecordingError(f'{topic.name}: {topic.type} is no type this package can record')
        if by_name.setdefault(topic.name, topic) != topic:
            raise RecordingError(f'two different topics are named {topic.name}')
    return list(by_name.values())


def _make_directory(directory: Path) -> list[Path]:
    """Make a new directory and return what was made for it, the innermost first."""
    try:
        str(directory).encode()
    except UnicodeEncodeError:
        raise RecordingError(f'{str(directory)!r} cannot be made: not UTF-8') from None
    missing = [path for path in (directory, *directory.parents) if not os.path.lexists(path)]
    try:
        directory.parent.mkdir(parents=True, exist_ok=True)
        directory.mkdir()
    except FileExistsError:
        taken = directory if os.path.lexists(directory) else directory.parent
        raise RecordingError(
            f'{taken} exists already, and nothing is overwritten' if taken == directory
            else f'{taken} is not a directory'
        ) from None
    except OSError as error:
        _remove(missing)
        raise RecordingError(f'{directory} cannot be made: {error.strerror}') from None
    return missing


def _remove(directories: list[Path]) -> None:
    """Remove directories, the innermost first, as far as they are empty."""
    for path in directories:
        try:
            path.rmdir()
        except OSError:
            continue


def _failure(path: Path, error: OSError) -> RecordingFailure:
    return RecordingFailure(f'{path} cannot be written: {error.strerror or error}')
