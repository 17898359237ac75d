# SPDX-License-Identifier: Apache-2.0
"""
What two parameters, each good by itself, cannot be together; both are named with their values.

A check receives the complete values by name and yields one line per contradiction.
"""

from collections.abc import Iterator, Mapping
import re

from hydra_actuator.channels import STATIONS
from hydra_actuator.parameters.definition import ParameterError, Value
from hydra_actuator.parameters.table_actuator import EDGES
from hydra_actuator.parameters.table_hydraulics import LINES

_TOKEN = re.compile(r'[A-Za-z](_?[A-Za-z0-9])*_?')
_LONGEST_TOKEN = 100
# Moody's chart and the formulas fitted to it end at this relative roughness.
_ROUGHEST = 0.05


def refuse_contradictions(values: Mapping[str, Value]) -> None:
    """Raise ParameterError on the first contradiction between complete, singly valid values."""
    for check in (_fluid, _supply, _lines, _valve, _cylinder, _initial, _sections, _joints,
                  _timing):
        for contradiction in check(values):
            raise ParameterError(contradiction)


def streamline_length(values: Mapping[str, Value]) -> float:
    """Return the length of the streamline from pump to tank [m], piston at mid-stroke."""
    lines = sum(values[f'{line}.length'] for line in LINES)
    dead = values['cylinder.dead_length_1'] + values['cylinder.dead_length_2']
    return lines + dead + values['cylinder.stroke']


def _pair(values: Mapping[str, Value], first: str, relation: str, second: str) -> str:
    return f'{first} = {values[first]} {relation} {second} = {values[second]}'


def _fluid(values: Mapping[str, Value]) -> Iterator[str]:
    if values['fluid.vapour_pressure'] >= values['ambient_pressure']:
        yield _pair(values, 'fluid.vapour_pressure', 'must be below', 'ambient_pressure')


def _supply(values: Mapping[str, Value]) -> Iterator[str]:
    if values['supply.accumulator_volume'] == 0.0:
        return
    if values['supply.accumulator_precharge'] > values['supply.pressure']:
        yield _pair(
            values, 'supply.accumulator_precharge', 'must not exceed', 'supply.pressure'
        )


def _lines(values: Mapping[str, Value]) -> Iterator[str]:
    for line in LINES:
        if values[f'{line}.roughness'] > _ROUGHEST * values[f'{line}.diameter']:
            yield _pair(
                values, f'{line}.roughness', f'must not exceed {_ROUGHEST} of',
                f'{line}.diameter',
            )


def _valve(values: Mapping[str, Value]) -> Iterator[str]:
    for edge in EDGES:
        overlap = values[f'valve.overlap_{edge}']
        if overlap >= values['valve.stroke']:
            yield _pair(
                values, f'valve.overlap_{edge}', 'leaves the edge shut: it must be below',
                'valve.stroke',
            )
        if -overlap > values['valve.stroke']:
            yield _pair(
                values, f'valve.overlap_{edge}', 'leaves the edge open: it must not go beyond',
                'valve.stroke',
            )


def _cylinder(values: Mapping[str, Value]) -> Iterator[str]:
    if values['cylinder.static_friction'] < values['cylinder.coulomb_friction']:
        yield _pair(
            values, 'cylinder.static_friction', 'must not be below', 'cylinder.coulomb_friction'
        )


def _initial(values: Mapping[str, Value]) -> Iterator[str]:
    if 2.0 * abs(values['initial.position']) > values['cylinder.stroke']:
        yield _pair(
            values, 'initial.position', 'lies outside -half to +half of', 'cylinder.stroke'
        )
    for name in ('initial.pressure_1', 'initial.pressure_2'):
        absolute = values[name] + values['ambient_pressure']
        if absolute < values['fluid.vapour_pressure']:
            yield (
                f'{name} = {values[name]} is {absolute} Pa absolute with '
                + _pair(values, 'ambient_pressure', 'and so below', 'fluid.vapour_pressure')
            )


def _sections(values: Mapping[str, Value]) -> Iterator[str]:
    names, positions = values['sections.names'], values['sections.positions']
    for name in names:
        if not _TOKEN.fullmatch(name) or len(name) > _LONGEST_TOKEN:
            yield (
                f'sections.names: {name!r} cannot be part of a topic name: letters, digits and '
                f'single underscores, a letter first, at most {_LONGEST_TOKEN}'
            )
    for name in {name: None for name in names if names.count(name) > 1}:
        yield f'sections.names: {name!r} stands there {names.count(name)} times'
    own = [name for name in names if name not in STATIONS]
    if len(own) != len(positions):
        yield (
            f'sections.positions has {len(positions)} values, but sections.names has '
            f'{len(own)} own names{": " if own else ""}{", ".join(own)}'
        )
    length = streamline_length(values)
    for position in positions:
        if position > length:
            yield (
                f'sections.positions: {position} m lies beyond the tank at {length:.6g} m, the '
                'sum of all lengths'
            )


def _joints(values: Mapping[str, Value]) -> Iterator[str]:
    for name in ('command.piston_joint', 'command.valve_joint'):
        if not values[name].strip():
            yield f'{name} = {values[name]!r}: a joint needs a name'
    piston, valve = values['command.piston_joint'], values['command.valve_joint']
    if piston in (valve, f'{valve}_2'):
        yield _pair(
            values, 'command.piston_joint', 'is the name of the spool by', 'command.valve_joint'
        )


def _timing(values: Mapping[str, Value]) -> Iterator[str]:
    mode = values['timing.mode']
    if mode == 'lockstep':
        periods = values['timing.lockstep_period'] / values['timing.period']
        if round(periods) < 1 or abs(periods - round(periods)) > 1e-9 * periods:
            yield _pair(
                values, 'timing.lockstep_period', 'must be a whole multiple of', 'timing.period')
    if mode == 'follow_clock' and values['publish.clock']:
        yield 'publish.clock = true must be false with timing.mode = follow_clock: one gives time'
