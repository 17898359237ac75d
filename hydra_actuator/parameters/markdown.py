# SPDX-License-Identifier: Apache-2.0
"""
The table of all parameters for the README.

`python -m hydra_actuator.parameters.markdown README.md` writes it between its two marks.
"""

from collections.abc import Iterator
from pathlib import Path
import sys

from hydra_actuator.parameters.definition import Parameter
from hydra_actuator.parameters.table import PARAMETERS
from hydra_actuator.parameters.table_fault import signal_faults

BEGIN, END = '<!-- parameters -->', '<!-- /parameters -->'

_HEAD = '| parameter | type | default | unit | range | meaning |\n|---|---|---|---|---|---|'


def parameter_table() -> str:
    """Return one Markdown table of all parameters; `*` marks those that are live."""
    rows = [*PARAMETERS.values(), *signal_faults('pressure.NAME', 'Pa')]
    return '\n'.join([_HEAD, *(_row(one) for one in rows)])


def with_table(text: str) -> str:
    """Return the text with the table between its marks; raises ValueError without marks."""
    before, begin, rest = text.partition(BEGIN)
    _, end, after = rest.partition(END)
    if not (begin and end):
        raise ValueError(f'no marks {BEGIN} and {END}')
    return f'{before}{BEGIN}\n{parameter_table()}\n{END}{after}'


def _row(one: Parameter) -> str:
    live = ' *' if one.live else ''
    cells = (f'`{one.name}`{live}', one.type, _default(one), one.unit, _range(one), one.meaning)
    return '| ' + ' | '.join(cell.replace('|', '\\|') for cell in cells) + ' |'


def _default(one: Parameter) -> str:
    if one.is_array:
        return ', '.join(map(str, one.default)) or 'empty'
    if one.type == 'bool':
        return str(one.default).lower()
    return str(one.default) or 'empty'


def _range(one: Parameter) -> str:
    if one.choices:
        return ', '.join(one.choices)
    return ' .. '.join(_limits(one))


def _limits(one: Parameter) -> Iterator[str]:
    for limit in (one.minimum, one.maximum):
        if limit is not None:
            yield f'{limit:g}' if isinstance(limit, float) else str(limit)


def main() -> None:
    """Write the table into the file named on the command line."""
    path = Path(sys.argv[1])
    path.write_text(with_table(path.read_text(encoding='utf-8')), encoding='utf-8')


if __name__ == '__main__':
    main()
