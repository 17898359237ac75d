# SPDX-License-Identifier: Apache-2.0
"""
The message types a recording of this package can hold: definition texts and type hashes.

The texts are those of ROS 2 Jazzy (common_interfaces, rcl_interfaces; Apache-2.0), each joined
with its dependencies the way rosbag2 joins them (rosbag2_cpp, local_message_definition_source):
dependencies depth first, in alphabetical order, after a line of 80 equals signs and `MSG: name`.
The type hashes are REP 2011's RIHS01. They are kept with the package because recordings are
written where no ROS is installed; a test compares them with an installed ROS.
"""

from functools import cache
from importlib.resources import files
import json

ENCODING = 'ros2msg'
SEPARATOR = '=' * 80


@cache
def type_hashes() -> dict[str, str]:
    """Return type name -> RIHS01 hash; its keys are the types that can be written."""
    return json.loads(_folder().joinpath('type_hashes.json').read_text('utf-8'))


@cache
def definition(type_name: str) -> str:
    """Return the definition text of a type, dependencies included; KeyError for an unknown."""
    if type_name not in type_hashes():
        raise KeyError(type_name)
    package, _, name = type_name.split('/')
    return _folder().joinpath(f'{package}.{name}.msg').read_text('utf-8')


def _folder():
    return files('hydra_actuator.recording').joinpath('schemas')
