# SPDX-License-Identifier: Apache-2.0
"""The parameters as ROS parameters: what is let in, what is refused, and with which words."""

import math

from hydra_actuator.parameters import ParameterError, PARAMETERS
from hydra_actuator.ros.declare import descriptor, ParameterDoor
import pytest
import rclpy
from rclpy.exceptions import ParameterNotDeclaredException
from rclpy.node import Node
from rclpy.parameter import Parameter

Type = Parameter.Type


@pytest.fixture
def make_door(domain):
    """Make nodes with parameters from overrides as on a command line."""
    context = rclpy.Context()
    rclpy.init(context=context, args=[])
    nodes = []

    def make(*assignments):
        arguments = ['--ros-args']
        for assignment in assignments:
            arguments += ['-p', assignment]
        nodes.append(Node('actuator', context=context, cli_args=arguments))
        return nodes[-1], ParameterDoor(nodes[-1])
    yield make
    for node in nodes:
        node.destroy_node()
    rclpy.try_shutdown(context=context)


def change(node, *parameters):
    return node.set_parameters_atomically([Parameter(*one) for one in parameters])


def test_every_parameter_is_declared_with_type_default_and_description(make_door):
    node, door = make_door()
    for name, definition in PARAMETERS.items():
        shown = node.describe_parameter(name)
        assert Type(shown.type).name.lower() == definition.type
        assert definition.meaning in shown.description
    assert not door.parameters().changed()
    assert not door.refusals


def test_limits_and_choices_stand_in_the_descriptor():
    shown = descriptor(PARAMETERS['valve.stroke'])
    limits = shown.floating_point_range[0]
    assert (limits.from_value, limits.to_value) == (
        PARAMETERS['valve.stroke'].minimum, PARAMETERS['valve.stroke'].maximum)
    assert '[m]' in shown.description
    assert 'realtime' in descriptor(PARAMETERS['timing.mode']).additional_constraints


def test_integers_are_taken_for_doubles(make_door):
    node, door = make_door('supply.pressure:=20000000', 'sections.names:=[A, mid]',
                           'sections.positions:=[1]')
    assert door.parameters()['supply.pressure'] == 20e6
    assert door.parameters()['sections.positions'] == (1.0,)
    assert change(node, ('supply.pressure', Type.INTEGER, 19_000_000)).successful
    assert node.get_parameter('supply.pressure').value == 19e6


def test_empty_lists_keep_their_type(make_door):
    node, door = make_door('sections.positions:=[]')
    assert door.parameters()['sections.positions'] == ()
    node.set_parameters([Parameter('sections.positions', Type.DOUBLE_ARRAY, [])])
    assert change(
        node, ('sections.names', Type.STRING_ARRAY, ['A', 'mid']),
        ('sections.positions', Type.DOUBLE_ARRAY, [1.0])).successful
    assert door.parameters()['sections.positions'] == (1.0,)


@pytest.mark.parametrize('assignment, reason', [
    ('valve.strok:=0.001', "unknown parameter 'valve.strok'; did you mean 'valve.stroke'?"),
    ('valve.stroke:=.nan', 'valve.stroke = nan: not a finite number'),
    ('valve.stroke:=-1.0', 'valve.stroke = -1.0: below the minimum'),
    ('valve.stroke:=wide', "valve.stroke = 'wide': a number is wanted"),
    ('valve.spools:=2.0', 'valve.spools = 2.0: an integer is wanted'),
    ('recording.mode:=snapshots', "recording.mode = 'snapshots'"),
    ('recording.split_size:=1000', 'recording.split_size = 1000 must be 0 or at least 100000 B'),
    ('use_sim_time:=true', 'follow_clock'),
    ('sections.names:=[A, A]', "'A' stands there 2 times"),
    ('initial.position:=0.2', 'initial.position'),
])
def test_a_bad_override_leaves_a_node_that_says_why_it_cannot_run(make_door, assignment, reason):
    _, door = make_door(assignment)
    with pytest.raises(ParameterError) as refusal:
        door.parameters()
    assert reason in str(refusal.value)
    assert '\n' not in str(refusal.value)


def test_setting_the_parameter_right_lifts_the_refusal(make_door):
    node, door = make_door('valve.stroke:=-1.0')
    assert change(node, ('tank.pressure', Type.DOUBLE, 1e6)).successful
    assert not change(node, ('valve.stroke', Type.DOUBLE, -2.0)).successful
    assert change(node, ('valve.stroke', Type.DOUBLE, 4e-4)).successful
    assert door.parameters()['valve.stroke'] == 4e-4


def test_simulated_time_is_for_all_modes_but_realtime(make_door):
    node, door = make_door('use_sim_time:=true', 'timing.mode:=lockstep')
    assert door.parameters()['timing.mode'] == 'lockstep'
    assert not change(node, ('timing.mode', Type.STRING, 'realtime')).successful
    assert change(node, ('use_sim_time', Type.BOOL, False)).successful
    assert change(node, ('timing.mode', Type.STRING, 'realtime')).successful
    assert not change(node, ('use_sim_time', Type.BOOL, True)).successful


def test_another_mode_lifts_the_refusal_of_simulated_time(make_door):
    node, door = make_door('use_sim_time:=true')
    assert change(node, ('tank.pressure', Type.DOUBLE, 1e6)).successful
    with pytest.raises(ParameterError, match='follow_clock'):
        door.parameters()
    assert change(node, ('timing.mode', Type.STRING, 'follow_clock')).successful
    assert door.parameters()['timing.mode'] == 'follow_clock'


@pytest.mark.parametrize('name, kind, value', [
    ('valve.stroke', Type.DOUBLE, math.nan),
    ('valve.stroke', Type.DOUBLE, -1.0),
    ('valve.stroke', Type.STRING, 'wide'),
    ('timing.overrun_policy', Type.STRING, 'hurry'),
    ('sections.names', Type.STRING_ARRAY, ['A', 'mid']),
    ('use_sim_time', Type.BOOL, True),
])
def test_a_bad_change_is_refused_and_changes_nothing(make_door, name, kind, value):
    node, door = make_door()
    before = door.parameters()
    answer = change(node, ('tank.pressure', Type.DOUBLE, 1e6), (name, kind, value))
    assert not answer.successful
    assert answer.reason
    assert door.parameters() == before


def test_a_change_of_what_is_not_there_is_refused(make_door):
    node, _ = make_door()
    with pytest.raises(ParameterNotDeclaredException):
        change(node, ('valve.strok', Type.DOUBLE, 1.0))


def test_while_active_only_live_parameters_change_and_all_or_none(make_door):
    node, door = make_door()
    told = []
    door.is_active, door.on_change = lambda: True, told.append
    answer = change(
        node, ('supply.pressure', Type.DOUBLE, 15e6), ('cylinder.mass', Type.DOUBLE, 20.0))
    assert not answer.successful
    assert answer.reason == 'cylinder.mass: not while the node is active; deactivate it first'
    assert node.get_parameter('supply.pressure').value == 21e6
    assert change(
        node, ('supply.pressure', Type.DOUBLE, 15e6), ('command.timeout', Type.INTEGER, 1)
    ).successful
    assert told == [{'supply.pressure': 15e6, 'command.timeout': 1.0}]


def test_sections_named_later_bring_their_own_parameters(make_door):
    node, door = make_door()
    assert change(node, ('sections.names', Type.STRING_ARRAY, ['K', 'mid']),
                  ('sections.positions', Type.DOUBLE_ARRAY, [1.0])).successful
    assert node.has_parameter('fault.pressure.mid.off')
    assert door.parameters()['sections.names'] == ('K', 'mid')
