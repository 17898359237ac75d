# SPDX-License-Identifier: Apache-2.0
"""
What a sweep is to do, whole, as it stands in its directory: `sweep.json`.

It holds the samples themselves, so a sweep that goes on later does not depend on how another
version of a library draws them.
"""

from dataclasses import dataclass
import json
import os
from pathlib import Path

from hydra_actuator.errors import InputError
from hydra_actuator.parameters import Parameters
from hydra_actuator.sweep.factor import Factor
from hydra_actuator.sweep.run import Drive

FILE = 'sweep.json'
FORMAT = 1


@dataclass(frozen=True)
class Plan:
    """
    A sweep: base parameters, factors, how they are sampled, the drive.

    drive_text says in words what the drive's signal is, and changes with it.
    """

    base: Parameters
    factors: tuple[Factor, ...]
    method: str
    count: int
    seed: int
    drive: Drive
    drive_text: str
    samples: tuple[tuple, ...]

    def changes(self, run: int) -> dict[str, object]:
        """Return the parameters that run `run` has other than the base."""
        return {name: value for factor, value in zip(self.factors, self.samples[run])
                for name in factor.names}

    def told(self) -> dict:
        """Return all but the samples, as JSON holds it."""
        return {
            'format': FORMAT, 'factors': [factor.as_text() for factor in self.factors],
            'method': self.method, 'samples': self.count, 'seed': self.seed,
            'drive': self.drive_text, 'duration': self.drive.duration,
            'from': self.drive.start, 'rate': self.drive.rate,
            'parameters': json.loads(json.dumps(self.base.changed()))}


def is_sweep(directory: str | Path) -> bool:
    """Tell whether a directory holds a sweep."""
    return Path(directory, FILE).is_file()


def read_plan(directory: Path) -> dict:
    """Return what `sweep.json` of a directory holds; InputError if it is none."""
    try:
        found = json.loads((directory / FILE).read_text(encoding='utf-8'))
        if found['format'] != FORMAT:
            raise InputError(f'{directory / FILE} is of format {found["format"]}, not {FORMAT}')
        return found
    except OSError as error:
        raise InputError(f'{directory} holds no sweep: {FILE}: {error.strerror}') from error
    except (ValueError, KeyError, TypeError) as error:
        raise InputError(f'{directory / FILE} is damaged') from error


def settle(plan: Plan, directory: Path) -> Plan:
    """
    Write a plan into its directory, or go on with the one that is there already.

    Raises InputError if that is another one, or the directory is something else.
    """
    try:
        directory.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(f'{directory} cannot be made: {error.strerror}') from error
    if not is_sweep(directory):
        if any(not entry.name.startswith(f'.{FILE}') for entry in directory.iterdir()):
            raise InputError(f'{directory} is not empty and holds no sweep')
        _write(directory, {**plan.told(), 'runs': [list(one) for one in plan.samples]})
        return plan
    found = read_plan(directory)
    for key, value in plan.told().items():
        if found.get(key) != value:
            difference = _difference(found.get(key), value)
            raise InputError(f'{directory} holds another sweep: its {key} {difference}')
    return Plan(plan.base, plan.factors, plan.method, plan.count, plan.seed, plan.drive,
                plan.drive_text, tuple(map(tuple, found['runs'])))


def _difference(there: object, wanted: object) -> str:
    """Return in what two entries differ, short enough for a line."""
    if isinstance(there, dict) and isinstance(wanted, dict):
        name = next(n for n in {**there, **wanted} if there.get(n) != wanted.get(n))
        return f'differ in {name}'
    return f'is {there!r}, not {wanted!r}'[:200]


def _write(directory: Path, told: dict) -> None:
    draft = directory / f'.{FILE}.{os.getpid()}'
    try:
        draft.write_text(json.dumps(told), encoding='utf-8')
        os.replace(draft, directory / FILE)
    except OSError as error:
        raise InputError(f'{directory} cannot be written: {error.strerror}') from error
