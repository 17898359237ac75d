# SPDX-License-Identifier: Apache-2.0
"""Turn counts that grow into events: at once, but each kind ten times a second at most."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
import time

INTERVAL = 0.1

Event = Callable[[int, str, str, dict[str, str]], None]


@dataclass(frozen=True)
class Watched:
    """A count, and what is reported when it has grown."""

    name: str
    level: int
    text: str
    count: Callable[[], int]


class Watch:
    """Looks at counts and sends events; `look` is for one thread only."""

    def __init__(
        self, event: Event, watched: Iterable[Watched],
        clock: Callable[[], float] = time.monotonic,
    ):
        self._event = event
        self._watched = tuple(watched)
        self._clock = clock
        self._known = [one.count() for one in self._watched]
        self._not_before = [float('-inf')] * len(self._watched)

    def look(self) -> None:
        """Send an event for each count that has grown since its last one."""
        for index, one in enumerate(self._watched):
            count = one.count()
            if count == self._known[index] or self._clock() < self._not_before[index]:
                continue
            new = count - self._known[index]
            self._known[index] = count
            self._not_before[index] = self._clock() + INTERVAL
            if new > 0:
                self._event(one.level, one.name, one.text, {
                    'new': str(new), 'in_all': str(count)})
