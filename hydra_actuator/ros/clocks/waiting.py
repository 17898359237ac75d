# SPDX-License-Identifier: Apache-2.0
"""How long a source has waited for what lets it tick: long waits are reported, none skipped."""

import time

from hydra_actuator.ros import statuses
from hydra_actuator.ros.watch import Watched

# A wait longer than this [s] is reported.
LONG_WAIT = 1.0


class Waiting:
    """One wait after the other, and how many were long; `awaited` names what is waited for."""

    def __init__(self, awaited: str):
        self.long_waits = 0
        self._awaited = awaited
        self._since: float | None = None
        self._counted = False

    @property
    def duration(self) -> float:
        """Time [s] of the wait under way, 0 if there is none."""
        since = self._since
        return 0.0 if since is None else time.monotonic() - since

    def begin(self) -> None:
        """Begin a wait, unless one is under way."""
        if self._since is None:
            self._since = time.monotonic()
            self._counted = False

    def end(self) -> None:
        """End the wait."""
        self._since = None

    def remaining(self) -> float:
        """Return the time [s] until the wait is a long one, or has been for another while."""
        return LONG_WAIT - self.duration % LONG_WAIT

    def look(self) -> None:
        """Count the wait under way if it is long and not yet counted."""
        if not self._counted and self.duration >= LONG_WAIT:
            self._counted = True
            self.long_waits += 1

    def status(self, mode: str, values: dict[str, str]) -> statuses.Status:
        """Return the status of a source that waits, or does not."""
        duration = self.duration
        values = {
            'mode': mode, **values,
            'waiting': f'{duration:.3f}', 'long_waits': str(self.long_waits)}
        if duration < LONG_WAIT:
            return statuses.Status('Real time', statuses.OK, mode, values)
        return statuses.Status(
            'Real time', statuses.WARN,
            f'{mode}: waiting for {self._awaited} for {duration:.1f} s', values)

    def watched(self) -> list[Watched]:
        """Return the count of long waits."""
        return [Watched(
            'Real time', statuses.WARN, f'waiting for {self._awaited} for more than 1 s',
            lambda: self.long_waits)]
