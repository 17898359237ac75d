# SPDX-License-Identifier: Apache-2.0
"""
A complete, valid, unchangeable set of parameters, from defaults, files and overrides.

There is no other way to get one than through the whole check: unknown names, types, ranges,
contradictions, options that this version does not have.
"""

from collections.abc import Iterator, Mapping
from pathlib import Path

from hydra_actuator.parameters.contradictions import refuse_contradictions
from hydra_actuator.parameters.definition import Parameter, ParameterError, Value
from hydra_actuator.parameters.table import belongs_to_ros, definitions, PARAMETERS, unknown
from hydra_actuator.parameters.yaml_files import as_parameter_file, read_parameter_file


class Parameters(Mapping[str, Value]):
    """
    Every parameter by its dotted name: `parameters['valve.stroke']`.

    Values are float, int, bool, str or tuple, in SI units. Never changes; `replace` makes
    another one.
    """

    __slots__ = ('_table', '_values')

    def __init__(self, values: Mapping[str, object] | None = None):
        """Take the given values, defaults for the rest; raises ParameterError."""
        given = dict(values or {})
        names = PARAMETERS['sections.names']
        sections = names.check(given.get(names.name, names.default))
        self._table = definitions(sections)
        self._values = _complete(given, self._table)
        refuse_contradictions(self._values)

    def __getitem__(self, name: str) -> Value:
        """Return a value; a KeyError names the nearest parameter there is."""
        try:
            return self._values[name]
        except KeyError:
            raise KeyError(str(unknown(name, self._table))) from None

    def __contains__(self, name: object) -> bool:
        """Tell whether there is such a parameter."""
        return name in self._values

    def __iter__(self) -> Iterator[str]:
        """Run over the names, in the order of the table."""
        return iter(self._values)

    def __len__(self) -> int:
        """Return how many parameters there are."""
        return len(self._values)

    def __hash__(self) -> int:
        """Return the same for equal parameters."""
        return hash(tuple(self._values.items()))

    def __repr__(self) -> str:
        """Show what differs from the defaults."""
        return f'Parameters({self.changed()!r})'

    def __reduce__(self):
        """Travel between processes by value."""
        return Parameters, (self.changed(),)

    @property
    def table(self) -> Mapping[str, Parameter]:
        """Return the definitions, those of the sections' pressure faults included."""
        return self._table

    def replace(self, changes: Mapping[str, object]) -> 'Parameters':
        """Return new parameters with these changes; raises ParameterError, changes nothing."""
        kept = self.changed()
        if 'sections.names' in changes:
            names = PARAMETERS['sections.names'].check(changes['sections.names'])
            lost = self._table.keys() - definitions(names).keys()
            kept = {name: value for name, value in kept.items() if name not in lost}
        return Parameters({**kept, **changes})

    def changed(self) -> dict[str, Value]:
        """Return the values that differ from their defaults."""
        return {
            name: value for name, value in self._values.items()
            if value != self._table[name].default
        }

    def as_yaml(self) -> str:
        """Return all values as a ROS parameter file; reading it gives the same values."""
        return as_parameter_file(self._values)


def load_parameters(
    *paths: str | Path,
    overrides: Mapping[str, object] | None = None,
    node: str | None = None,
) -> Parameters:
    """
    Return the parameters of the files, later ones winning, then of the overrides.

    node: fully qualified name of the node whose keys count in a file; see
    `read_parameter_file`. Raises ParameterError with the file's name where one is to blame.
    """
    values: dict[str, object] = {}
    origin: dict[str, str] = {}
    for path in paths:
        for name, value in read_parameter_file(path, node).items():
            values[name], origin[name] = value, f'{path}: '
    for name, value in (overrides or {}).items():
        values[name], origin[name] = value, ''
    names = PARAMETERS['sections.names']
    try:
        table = definitions(names.check(values.get(names.name, names.default)))
    except ParameterError as error:
        raise ParameterError(f'{origin[names.name]}{error}') from None
    for name, value in values.items():
        try:
            _check(name, value, table)
        except ParameterError as error:
            raise ParameterError(f'{origin[name]}{error}') from None
    try:
        return Parameters(values)
    except ParameterError as error:
        files = ', '.join(map(str, paths))
        raise ParameterError(f'{files}: {error}' if files else str(error)) from None


def _complete(given: Mapping[str, object], table: Mapping[str, Parameter]) -> dict[str, Value]:
    """Return a valid value for every name of the table, in its order."""
    checked = {name: _check(name, value, table) for name, value in given.items()}
    return {name: checked.get(name, one.default) for name, one in table.items()}


def _check(name: str, value: object, table: Mapping[str, Parameter]) -> Value | None:
    """Return a value in its own type, None for a parameter of ROS itself."""
    if name in table:
        return table[name].check(value)
    if belongs_to_ros(name):
        return None
    raise unknown(name, table)
