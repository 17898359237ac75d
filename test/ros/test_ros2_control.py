# SPDX-License-Identifier: Apache-2.0
"""
What ros2_control sends is obeyed, and what it listens for is there.

The messages are built from the shipped URDF as JointStateTopicSystem builds them: all joints by
name, positions only of those with a position command, in the order of the ros2_control tag. It
publishes reliably at depth 1, and listens as to a sensor: best effort, depth 5.
"""

import math
from pathlib import Path
from xml.etree import ElementTree

from diagnostic_msgs.msg import DiagnosticArray
from hydra_actuator import load_parameters
import pytest
from rclpy.qos import qos_profile_sensor_data, QoSProfile
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64MultiArray, MultiArrayDimension
import yaml

CONFIG = Path(__file__).parents[2] / 'config'
ROBOT = ElementTree.parse(CONFIG / 'actuator.urdf').getroot()
SYSTEM = ROBOT.find('ros2_control')
DEFAULTS = load_parameters()
STROKE = DEFAULTS['valve.stroke']


def joints(kind):
    """Return the joints of the tag: name to the names of its interfaces of that kind."""
    return {joint.get('name'): [one.get('name') for one in joint.findall(kind)]
            for joint in SYSTEM.findall('joint')}


def written(node, **commands):
    """Return the message that the plugin writes for these commands; NaN where there is none."""
    message = JointState(name=list(joints('command_interface')))
    message.header.stamp = node.get_clock().now().to_msg()
    for name, interfaces in joints('command_interface').items():
        if 'position' in interfaces:
            message.position.append(commands.get(name, math.nan))
    return message


def topic(parameter):
    return next(one.text for one in SYSTEM.findall('hardware/param')
                if one.get('name') == parameter)


def hears_commands(peer, name='joint_commands_topic'):
    publisher = peer.node.create_publisher(JointState, topic(name), QoSProfile(depth=1))
    peer.until(lambda: publisher.get_subscription_count() > 0)
    return publisher


def listens_as_the_plugin(peer):
    heard = []
    peer.node.create_subscription(
        JointState, topic('joint_states_topic'), heard.append, qos_profile_sensor_data)
    peer.until(lambda: heard)
    return heard


@pytest.fixture
def loop(node_process, peer):
    """Run a node at a rate that a Python listener of all messages can follow."""
    return node_process('-p', 'publish.rate:=200.0', '-p', 'publish.pressure_rate:=0.0')


def test_the_shipped_joints_and_topics_are_the_nodes_own():
    parameters = {one.get('name'): one.text for one in SYSTEM.findall('hardware/param')}
    assert SYSTEM.find('hardware/plugin').text == (
        'joint_state_topic_hardware_interface/JointStateTopicSystem')
    assert parameters == {
        'joint_commands_topic': 'joint_commands', 'joint_states_topic': 'joint_states',
        'trigger_joint_command_threshold': '-1', 'sum_wrapped_joint_states': 'false'}
    assert list(joints('command_interface')) == [
        DEFAULTS['command.valve_joint'], DEFAULTS['command.piston_joint']]
    assert list(joints('command_interface').values()) == [['position'], []]


def test_the_shipped_urdf_has_every_joint_of_its_tag_with_the_limits_of_the_parameters():
    described = {joint.get('name'): joint for joint in ROBOT.findall('joint')}
    assert set(joints('state_interface')) == set(described)
    links = {link.get('name') for link in ROBOT.findall('link')}
    children = [joint.find('child').get('link') for joint in described.values()]
    assert len(set(children)) == len(children)
    assert links - set(children) == {joint.find('parent').get('link')
                                     for joint in described.values()}
    half = DEFAULTS['cylinder.stroke'] / 2.0
    for name, limit in (('valve', STROKE), ('piston', half)):
        bounds = described[name].find('limit')
        assert (float(bounds.get('lower')), float(bounds.get('upper'))) == (-limit, limit)
    assert float(described['piston'].find('limit').get('effort')) == (
        DEFAULTS['supply.pressure'] * DEFAULTS['cylinder.area_1'])
    for bound in SYSTEM.findall('joint/command_interface/param'):
        assert abs(float(bound.text)) == STROKE


