# SPDX-License-Identifier: Apache-2.0
"""The definitions kept with the package are those of the installed ROS."""

import json
import os
from pathlib import Path
import re
import sys

from hydra_actuator.recording.definitions import definition, type_hashes
import pytest

PRIMITIVES = {
    'bool', 'byte', 'char', 'float32', 'float64', 'int8', 'uint8', 'int16', 'uint16', 'int32',
    'uint32', 'int64', 'uint64', 'string',
}
# rosbag2_cpp's own expression for the type at the start of a line.
FIELD_TYPE = re.compile(r'(?:^|\n)\s*([a-zA-Z0-9_/]+)(?:\[[^\]]*\])?\s+')


def share(package: str) -> Path:
    """Return the folder of an installed package, of a sourced ROS or of the wheels."""
    prefixes = [*os.environ.get('AMENT_PREFIX_PATH', '').split(os.pathsep), sys.prefix]
    folders = [Path(prefix, 'share', package) for prefix in prefixes if prefix]
    return next((folder for folder in folders if folder.is_dir()), folders[-1])


def joined(name: str, seen: set) -> str:
    """Return a definition with its dependencies, as rosbag2's algorithm joins them."""
    package, kind = name.split('/')
    text = (share(package) / 'msg' / f'{kind}.msg').read_text('utf-8')
    own = text
    found = {kind for kind in FIELD_TYPE.findall(own) if kind not in PRIMITIVES}
    for other in sorted(kind if '/' in kind else f'{package}/{kind}' for kind in found):
        if other not in seen:
            seen.add(other)
            text += f'\n{"=" * 80}\nMSG: {other}\n{joined(other, seen)}'
    return text


@pytest.mark.parametrize('type_name', type_hashes())
def test_a_definition_is_what_rosbag2_joins_from_the_installed_messages(type_name):
    assert definition(type_name) == joined(type_name.replace('/msg/', '/'), set())


@pytest.mark.parametrize('type_name', type_hashes())
def test_a_type_hash_is_that_of_the_installed_message(type_name):
    package, _, name = type_name.split('/')
    described = json.loads((share(package) / 'msg' / f'{name}.json').read_text('utf-8'))
    hashes = {entry['type_name']: entry['hash_string'] for entry in described['type_hashes']}
    assert type_hashes()[type_name] == hashes[type_name]


def test_an_unknown_type_has_no_definition():
    with pytest.raises(KeyError):
        definition('std_msgs/msg/Wrench')
