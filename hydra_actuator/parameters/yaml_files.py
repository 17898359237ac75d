# SPDX-License-Identifier: Apache-2.0
"""
Read ROS parameter files as ROS reads them.

rcl's reader differs from PyYAML: `1.4534e9` is a number, `010` is octal, `12:30`, `~` and a date
are strings, `y` and `off` are truth values, a list has one type, aliases and empty values are
refused. So PyYAML only parses here, and scalars are read by rcl's rules
(rcl_yaml_param_parser, Jazzy, parse.c). Stricter than rcl: a key that stands twice, a file
without parameters.
"""

from collections.abc import Iterator, Mapping
from pathlib import Path
import re

from hydra_actuator.parameters.definition import ParameterError
import yaml

_TRUE = frozenset(('Y', 'y', 'yes', 'Yes', 'YES', 'true', 'True', 'TRUE', 'on', 'On', 'ON'))
_FALSE = frozenset(('N', 'n', 'no', 'No', 'NO', 'false', 'False', 'FALSE', 'off', 'Off', 'OFF'))
_INTEGER = re.compile(r'\s*[+-]?(0[xX][0-9a-fA-F]+|0[0-7]*|[1-9][0-9]*)')
_FLOAT = re.compile(
    r'\s*[+-]?((\d+\.?\d*|\.\d+)([eE][+-]?\d+)?|\.?inf(inity)?|\.?nan)', re.IGNORECASE
)
_MARK = 'ros__parameters'
_STRING_TAG = 'tag:yaml.org,2002:str'


class _Loader(yaml.BaseLoader):
    """Parses only; an untagged scalar keeps an empty tag, an alias is refused."""

    DEFAULT_SCALAR_TAG = ''

    def compose_node(self, parent, index):
        """Compose a node, with no way back to an earlier one."""
        if self.check_event(yaml.AliasEvent):
            line = self.peek_event().start_mark.line + 1
            raise ParameterError(f'line {line}: ROS takes no YAML aliases (*name)')
        return super().compose_node(parent, index)


def read_parameter_file(path: str | Path, node: str | None = None) -> dict[str, object]:
    """
    Return the values of a parameter file by dotted name.

    node: fully qualified name, e.g. `/left/actuator`: only the keys that match it count, later
    ones win. Without it the file's only key counts whatever its name; of several, those for any
    node and for a node named `actuator`. Raises ParameterError with the file's name.
    """
    try:
        return _select(_node_tables(_root(Path(path))), node)
    except ParameterError as error:
        raise ParameterError(f'{path}: {error}') from None


def read_scalar(text: str, quoted: bool = False) -> bool | int | float | str:
    """Return the value of one YAML scalar as rcl takes it."""
    if quoted:
        return text
    if text in _TRUE or text in _FALSE:
        return text in _TRUE
    if _INTEGER.fullmatch(text):
        number = int(_octal_marked(text), 0)
        if -(2**63) <= number < 2**63:
            return number
    if _FLOAT.fullmatch(text):
        return float(re.sub(r'\.(?=[in])', '', text, flags=re.IGNORECASE))
    return text


def _octal_marked(text: str) -> str:
    """Return an integer's text with C's leading 0 for octal in Python's way."""
    return re.sub(r'^(\s*[+-]?)0(?=[0-7])', r'\g<1>0o', text)


def _root(path: Path) -> yaml.Node | None:
    """Parse the file into YAML nodes."""
    try:
        text = path.read_text(encoding='utf-8')
        return yaml.compose(text, Loader=_Loader)
    except OSError as error:
        raise ParameterError(f'cannot be read: {error.strerror or error}') from None
    except UnicodeDecodeError:
        raise ParameterError('cannot be read: not UTF-8 text') from None
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        where = f'line {mark.line + 1}: ' if mark else ''
        raise ParameterError(f'not YAML: {where}{error.problem or error.context}') from None
    except yaml.YAMLError as error:
        raise ParameterError(f'not YAML: {" ".join(str(error).split())}') from None


def _node_tables(root: yaml.Node | None) -> list[tuple[str, dict[str, object]]]:
    """Return (node name, its values) in the order of the file."""
    if not isinstance(root, yaml.MappingNode):
        raise ParameterError(f'holds no {_MARK}')
    return list(_walk_namespaces(root, ''))


