# SPDX-License-Identifier: Apache-2.0
"""What is said of faults: an event when one begins, changes or ends, and how it stands."""

from collections.abc import Mapping

# Levels as diagnostic_msgs has them.
OK, WARN = 0, 1
NAME = 'Faults'

# Level, message, values: the content of one diagnostic status.
Announcement = tuple[int, str, dict[str, str]]


class Announcer:
    """Compares the faults at work with those that it was told of before; none at first."""

    def __init__(self) -> None:
        self._known: Mapping[str, object] = {}

    def news(self, active: Mapping[str, object]) -> list[Announcement]:
        """Return one announcement for each fault that has begun, changed or ended."""
        before, self._known = self._known, active
        begun = [(WARN, f'{name} = {shown(value)}', {name: shown(value)})
                 for name, value in active.items() if before.get(name) != value]
        return begun + [(OK, f'{name} ended', {name: shown(0)})
                        for name in before if name not in active]


def standing(enabled: bool, active: Mapping[str, object]) -> Announcement:
    """Return how it stands: which faults are at work, with their values."""
    values = {'enabled': shown(enabled)}
    values.update((name, shown(value)) for name, value in active.items())
    if active:
        return WARN, f'at work: {", ".join(active)}', values
    return OK, 'no faults', values


def shown(value: object) -> str:
    """Return a value as text."""
    return str(value).lower() if isinstance(value, bool) else f'{value:.9g}'
