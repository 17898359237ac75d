# SPDX-License-Identifier: Apache-2.0
"""
The one table of all parameters, and what ROS keeps in a node beside them.

`PARAMETERS` holds every parameter whose name does not depend on the names of the sections; the
pressure faults do, and come with `definitions(section_names)`.
"""

from collections.abc import Mapping
from difflib import get_close_matches
from functools import lru_cache
from types import MappingProxyType

from hydra_actuator.parameters.definition import Parameter, ParameterError
from hydra_actuator.parameters.table_actuator import ACTUATOR
from hydra_actuator.parameters.table_fault import FAULTS, pressure_faults
from hydra_actuator.parameters.table_hydraulics import HYDRAULICS
from hydra_actuator.parameters.table_running import RUNNING

_PRESSURE_FAULT = 'fault.pressure.'
_ROS_NAMES = ('use_sim_time', 'start_type_description_service')
_ROS_GROUPS = ('qos_overrides.',)

PARAMETERS: Mapping[str, Parameter] = MappingProxyType(
    {one.name: one for one in (*HYDRAULICS, *ACTUATOR, *RUNNING, *FAULTS)}
)


@lru_cache(maxsize=16)
def definitions(section_names: tuple[str, ...]) -> Mapping[str, Parameter]:
    """Return the whole table for these sections, pressure faults included."""
    faults = {one.name: one for one in pressure_faults(section_names)}
    return MappingProxyType({**PARAMETERS, **faults})


def belongs_to_ros(name: str) -> bool:
    """Tell whether ROS itself declares this parameter in every node."""
    return name in _ROS_NAMES or name.startswith(_ROS_GROUPS)


def unknown(name: str, table: Mapping[str, Parameter]) -> ParameterError:
    """Return the error for a name that is not in the table, with the nearest name that is."""
    if name.startswith(_PRESSURE_FAULT):
        sections = dict.fromkeys(
            known.split('.')[2] for known in table if known.startswith(_PRESSURE_FAULT))
        section = name.removeprefix(_PRESSURE_FAULT).partition('.')[0]
        if section not in sections:
            known = ', '.join(sections) or 'none'
            return ParameterError(
                f'unknown parameter {name!r}: sections.names has no {section!r}, but {known}')
    last = name.rpartition('.')[2]
    same_last = [known for known in table if known.rpartition('.')[2] == last][:3]
    near = get_close_matches(name, table, n=1, cutoff=0.6)
    meant = (near or same_last) if '.' in name else (same_last or near)
    hint = f'; did you mean {" or ".join(map(repr, meant))}?' if meant else ''
    return ParameterError(f'unknown parameter {name!r}{hint}')
