# SPDX-License-Identifier: Apache-2.0
"""
What has become of each run, one line of JSON each, appended as runs end.

A line that a crash cut short is dropped when the journal is opened again; its run is then not
finished. One process at a time writes a journal.
"""

import fcntl
import json
import math
from pathlib import Path

from hydra_actuator.errors import InputError
from hydra_actuator.sweep.run import DONE, Outcome

FILE = 'journal.jsonl'


class Journal:
    """The journal of a sweep's directory, open for appending."""

    def __init__(self, directory: Path) -> None:
        """Open or make it; InputError if another process has it open, or it cannot be written."""
        self._path = directory / FILE
        try:
            self._file = open(self._path, 'a+b')
        except OSError as error:
            raise InputError(f'{self._path} cannot be written: {error.strerror}') from error
        try:
            fcntl.flock(self._file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            self._file.close()
            raise InputError(f'another process runs the sweep in {directory}') from None
        self._drop_torn_line()

    def __enter__(self) -> 'Journal':
        return self

    def __exit__(self, *_) -> None:
        self._file.close()

    def append(self, outcome: Outcome) -> None:
        """Write an outcome, at once to the operating system."""
        figures = {name: value if math.isfinite(value) else None
                   for name, value in outcome.figures.items()}
        line = json.dumps([outcome.run, outcome.status, outcome.reason, figures])
        self._file.write(line.encode() + b'\n')
        self._file.flush()

    def _drop_torn_line(self) -> None:
        self._file.seek(0)
        content = self._file.read()
        whole = content.rfind(b'\n') + 1
        if whole < len(content):
            self._file.truncate(whole)
        self._file.seek(0, 2)


def read_journal(directory: Path) -> dict[int, Outcome]:
    """Return the outcomes by run, the last of each; InputError for a damaged file."""
    path = directory / FILE
    found = {}
    if not path.exists():
        return found
    lines = path.read_bytes().split(b'\n')
    for k, line in enumerate(lines[:-1]):
        try:
            run, status, reason, figures = json.loads(line)
            found[run] = Outcome(run, status, reason, {
                name: math.nan if value is None else value for name, value in figures.items()})
        except (ValueError, TypeError, AttributeError):
            raise InputError(f'{path}, line {k + 1} is damaged') from None
    return found


def finished(outcomes: dict[int, Outcome], with_failed: bool = True) -> set[int]:
    """Return the runs that need not be done: those done and, if `with_failed`, those failed."""
    return {run for run, one in outcomes.items() if with_failed or one.status == DONE}
