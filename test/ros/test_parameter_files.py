# SPDX-License-Identifier: Apache-2.0
"""Our reader of parameter files beside ROS's own, rcl."""

from pathlib import Path

from hydra_actuator import load_parameters
from hydra_actuator.parameters import read_parameter_file
import pytest
import rclpy
from rclpy.node import Node
from rclpy.parameter import Parameter

CONFIG = Path(__file__).parents[2] / 'config'


def read_by_rcl(path):
    """Return what a node named actuator receives from the file; empty lists have no type."""
    context = rclpy.Context()
    rclpy.init(args=['--ros-args', '--params-file', str(path)], context=context, domain_id=91)
    try:
        node = Node(
            'actuator', context=context, enable_rosout=False, start_parameter_services=False
        )
        overrides = node._parameter_overrides
        node.destroy_node()
    finally:
        rclpy.try_shutdown(context=context)
    return {
        name: [] if one.type_ == Parameter.Type.NOT_SET else one.value
        for name, one in overrides.items()
    }


def same(ours, theirs):
    return {name: (type(value), value) for name, value in ours.items()} == {
        name: (type(value), value) for name, value in theirs.items()
    }


# controllers.yaml is for the controller manager, whose nodes have parameters of their own.
@pytest.mark.parametrize(
    'path', sorted(set(CONFIG.glob('*.yaml')) - {CONFIG / 'controllers.yaml'}),
    ids=lambda path: path.name)
def test_shipped_file_means_the_same_to_rcl(path):
    assert same(read_parameter_file(path), read_by_rcl(path))


def test_written_parameters_mean_the_same_to_rcl(tmp_path):
    parameters = load_parameters(overrides={
        'command.piston_joint': "it's; # a: 'name'", 'cylinder.mass': 1e-300,
        'sections.names': ['rod', 'A'], 'sections.positions': [1e-5], 'solver.cells': 50,
    })
    path = tmp_path / 'all.yaml'
    path.write_text(parameters.as_yaml())
    assert same(read_parameter_file(path), read_by_rcl(path))


@pytest.mark.parametrize('scalar', [
    '~', 'null', '010', '-0x1f', '1e5', '.5', '5.', '1e-05', '12:30', '2001-01-01', '1_000', 'y',
    'off', '"1"', "'a''b'", '[1, 2]', '[]', '.inf', '099', '+5', '!!str 5', '0b1', '0o17', 'é',
    '99999999999999999999', 'Infinity', '1d', '08.5', '1E5', '[yes, no]', '[a, b]', '.', 'e5',
])
def test_scalar_means_the_same_to_rcl(tmp_path, scalar):
    path = tmp_path / 'one.yaml'
    path.write_text(f'/**:\n  ros__parameters:\n    group:\n      x: {scalar}\n')
    assert same(read_parameter_file(path), read_by_rcl(path))


@pytest.mark.parametrize('key', [
    '/**', '"*"', '"**"', '/actuator', 'actuator', '/*', '/**/actuator', '/*/actuator',
    '/ns/actuator', 'other',
])
def test_key_means_the_same_node_to_rcl(tmp_path, key):
    path = tmp_path / 'one.yaml'
    path.write_text(f'{key}:\n  ros__parameters:\n    x: 1\n')
    assert same(read_parameter_file(path, '/actuator'), read_by_rcl(path))
