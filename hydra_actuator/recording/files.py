# SPDX-License-Identifier: Apache-2.0
"""
The directory of a recording being written: its files one after the other, and their list.

One file is open at a time, or none between a failure and the next attempt. A file that is finished
describes itself alone; metadata.yaml describes all.
"""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
import os
from pathlib import Path

from hydra_actuator.recording.errors import RecordingError
from hydra_actuator.recording.metadata import BagMetadata, FILE_NAME, FileInformation
from hydra_actuator.recording.segment import Segment

# Files that wait for their end are open; no more than this.
_MOST_UNFINISHED = 8
# A file's name may have 255 bytes, the millionth file's too.
_LONGEST_NAME = 255 - len('_999999.mcap')


@dataclass(frozen=True)
class _File:
    """A file as it counts for the whole."""

    information: FileInformation
    counts: Mapping[str, int]
    size: int

    @classmethod
    def of(cls, segment: Segment) -> '_File':
        return cls(segment.information, segment.counts, segment.size)


class Files:
    """
    The files NAME_0.mcap, NAME_1.mcap ... in the directory NAME; `open` is the one at work.

    All methods but `break_off` raise OSError where the disk takes no more.
    """

    def __init__(
        self, directory: Path, metadata: BagMetadata, new_segment: Callable[[Path], Segment]
    ):
        """Take an empty directory; `begin` makes the first file."""
        self.open: Segment | None = None
        self._directory = directory
        self._metadata = metadata
        self._new_segment = new_segment
        self._finished: list[_File] = []
        self._unfinished: list[Segment] = []
        self._number = 0

    @property
    def counts(self) -> dict[str, int]:
        """Messages by topic in all files."""
        return _counts(self._all())

    @property
    def size(self) -> int:
        """Bytes in all files; the open chunk is not in them yet."""
        return sum(file.size for file in self._all())

    def begin(self) -> None:
        """Open the next file, and list it; no number is used twice. What fails leaves none."""
        segment = self._next()
        self.open = segment
        try:
            self.list_all()
        except OSError:
            self.open = None
            segment.discard()
            raise
        self._complete()

    def finish(self) -> None:
        """Complete the open file with a description of itself, so that it opens alone."""
        self._end(self.open)
        self._file_away()

    def close(self) -> None:
        """Finish what is open, and list all for the last time."""
        self._complete()
        for segment in self._unfinished:
            segment.abandon()
        if self.open is not None:
            self.finish()
        self.list_all()

    def break_off(self) -> None:
        """After a failure, close the open file with what is whole in it; never raises."""
        if self.open is not None:
            self.open.cut_back()
            try:
                # There is often room for this: the broken chunk has just been cut off.
                self.finish()
            except (OSError, ValueError):
                # Its end is for later; one whose closing has failed is closed all the same.
                self.open.cut_back()
                self._unfinished.append(self.open)
                self._file_away()
        try:
            self.list_all()
        except OSError:
            return

    def forget_missing(self) -> None:
        """Drop from the list what somebody took away: no reader accepts such a list."""
        self._finished = [
            file for file in self._finished
            if (self._directory / file.information.path).exists()]

    def list_all(self) -> None:
        """Replace metadata.yaml as a whole: a reader never meets half of it."""
        files = self._all()
        text = self._metadata.text([file.information for file in files], _counts(files))
        path = self._directory / FILE_NAME
        new = path.with_suffix('.yaml.new')
        try:
            new.write_text(text, 'utf-8')
            os.replace(new, path)
        except OSError:
            new.unlink(missing_ok=True)
            raise

    def _next(self) -> Segment:
        while True:
            path = self._directory / f'{self._directory.name}_{self._number}.mcap'
            try:
                return self._new_segment(path)
            except FileExistsError:
                continue
            finally:
                self._number += 1

    def _end(self, segment: Segment) -> None:
        segment.end_chunk()
        text = self._metadata.information([segment.information], segment.counts)
        segment.add_metadata('rosbag2', {'serialized_metadata': text})
        segment.close()

    def _complete(self) -> None:
        """Give files that failed their end, as far as there is room now; never raises."""
        waiting, self._unfinished = self._unfinished, []
        for segment in waiting:
            try:
                self._end(segment)
            except ValueError:
                continue
            except OSError:
                segment.cut_back()
                self._unfinished.append(segment)
        for segment in self._unfinished[:-_MOST_UNFINISHED]:
            segment.abandon()
        del self._unfinished[:-_MOST_UNFINISHED]

    def _file_away(self) -> None:
        self._finished.append(_File.of(self.open))
        self.open = None

    def _all(self) -> list[_File]:
        return self._finished + ([] if self.open is None else [_File.of(self.open)])


def _counts(files: Iterable[_File]) -> dict[str, int]:
    """Return the messages by topic of all files together."""
    total: dict[str, int] = {}
    for file in files:
        for topic, count in file.counts.items():
            total[topic] = total.get(topic, 0) + count
    return total


def make_directory(directory: Path) -> list[Path]:
    """Make a new directory and return what was made for it, the innermost first."""
    try:
        str(directory).encode()
    except UnicodeEncodeError:
        raise RecordingError(f'{str(directory)!r} cannot be made: not UTF-8') from None
    if len(os.fsencode(directory.name)) > _LONGEST_NAME:
        raise RecordingError(
            f'{directory} cannot be made: name too long, more than {_LONGEST_NAME} bytes')
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
        remove_empty(missing)
        raise RecordingError(f'{directory} cannot be made: {error.strerror}') from None
    return missing


def remove_empty(directories: list[Path]) -> None:
    """Remove directories, the innermost first, as far as they are empty."""
    for path in directories:
        try:
            path.rmdir()
        except OSError:
            continue
