# SPDX-License-Identifier: Apache-2.0
"""
What a command message asks of the valve, or why it is not obeyed. No ROS in here.

A message is taken whole or not at all: NaN, infinity, a wrong length, a duplicate joint name, an
index beyond the array, a stamp too far from now make it a rejected one. Out of range is clamped.
In a joint state, only the valve's joints count, and NaN says that there is no command yet.
"""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
import math

from hydra_actuator.parameters import Parameters

Spools = tuple[float, float]

CENTRED: Spools = (0.0, 0.0)
# A rejection says no more than this of what was in the message [characters].
_LONGEST = 100


class RejectedCommandError(ValueError):
    """A command message that is dropped whole; the text says why."""


@dataclass(frozen=True)
class CommandRules:
    """
    What a command is measured by.

    spools: 1 or 2; stroke: spool displacement [m] at full command; scale: size of a full
    command on the topics that carry no displacement; valve_joint: name of the (first) spool;
    max_age: largest distance [s] of a stamp from now, 0 for any.
    """

    spools: int
    stroke: float
    scale: float
    valve_joint: str
    max_age: float = 0.0

    @staticmethod
    def of(parameters: Parameters) -> 'CommandRules':
        """Return the rules that parameters lay down."""
        return CommandRules(
            parameters['valve.spools'], parameters['valve.stroke'],
            parameters['command.scale'], parameters['command.valve_joint'],
            parameters['command.max_age'],
        )

    @property
    def valve_joints(self) -> tuple[str, ...]:
        """Names of the spools as joints."""
        return (self.valve_joint, f'{self.valve_joint}_2')[:self.spools]


class CommandDesk:
    """
    Judges command messages by the rules and counts what became of them.

    Each method returns what is to hold from the next tick (spools normalised, load in N), or
    None for a joint state without a command, and raises RejectedCommandError. `rules` may be
    replaced at any time.
    """

    def __init__(self, rules: CommandRules):
        self.rules = rules
        self.accepted = 0
        self.clamped = 0
        self.without_command = 0
        self.rejected: Counter[str] = Counter()
        self.last_rejection = ''

    @property
    def rejections(self) -> int:
        """Messages dropped so far, for whatever reason."""
        return sum(self.rejected.values())

    def spool_command(self, value: float) -> Spools:
        """Judge one value for all spools."""
        return self._accept([value / self.rules.scale] * self.rules.spools)

    def commands(self, values: Sequence[float]) -> Spools:
        """Judge one value per spool."""
        if len(values) != self.rules.spools:
            raise self._reject(
                'wrong length', f'{len(values)} values for {self.rules.spools} spools')
        return self._accept([value / self.rules.scale for value in values])

    def joint_commands(self, names: Sequence[str], positions: Sequence[float],
                       age: float = 0.0) -> Spools | None:
        """
        Judge a joint state: spool displacements [m] by the names of the valve's joints.

        age: how far back its stamp is [s]; 0 where it has none.
        """
        if 0.0 < self.rules.max_age < abs(age):
            reason = 'stale stamp' if age > 0.0 else 'stamp in the future'
            raise self._reject(reason, f'{abs(age):.3f} s, at most {self.rules.max_age:g} s')
        if len(set(names)) != len(names):
            (twice, _), = Counter(names).most_common(1)
            raise self._reject('duplicate joint name', repr(twice))
        rules = self.rules
        present = [joint for joint in rules.valve_joints if joint in names]
        if not present:
            self.without_command += 1
            return None
        if len(present) < rules.spools:
            raise self._reject('wrong length', f'{present} for {rules.spools} spools')
        places = [names.index(joint) for joint in present]
        if max(places) >= len(positions):
            raise self._reject(
                'index beyond the array',
                f'joint {names[max(places)]!r} is name {max(places)}, '
                f'there are {len(positions)} positions')
        wanted = [positions[place] for place in places]
        if any(map(math.isinf, wanted)):
            raise self._reject('not finite', f'position {wanted}')
        if any(map(math.isnan, wanted)):
            self.without_command += 1
            return None
        return self._accept([position / rules.stroke for position in wanted])

    def load_force(self, value: float) -> float:
        """Judge an external load [N]."""
        if not math.isfinite(value):
            raise self._reject('not finite', f'load {value}')
        self.accepted += 1
        return value

    def unreadable(self, reason: str) -> RejectedCommandError:
        """Count a message that cannot even be read, and return its rejection."""
        return self._reject('unreadable', reason)

    def too_large(self, size: int, largest: int) -> RejectedCommandError:
        """Count a message [byte] that is not read for its size, and return its rejection."""
        return self._reject('too large', f'{size} bytes, a command has {largest} at most')

    def _accept(self, wanted: list[float]) -> Spools:
        """Return finite values clamped to -1..1, the first for both spools if there is one."""
        if not all(map(math.isfinite, wanted)):
            raise self._reject('not finite', f'command {wanted}')
        spools = [min(1.0, max(-1.0, value)) for value in wanted]
        self.clamped += spools != wanted
        self.accepted += 1
        return spools[0], spools[-1]

    def _reject(self, reason: str, detail: str) -> RejectedCommandError:
        self.rejected[reason] += 1
        self.last_rejection = f'{reason}: {_shortened(detail)}'
        return RejectedCommandError(self.last_rejection)


def _shortened(text: str) -> str:
    """Return a text as one reads it in a log: names may have any length."""
    return text if len(text) <= _LONGEST else f'{text[:_LONGEST]}... ({len(text)} characters)'
