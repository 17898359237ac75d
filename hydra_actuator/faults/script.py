# SPDX-License-Identifier: Apache-2.0
"""
A fault script: CSV `time,parameter,value`, simulated time [s], one fault parameter a row.

    time,parameter,value
    2.0,fault.leakage,2e-12
    3.5,fault.pressure.A.stuck,true
    5.0,fault.leakage,0

Times must not fall; rows of one time act together. It is checked whole when it is read.
"""

from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

from hydra_actuator.csv_files import number, read_csv, short
from hydra_actuator.errors import InputError
from hydra_actuator.parameters import Parameter
from hydra_actuator.parameters.definition import Value
from hydra_actuator.parameters.table import unknown

HEADER = ['time', 'parameter', 'value']
# Of the group, but not what goes wrong.
SWITCHES = ('fault.enabled', 'fault.script')
_TRUTH = {'true': True, '1': True, 'false': False, '0': False}


class ScriptRow(NamedTuple):
    """From `time` [s] on, `parameter` has `value`."""

    time: float
    parameter: str
    value: Value


def is_fault(name: str) -> bool:
    """Tell whether a parameter is a fault, not one of the switches beside them."""
    return name.startswith('fault.') and name not in SWITCHES


def read_script(path: str | Path, table: Mapping[str, Parameter]) -> tuple[ScriptRow, ...]:
    """
    Return the rows of a script; an empty path is an empty script.

    table: definitions of the parameters. Raises InputError naming file, line and culprit.
    """
    if not str(path):
        return ()
    path = Path(path).expanduser()
    lines = read_csv(path, ','.join(HEADER))
    header = [cell.strip() for cell in lines[0][1]]
    if header != HEADER:
        raise InputError(f'{path}: header {short(",".join(header))} is not {",".join(HEADER)}')
    rows: list[ScriptRow] = []
    for line, cells in lines[1:]:
        try:
            row = _row([cell.strip() for cell in cells], table)
            if rows and row.time < rows[-1].time:
                raise InputError(f'time {row.time:g} s falls after {rows[-1].time:g} s')
        except InputError as error:
            raise InputError(f'{path}, line {line}: {error}') from None
        rows.append(row)
    if not rows:
        raise InputError(f'{path} has no rows below its header')
    return tuple(rows)


def _row(cells: list[str], table: Mapping[str, Parameter]) -> ScriptRow:
    if len(cells) != len(HEADER):
        raise InputError(f'{len(cells)} values for {len(HEADER)} columns')
    time = number(cells[0], 'time')
    if time < 0.0:
        raise InputError(f'time {time:g} s is before 0')
    name, text = cells[1:]
    if name not in table:
        raise unknown(name, table)
    if not is_fault(name):
        raise InputError(f'{name} is no fault: a script sets those of fault.* only')
    if table[name].type == 'bool':
        if text.lower() not in _TRUTH:
            raise InputError(f'{name} {short(text)} is not true or false')
        return ScriptRow(time, name, _TRUTH[text.lower()])
    return ScriptRow(time, name, table[name].check(number(text, name)))
