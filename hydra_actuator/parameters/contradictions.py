# SPDX-License-Identifier: Apache-2.0
"""
What two parameters, each good by itself, cannot be together; both are named with their values.

A check receives the complete values by name and yields one line per contradiction.
"""

from collections.abc import Iterator, Mapping
import re

from hydra_actuator.channels import STATIONS
from hydra_actuator.parameters.contradictions_mesh import friction, mesh
from hydra_actuator.parameters.definition import ParameterError, Value
from hydra_actuator.parameters.streamline import streamline_length, wave_speed
from hydra_actuator.parameters.table_actuator import EDGES
from hydra_actuator.parameters.table_hydraulics import LINES

_TOKEN = re.compile(r'[A-Za-z](_?[A-Za-z0-9])*_?')
_LONGEST_TOKEN = 100
# Moody's chart and the formulas fitted to it end at this relative roughness.
_ROUGHEST = 0.05
# Of the bulk modulus: a pressure beyond has no meaning with a modulus that does not depend on it.
_MOST_COMPRESSION = 0.5
# Each file of a recording begins with some 20 kB of definitions.
_SMALLEST_FILE, _SHORTEST_FILE = 100_000, 0.1


def refuse_contradictions(values: Mapping[str, Value]) -> None:
    """Raise ParameterError on the first contradiction between complete, singly valid values."""
    for check in (_fluid, _supply, _lines, _valve, _cylinder, _initial, _compression, mesh,
                  friction, _sections, _joints, _timing, _recording, _faults):
        for contradiction in check(values):
            raise ParameterError(contradiction)


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


def _compression(values: Mapping[str, Value]) -> Iterator[str]:
    places = {
        'supply_line': ('supply.pressure',), 'return_line': ('tank.pressure',),
        'line_1': ('supply.pressure', 'initial.pressure_1'),
        'line_2': ('supply.pressure', 'initial.pressure_2')}
    for line, names in places.items():
        modulus = values['fluid.density'] * wave_speed(values, line) ** 2
        soft = modulus < values['fluid.bulk_modulus'] * (1.0 - 1e-9)
        if values['fluid.cavitation']:
            names = (*names, 'ambient_pressure')
        for name in names:
            if values[name] > _MOST_COMPRESSION * modulus:
                wall = f', with {line}.youngs_modulus = {values[f"{line}.youngs_modulus"]}'
                yield (
                    f'{name} = {values[name]} exceeds {_MOST_COMPRESSION} of the modulus '
                    f'{modulus:.4g} Pa in {line} that follows from fluid.bulk_modulus = '
                    f'{values["fluid.bulk_modulus"]}{wall if soft else ""}'
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


def _faults(values: Mapping[str, Value]) -> Iterator[str]:
    if values['fault.enabled']:
        return
    for name, value in values.items():
        if value and name.startswith('fault.'):
            yield f'{name} = {str(value).lower()} needs fault.enabled = true'


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


def _recording(values: Mapping[str, Value]) -> Iterator[str]:
    for name, least, unit in (
        ('recording.split_size', _SMALLEST_FILE, 'B'),
        ('recording.split_duration', _SHORTEST_FILE, 's'),
    ):
        if 0 < values[name] < least:
            yield f'{name} = {values[name]} must be 0 or at least {least} {unit}'