def test_the_shipped_controllers_command_the_valve_and_keep_off_the_nodes_topic():
    shipped = yaml.safe_load((CONFIG / 'controllers.yaml').read_text())
    manager = shipped.pop('/**/controller_manager')['ros__parameters']
    assert manager.pop('update_rate') == 1.0 / DEFAULTS['timing.period']
    controllers = {key.removeprefix('/**/'): section['ros__parameters']
                   for key, section in shipped.items()}
    assert {name: one['type'] for name, one in manager.items()} == {
        'joint_state_broadcaster': 'joint_state_broadcaster/JointStateBroadcaster',
        'valve_controller': 'forward_command_controller/ForwardCommandController'}
    assert controllers == {
        'joint_state_broadcaster': {'use_local_topics': True},
        'valve_controller': {'joints': ['valve'], 'interface_name': 'position'}}


def test_a_hardware_interface_closes_the_loop(loop, peer):
    heard = listens_as_the_plugin(peer)
    applied = peer.hear(Float64MultiArray, '/actuator/applied')
    commands = hears_commands(peer)
    # The plugin reads every array by the place of the name, and sets each finite number it
    # finds: one without a state interface would throw.
    state = heard[-1]
    assert len(state.name) == len(state.position) == len(state.velocity) == len(state.effort)
    finite = {
        name: [kind for kind in ('position', 'velocity', 'effort')
               if math.isfinite(getattr(state, kind)[place])]
        for place, name in enumerate(state.name)}
    assert finite == joints('state_interface')

    # No controller is active yet: names, and NaN.
    first = written(peer.node)
    assert first.name == ['valve', 'piston']
    assert len(first.position) == 1 and math.isnan(first.position[0])
    statuses = peer.hear(DiagnosticArray, '/diagnostics')
    peer.send(commands, first, lambda: any(
        value.key == 'without_command' and int(value.value) > 0
        for message in statuses for status in message.status for value in status.values))
    assert len(applied) == 0 or applied[-1].data[1] == 0.0

    # A short array: one position for two names.
    peer.send(commands, written(peer.node, valve=STROKE / 4.0),
              lambda: applied and applied[-1].data[1] == 0.25)
    peer.until(lambda: heard[-1].position[1] == pytest.approx(STROKE / 4.0, rel=1e-12))
    # With a threshold it falls silent once the state is there, and the spool has to stay.
    peer.spin(0.3)
    assert heard[-1].position[1] == pytest.approx(STROKE / 4.0, rel=1e-12)
    # NaN after a command takes nothing back.
    for _ in range(5):
        commands.publish(written(peer.node))
        peer.spin(0.02)
    assert applied[-1].data[1] == 0.25

    # A position controller on the piston, as slow as this listener may be. The piston is there
    # when it stays: it is at rest where it turns back, too.
    looks = []

    def at_target():
        error = 5e-3 - heard[-1].position[0]
        commands.publish(written(peer.node, valve=5e-3 * error))
        peer.spin(0.005)
        looks.append(abs(error) < 1e-4 and abs(heard[-1].velocity[0]) < 0.01)
        return len(looks) >= 20 and all(looks[-20:])
    peer.until(at_target)
    assert heard[-1].effort[0] == pytest.approx(
        5e-3 * DEFAULTS['cylinder.stiffness'], rel=0.1)
    assert loop.end()[0] == 0


def test_two_spools_take_two_joints_and_both_or_neither(node_process, peer):
    node_process('-p', 'valve.spools:=2', '-p', 'publish.rate:=100.0')
    applied = peer.hear(Float64MultiArray, '/actuator/applied')
    commands = hears_commands(peer)
    names = ['valve', 'valve_2', 'piston']
    message = JointState(name=names, position=[STROKE, -STROKE / 2.0])
    peer.send(commands, message, lambda: applied and applied[-1].data[1:3].tolist() == [1.0, -0.5])
    count = len(applied)
    for _ in range(5):
        commands.publish(JointState(name=names, position=[0.0, math.nan]))
        peer.spin(0.02)
    assert len(applied) == count


def test_commands_are_taken_as_those_who_command_forward_command_controller_send_them(
        node_process, peer):
    node_process('-p', 'publish.rate:=100.0')
    applied = peer.hear(Float64MultiArray, '/actuator/applied')
    commands = peer.publisher(Float64MultiArray, '/actuator/commands')
    plain = Float64MultiArray(data=[0.5])
    peer.send(commands, plain, lambda: applied and applied[-1].data[1] == 0.5)
    # The layout says nothing about the command, filled in or not.
    described = Float64MultiArray(data=[-0.125])
    described.layout.dim = [MultiArrayDimension(label='joints', size=1, stride=1)]
    peer.send(commands, described, lambda: applied[-1].data[1] == -0.125)
    # That controller ignores a message of another length; so does the node.
    count = len(applied)
    for wrong in ([], [0.3, 0.3]):
        commands.publish(Float64MultiArray(data=wrong))
        peer.spin(0.1)
    assert len(applied) == count
