# SPDX-License-Identifier: Apache-2.0
"""When a file of a recording is full, and when the disk is."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
import shutil

from hydra_actuator.recording.segment import Segment

# With less than this to spare [byte] no new file is begun: it would be full at once.
HEADROOM = 1024 * 1024


@dataclass(frozen=True)
class Limits:
    """
    Limits of a file and of the disk; 0 is none.

    split_size [byte] and split_duration [s] of log time end a file; with less than
    min_free_space [byte] left on the disk, nothing is written.
    """

    split_size: int = 0
    split_duration: float = 0.0
    min_free_space: int = 0

    @classmethod
    def of(cls, parameters: Mapping[str, object]) -> 'Limits':
        """Take them from the parameters `recording.*`."""
        return cls(*(parameters[f'recording.{name}'] for name in (
            'split_size', 'split_duration', 'min_free_space')))

    @property
    def split(self) -> bool:
        """Tell whether there is a limit to a file."""
        return bool(self.split_size or self.split_duration)

    def reached(self, segment: Segment, log_ns: int) -> bool:
        """Tell whether a message of this log time belongs into the next file."""
        if segment.first_ns is None:
            return False
        if self.split_size and segment.size + segment.open_size >= self.split_size:
            return True
        span = log_ns - segment.first_ns
        return bool(self.split_duration) and span >= round(self.split_duration * 1e9)

    def shortage(self, directory: Path) -> str:
        """Return why nothing more may be written there, or ''; OSError if it is not there."""
        if not self.min_free_space:
            return ''
        return self._short_of(directory, self.min_free_space)

    def shortage_for_a_file(self, directory: Path) -> str:
        """Return why no new file should be begun there, or ''; OSError if it is not there."""
        return self._short_of(directory, self.min_free_space + HEADROOM)

    def _short_of(self, directory: Path, wanted: int) -> str:
        free = shutil.disk_usage(directory).free
        return '' if free >= wanted else f'{free} bytes are free on the disk, {wanted} are needed'


UNLIMITED = Limits()
