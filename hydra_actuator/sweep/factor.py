# SPDX-License-Identifier: Apache-2.0
"""
A factor: what a sweep varies, one parameter or several that move together, and where to.

    cylinder.area_1+cylinder.area_2=5e-4:2e-3:log     both areas, one value, a range
    solver.cells=100,200,400                          the values themselves
    line_1.friction=constant,unsteady
"""

from dataclasses import dataclass
import math

from hydra_actuator.errors import InputError
from hydra_actuator.parameters import Parameters
from hydra_actuator.parameters.definition import Parameter
from hydra_actuator.parameters.table import unknown
from hydra_actuator.parameters.yaml_files import read_scalar
import numpy as np

LOG = 'log'


@dataclass(frozen=True)
class Factor:
    """
    What is varied: `names` of the parameters that take its value.

    Either `levels` holds its values, or they lie from `low` to `high`, in equal ratios if
    `logarithmic`, whole numbers if `whole`.
    """

    names: tuple[str, ...]
    levels: tuple = ()
    low: float = 0.0
    high: float = 0.0
    logarithmic: bool = False
    whole: bool = False

    @property
    def name(self) -> str:
        """The factor's name: that of its first parameter."""
        return self.names[0]

    def values(self, shares: np.ndarray) -> list:
        """Return the values at shares (n,) of the way, 0 inclusive to 1 exclusive."""
        if self.levels:
            places = np.minimum((shares * len(self.levels)).astype(int), len(self.levels) - 1)
            return [self.levels[k] for k in places]
        low, high = self.low, self.high
        if self.whole:
            # Each whole number has its share, the ends too.
            low, high = low - 0.5, high + 0.5
        if self.logarithmic:
            found = np.exp(np.log(low) + shares * (math.log(high) - math.log(low)))
        else:
            found = low + shares * (high - low)
        # Exponentials of logarithms can pass an end by a unit in the last place.
        return self._within(found)

    def grid(self, points: int) -> list:
        """Return `points` values from end to end, or the levels as they are."""
        if self.levels:
            return list(self.levels)
        spaced = np.geomspace if self.logarithmic else np.linspace
        return list(dict.fromkeys(self._within(spaced(self.low, self.high, points))))

    def _within(self, values: np.ndarray) -> list:
        """Return values held within the ends, whole if they have to be."""
        values = np.clip(values, self.low, self.high)
        return (np.rint(values).astype(int) if self.whole else values).tolist()

    def as_text(self) -> str:
        """Return it as it is written on the command line."""
        if self.levels:
            return f'{"+".join(self.names)}={",".join(map(_written, self.levels))}'
        scale = f':{LOG}' if self.logarithmic else ''
        return f'{"+".join(self.names)}={self.low!r}:{self.high!r}{scale}'


def read_factor(text: str, base: Parameters) -> Factor:
    """Return the factor that a text describes; InputError names what is wrong with it."""
    left, equals, right = text.partition('=')
    names = tuple(part.strip() for part in left.split('+'))
    if not equals or not all(names) or not right.strip():
        raise InputError(f'{text!r} is not NAME=LOW:HIGH, NAME=LOW:HIGH:log or NAME=V1,V2,...')
    if len(set(names)) < len(names):
        raise InputError(f'{text!r} names a parameter twice')
    for name in names:
        if name not in base.table:
            raise unknown(name, base.table)
        if base.table[name].is_array:
            raise InputError(f'{name} is a list, which cannot be varied')
    definitions = [base.table[name] for name in names]
    if ':' in right:
        return _range(text, names, definitions, [part.strip() for part in right.split(':')])
    levels = [read_scalar(part.strip()) for part in right.split(',')]
    checked = tuple(definitions[0].check(level) for level in levels)
    for definition in definitions[1:]:
        for level in levels:
            definition.check(level)
    if len(set(checked)) < len(checked):
        raise InputError(f'{text!r} holds a value twice')
    return Factor(names, checked)


def _range(text: str, names: tuple[str, ...], definitions: list[Parameter],
           parts: list[str]) -> Factor:
    """Return a factor over a range; its ends must be good for every parameter it moves."""
    logarithmic = parts[-1] == LOG
    ends = parts[:-1] if logarithmic else parts
    if len(ends) != 2:
        raise InputError(f'{text!r} is not NAME=LOW:HIGH or NAME=LOW:HIGH:log')
    for definition in definitions:
        if definition.type not in ('double', 'integer'):
            raise InputError(f'{definition.name} is no number: name its values, V1,V2,...')
        for end in ends:
            definition.check(read_scalar(end))
    whole = any(definition.type == 'integer' for definition in definitions)
    low, high = ((int if whole else float)(definitions[0].check(read_scalar(end)))
                 for end in ends)
    if not low < high:
        raise InputError(f'{text!r}: {low:g} is not below {high:g}')
    if logarithmic and low <= 0.0:
        raise InputError(f'{text!r}: a logarithmic range begins above 0, not at {low:g}')
    return Factor(names, (), low, high, logarithmic, whole)


def refuse_overlap(factors: tuple[Factor, ...]) -> None:
    """Raise InputError where two factors move the same parameter, or there is none."""
    if not factors:
        raise InputError('nothing is varied: --vary NAME=LOW:HIGH')
    names = [name for factor in factors for name in factor.names]
    for name in dict.fromkeys(names):
        if names.count(name) > 1:
            raise InputError(f'{name} is varied twice')


def _written(value: object) -> str:
    return str(value).lower() if isinstance(value, bool) else str(value)
