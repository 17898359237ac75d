# SPDX-License-Identifier: Apache-2.0
"""
The launch files name parameters, arguments, packages and files that there are.

ROS's launch is no wheel: the files are read, not run.
"""

import ast
from pathlib import Path
import xml.etree.ElementTree as ElementTree

from hydra_actuator.parameters import PARAMETERS
import pytest
import yaml

ROOT = Path(__file__).parents[2]
LAUNCH = sorted((ROOT / 'launch').glob('*.launch.py'))
TREES = {path.name.partition('.')[0]: ast.parse(path.read_text()) for path in LAUNCH}
TYPES = {'bool': 'bool', 'str': 'string'}
WHOLE = pytest.mark.parametrize('name', sorted(TREES))


def constant(name, tree):
    """Return the value of a constant of a launch file."""
    return next(one.value for one in tree.body if isinstance(one, ast.Assign)
                and one.targets[0].id == name)


def calls(name, tree):
    return [one for one in ast.walk(tree) if isinstance(one, ast.Call)
            and isinstance(one.func, ast.Name) and one.func.id == name]


def words(call):
    return {word.arg: word.value for word in call.keywords}


def declared(tree):
    return {one.args[0].value: words(one) for one in calls('DeclareLaunchArgument', tree)}


def test_launch_arguments_set_parameters_of_their_type():
    for value in constant('PARAMETERS', TREES['actuator']).values:
        name, kind = value.elts
        assert PARAMETERS[name.value].type == TYPES[kind.id]


def test_launch_arguments_default_to_what_the_parameters_do():
    table = constant('PARAMETERS', TREES['actuator'])
    parameters = {key.value: value.elts[0].value for key, value in zip(table.keys, table.values)}
    arguments = declared(TREES['actuator'])
    assert set(arguments) == {'namespace', 'config', *parameters}
    for argument, name in parameters.items():
        default = PARAMETERS[name].default
        written = str(default).lower() if isinstance(default, bool) else default
        assert arguments[argument]['default_value'].value == written


@WHOLE
def test_every_argument_that_is_used_is_declared_once_and_told(name):
    tree = TREES[name]
    used = {one.args[0].value for one in calls('LaunchConfiguration', tree)
            if isinstance(one.args[0], ast.Constant)}
    arguments = declared(tree)
    assert used <= set(arguments)
    assert len(calls('DeclareLaunchArgument', tree)) == len(arguments)
    assert all(one['description'].value and 'default_value' in one for one in arguments.values())


@WHOLE
def test_every_package_is_one_that_this_one_depends_on(name):
    manifest = ElementTree.parse(ROOT / 'package.xml').getroot()
    known = {one.text for one in manifest.findall('exec_depend')} | {manifest.findtext('name')}
    tree = TREES[name]
    assert {words(one)['package'].value for one in calls('Node', tree)} <= known
    assert {one.args[0].value for one in calls('FindPackageShare', tree)} <= known
    imported = {one.module.partition('.')[0] for one in ast.walk(tree)
                if isinstance(one, ast.ImportFrom)}
    assert imported <= known


@WHOLE
def test_every_file_that_is_named_is_shipped(name):
    for one in calls('PathJoinSubstitution', TREES[name]):
        parts = [part.value for part in one.args[0].elts[1:]]
        assert ROOT.joinpath(*parts).is_file()


@WHOLE
def test_every_node_is_in_the_namespace(name):
    tree = TREES[name]
    sources = {ast.unparse(words(one)['namespace']) for one in calls('Node', tree)}
    assert sources <= {'namespace', "LaunchConfiguration('namespace')"}
    for one in calls('IncludeLaunchDescription', tree):
        assert "'namespace': namespace" in ast.unparse(words(one)['launch_arguments'])


def test_the_controllers_that_are_spawned_are_configured_and_their_plugins_installed():
    manifest = ElementTree.parse(ROOT / 'package.xml').getroot()
    known = {one.text for one in manifest.findall('exec_depend')}
    spawned = ast.literal_eval(constant('CONTROLLERS', TREES['ros2_control']))
    shipped = yaml.safe_load((ROOT / 'config' / 'controllers.yaml').read_text())
    manager = shipped['/**/controller_manager']['ros__parameters']
    assert {f'/**/{name}' for name in spawned} == set(shipped) - {'/**/controller_manager'}
    assert {manager[name]['type'].partition('/')[0] for name in spawned} <= known
    robot = ElementTree.parse(ROOT / 'config' / 'actuator.urdf')
    assert robot.findtext('ros2_control/hardware/plugin').partition('/')[0] in known


@pytest.mark.parametrize('namespace, prefix', [
    ('', ''), ('left', 'left/'), ('/left', 'left/'), ('cell/left', 'cell/left/')])
def test_frames_carry_the_namespace(namespace, prefix):
    expression, = calls('PythonExpression', TREES['ros2_control'])
    parts = [namespace if isinstance(part, ast.Name) else part.value
             for part in expression.args[0].elts]
    assert eval(''.join(parts)) == prefix
