# SPDX-License-Identifier: Apache-2.0
"""The launch file names parameters and arguments that there are; ROS's launch is no wheel."""

import ast
from pathlib import Path

from hydra_actuator.parameters import PARAMETERS

LAUNCH = Path(__file__).parents[2] / 'launch' / 'actuator.launch.py'
TYPES = {'bool': 'bool', 'str': 'string'}


def tree():
    return ast.parse(LAUNCH.read_text())


def calls(name):
    return [one for one in ast.walk(tree()) if isinstance(one, ast.Call)
            and isinstance(one.func, ast.Name) and one.func.id == name]


def test_launch_arguments_set_parameters_of_their_type():
    table = next(one.value for one in tree().body if isinstance(one, ast.Assign))
    for value in table.values:
        name, kind = value.elts
        assert PARAMETERS[name.value].type == TYPES[kind.id]


def test_launch_arguments_default_to_what_the_parameters_do():
    table = next(one.value for one in tree().body if isinstance(one, ast.Assign))
    parameters = {key.value: value.elts[0].value for key, value in zip(table.keys, table.values)}
    declared = {
        one.args[0].value: {word.arg: word.value for word in one.keywords}
        for one in calls('DeclareLaunchArgument')}
    assert set(declared) == {'namespace', 'config', *parameters}
    for argument, name in parameters.items():
        default = PARAMETERS[name].default
        written = str(default).lower() if isinstance(default, bool) else default
        assert declared[argument]['default_value'].value == written