def _walk_namespaces(node: yaml.MappingNode, name: str) -> Iterator[tuple[str, dict]]:
    for key, value in _items(node):
        if key == _MARK:
            if not name:
                raise ParameterError(f'{_MARK} stands under no node name; use /**')
            yield name, dict(_flatten(value, '', _MARK))
        elif isinstance(value, yaml.MappingNode):
            yield from _walk_namespaces(value, f'{name}/{key}' if name else key)
        else:
            raise ParameterError(f'line {_line(value)}: {key!r} stands under no {_MARK}')


def _flatten(node: yaml.Node, prefix: str, where: str) -> Iterator[tuple[str, object]]:
    """Yield (dotted name, value) below a mapping."""
    if not isinstance(node, yaml.MappingNode):
        raise ParameterError(f'line {_line(node)}: {where} holds no parameters')
    for key, value in _items(node):
        name = f'{prefix}{key}'
        if isinstance(value, yaml.MappingNode):
            yield from _flatten(value, f'{name}.', name)
        elif isinstance(value, yaml.SequenceNode):
            yield name, _sequence(name, value)
        else:
            yield name, _scalar(name, value)


def _items(node: yaml.MappingNode) -> Iterator[tuple[str, yaml.Node]]:
    """Yield the keys of a mapping as text, each once."""
    seen = set()
    for key, value in node.value:
        if not isinstance(key, yaml.ScalarNode):
            raise ParameterError(f'line {_line(key)}: a name is wanted before the colon')
        if key.value in seen:
            raise ParameterError(f'line {_line(key)}: {key.value!r} stands there twice')
        seen.add(key.value)
        yield key.value, value


def _scalar(name: str, node: yaml.ScalarNode) -> bool | int | float | str:
    if node.style is None and node.value == '':
        raise ParameterError(f'line {_line(node)}: {name} has no value')
    return read_scalar(node.value, quoted=node.style is not None or node.tag == _STRING_TAG)


def _sequence(name: str, node: yaml.SequenceNode) -> list:
    for element in node.value:
        if not isinstance(element, yaml.ScalarNode):
            raise ParameterError(f'line {_line(element)}: {name} holds a list within a list')
    values = [_scalar(name, element) for element in node.value]
    kinds = sorted({type(value).__name__ for value in values})
    if len(kinds) > 1:
        raise ParameterError(
            f'line {_line(node)}: {name} mixes {" and ".join(kinds)}; '
            'ROS takes a list of one type (write 1.0, not 1, among doubles)'
        )
    return values


def _select(tables: list[tuple[str, dict]], node: str | None) -> dict[str, object]:
    """Return the values that count, later keys winning."""
    if not tables:
        raise ParameterError(f'holds no {_MARK}')
    if node is not None:
        chosen = [values for name, values in tables if _matches(name, node)]
    elif len(tables) == 1:
        chosen = [tables[0][1]]
    else:
        chosen = [
            values for name, values in tables
            if name.rpartition('/')[2] in ('**', '*', 'actuator')
        ]
        if not chosen:
            names = ', '.join(name for name, _ in tables)
            raise ParameterError(f'holds nothing for a node actuator or /**, only for {names}')
    return {name: value for values in chosen for name, value in values.items()}


def _matches(pattern: str, node: str) -> bool:
    """Tell whether a key like `/**`, `/*/actuator` or `actuator` means the node."""
    parts = re.split(r'(/?\*\*|\*)', '/' + pattern.strip('/'))
    meaning = {'/**': '(/[^/]+)*', '**': '.*', '*': '[^/]+'}
    expression = ''.join(meaning.get(part, re.escape(part)) for part in parts)
    return re.fullmatch(expression, '/' + node.strip('/')) is not None


def _line(node: yaml.Node) -> int:
    return node.start_mark.line + 1


def as_parameter_file(values: Mapping[str, object], node: str = '/**') -> str:
    """Return the text of a parameter file that both ROS and `read_parameter_file` read back."""
    lines = [f'{node}:', f'  {_MARK}:']
    group = None
    for name, value in values.items():
        head, _, key = name.partition('.')
        if key and head != group:
            lines.append(f'    {head}:')
        group = head if key else None
        lines.append(f'    {"  " if key else ""}{key or head}: {_written(value)}')
    return '\n'.join(lines) + '\n'


def _written(value: object) -> str:
    """Return one value as YAML that every reader takes the same way."""
    if isinstance(value, tuple):
        return '[' + ', '.join(map(_written, value)) + ']'
    if isinstance(value, bool):
        return 'true' if value else 'false'
    if isinstance(value, float):
        text = repr(value)
        return text if '.' in text else text.replace('e', '.0e')
    if isinstance(value, str):
        return "'" + value.replace("'", "''") + "'"
    return str(value)
