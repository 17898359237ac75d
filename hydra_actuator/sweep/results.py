# SPDX-License-Identifier: Apache-2.0
"""What a sweep has given, as its pictures need it: columns in the units people read."""

from dataclasses import dataclass
import json
from pathlib import Path

from hydra_actuator.errors import InputError
from hydra_actuator.sweep.merit import MERITS
from hydra_actuator.sweep.plan import read_plan
from hydra_actuator.sweep.run import Outcome
from hydra_actuator.sweep.tables import failures, load_table
import numpy as np

SHOWN = {'Pa': (1e-6, 'MPa'), 'm': (1e3, 'mm'), 'm^2': (1e4, 'cm^2'), 'm^3': (1e6, 'ml'),
         'm^3/s': (6e4, 'l/min'), 'W': (1e-3, 'kW'), 'N': (1e-3, 'kN'), '1': (1.0, '')}


@dataclass(frozen=True)
class Column:
    """A quantity over the runs: values in `unit`, or codes of `texts` where it has no numbers."""

    name: str
    unit: str
    values: np.ndarray
    logarithmic: bool = False
    texts: tuple[str, ...] = ()

    @property
    def label(self) -> str:
        """What stands on an axis."""
        return f'{self.name} [{self.unit}]' if self.unit else self.name

    @property
    def varies(self) -> bool:
        """Whether there is anything to see."""
        finite = self.values[np.isfinite(self.values)]
        return len(finite) > 1 and float(np.ptp(finite)) > 0.0


@dataclass(frozen=True)
class Results:
    """
    A sweep's results: factors and figures over the runs done, what failed, what was to be done.

    told: sweep.json; samples: the factors' values of every run, failed ones too.
    """

    name: str
    told: dict
    runs: np.ndarray
    factors: tuple[Column, ...]
    figures: tuple[Column, ...]
    failed: tuple[Outcome, ...]
    units: dict[str, str]

    @property
    def asked(self) -> int:
        """How many runs were to be done."""
        return len(self.told['runs'])

    @property
    def all_ranges(self) -> bool:
        """Whether every factor was drawn from a range."""
        return self.told['method'] != 'grid' and all(':' in text for text in self.told['factors'])

    def samples(self, k: int, runs: list[int]) -> Column:
        """Return factor k at runs, those that failed included."""
        like = self.factors[k]
        values = [self.told['runs'][run][k] for run in runs]
        return _column(like.name, self.units[like.name], values, like.logarithmic, like.texts)


def load_results(directory: str | Path) -> Results:
    """Return the results of a sweep's directory; InputError where they cannot be read."""
    directory = Path(directory)
    told = read_plan(directory)
    table, _ = load_table(directory)
    factors = []
    for k, text in enumerate(told['factors']):
        names, _, right = text.partition('=')
        name = names.split('+')[0]
        if name not in table:
            raise InputError(f'{directory}: the results hold no {name}')
        texts = tuple(dict.fromkeys(_text(run[k]) for run in told['runs']))
        words = isinstance(told['runs'][0][k], (str, bool))
        factors.append(_column(name, table[name][1].get('unit', ''), table[name][0].tolist(),
                               right.endswith(':log'), texts if words else ()))
    figures = tuple(_column(merit.name, merit.unit, table[merit.name][0].tolist())
                    for merit in MERITS)
    return Results(directory.resolve().name, told, table['run'][0], tuple(factors), figures,
                   tuple(failures(directory)),
                   {c.name: table[c.name][1].get('unit', '') for c in factors})


def _column(name: str, unit: str, values: list, logarithmic: bool = False,
            texts: tuple[str, ...] = ()) -> Column:
    if texts:
        codes = np.array([texts.index(_text(value)) for value in values], float)
        return Column(name, '', codes, texts=texts)
    factor, shown = SHOWN.get(unit, (1.0, unit))
    return Column(name, shown, np.array(values, float) * factor, logarithmic)


def _text(value: object) -> str:
    return value if isinstance(value, str) else json.dumps(value)
