# SPDX-License-Identifier: Apache-2.0
"""
One parameter: its name, type, default, unit, range, meaning; and the check of one value.

Whatever else tells about a parameter (ROS descriptor, README table, shipped YAML) derives from
this definition or is tested against it. Contradictions between parameters are no matter of
this file.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
import math
from numbers import Integral, Real

from hydra_actuator.errors import InputError
import numpy as np

Value = float | int | bool | str | tuple


class ParameterError(InputError):
    """A parameter is unknown, unusable or contradicts another; one line names what and why."""


@dataclass(frozen=True)
class Parameter:
    """
    The definition of one parameter.

    `type` is one of double, integer, bool, string, double_array, integer_array, string_array;
    `minimum` and `maximum` are inclusive and hold for each element; `live` says that it may
    change while the node is active.
    """

    name: str
    type: str
    default: Value
    meaning: str
    unit: str = ''
    minimum: float | int | None = None
    maximum: float | int | None = None
    choices: tuple[str, ...] = ()
    live: bool = False

    @property
    def is_array(self) -> bool:
        """Tell whether the value is a list."""
        return self.type.endswith('_array')

    def check(self, value: object) -> Value:
        """
        Return the value in its own type (an integer is taken for a double, a list for a tuple).

        Raises ParameterError, naming the parameter, the value and the limit it breaks.
        """
        if not self.is_array:
            return self._check_one(value)
        if isinstance(value, np.ndarray):
            value = value.tolist()
        if isinstance(value, (str, bytes)) or not isinstance(value, Sequence):
            raise self._refused(value, f'a list of {self._element_type}s is wanted')
        return tuple(self._check_one(element) for element in value)

    @property
    def _element_type(self) -> str:
        return self.type.removesuffix('_array')

    def _check_one(self, value: object) -> Value:
        value = _READERS[self._element_type](self, value)
        if isinstance(value, (int, float)) and not isinstance(value, bool):
            self._check_range(value)
        elif self.choices and value not in self.choices:
            raise self._refused(value, f'not one of {", ".join(self.choices)}')
        return value

    def _check_range(self, value: float | int) -> None:
        if isinstance(value, float) and not math.isfinite(value):
            raise self._refused(value, 'not a finite number')
        unit = '' if self.unit in ('', '1') else f' {self.unit}'
        if self.minimum is not None and value < self.minimum:
            raise self._refused(value, f'below the minimum {self.minimum}{unit}')
        if self.maximum is not None and value > self.maximum:
            raise self._refused(value, f'above the maximum {self.maximum}{unit}')

    def _refused(self, value: object, reason: str) -> ParameterError:
        return ParameterError(f'{self.name} = {_shown(value)}: {reason}')

    def _read_double(self, value: object) -> float:
        if isinstance(value, Real) and not isinstance(value, bool):
            try:
                return float(value)
            except OverflowError:
                raise self._refused(value, 'not a finite number') from None
        raise self._refused(value, f'a number is wanted, not {_kind(value)}')

    def _read_integer(self, value: object) -> int:
        if isinstance(value, Integral) and not isinstance(value, bool):
            return int(value)
        raise self._refused(value, f'an integer is wanted, not {_kind(value)}')

    def _read_bool(self, value: object) -> bool:
        if isinstance(value, (bool, np.bool_)):
            return bool(value)
        raise self._refused(value, f'true or false is wanted, not {_kind(value)}')

    def _read_string(self, value: object) -> str:
        if not isinstance(value, str):
            raise self._refused(value, f'a string is wanted, not {_kind(value)}')
        if not value.isprintable():
            raise self._refused(value, 'holds a character that cannot be printed')
        return str(value)


_READERS = {
    'double': Parameter._read_double,
    'integer': Parameter._read_integer,
    'bool': Parameter._read_bool,
    'string': Parameter._read_string,
}


def double(name, default, unit, limits, meaning) -> Parameter:
    """Define a number; limits = (minimum, maximum), inclusive."""
    return Parameter(name, 'double', default, meaning, unit, *limits)


def integer(name, default, limits, meaning, unit='') -> Parameter:
    """Define an integer; limits = (minimum, maximum), inclusive."""
    return Parameter(name, 'integer', default, meaning, unit, *limits)


def boolean(name, default, meaning) -> Parameter:
    """Define a claim, true or false."""
    return Parameter(name, 'bool', default, meaning)


def string(name, default, meaning, choices=()) -> Parameter:
    """Define a text, free or one of the choices."""
    return Parameter(name, 'string', default, meaning, choices=choices)


def group(prefix: str, *definitions: Parameter, live: bool = False) -> tuple[Parameter, ...]:
    """Put definitions under `prefix.`, all of them live or none."""
    return tuple(
        replace(one, name=f'{prefix}.{one.name}', live=live or one.live) for one in definitions
    )


def _kind(value: object) -> str:
    """Name the type of a refused value as a person would."""
    if isinstance(value, (bool, np.bool_)):
        return 'a truth value'
    if isinstance(value, str):
        return 'a string'
    if isinstance(value, Real):
        return 'a number with a fraction'
    if isinstance(value, (Sequence, np.ndarray)):
        return 'a list'
    return 'nothing' if value is None else type(value).__name__


def _shown(value: object) -> str:
    """Return the value as text, short enough for one line."""
    text = str(value).lower() if isinstance(value, bool) else repr(value)
    return text if len(text) <= 60 else text[:57] + '...'
