# SPDX-License-Identifier: Apache-2.0
"""The lifecycle of a real node: states, failures, signals, and what /diagnostics say meanwhile."""

import os
import shutil
import signal
import time

from diagnostic_msgs.msg import DiagnosticArray
from hydra_actuator import load_recording
from hydra_actuator.parameters import PARAMETERS
from lifecycle_msgs.msg import State, Transition
from lifecycle_msgs.srv import ChangeState, GetState
import numpy as np
import pytest
from rcl_interfaces.srv import DescribeParameters, GetParameters, SetParametersAtomically
from rclpy.parameter import Parameter
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64

PERIOD_NS = 1_000_000
PATIENCE = 480.0
PARTS = ('Real time', 'Command', 'Solver', 'Recorder', 'Faults')
ERROR = b'\x02'


def state(peer):
    return peer.call(GetState, '/actuator/get_state').current_state.id


def transit(peer, transition):
    # The first one to configure compiles.
    return peer.call(
        ChangeState, '/actuator/change_state', PATIENCE,
        transition=Transition(id=transition)).success


def next_statuses(peer, heard):
    """Return the statuses of the next diagnostics by name, checking what holds for all."""
    count = len(heard)
    peer.until(lambda: len(heard) > count)
    found = {one.name.removeprefix('/actuator: '): one for one in heard[-1].status}
    assert tuple(sorted(found)) == tuple(sorted(PARTS))
    assert all(one.hardware_id == '/actuator' for one in found.values())
    assert all(one.level in (b'\x00', b'\x01', ERROR) for one in found.values())
    return found


def await_message(peer, heard, part, words):
    """Wait until diagnostics say so of a part; return its status."""
    found = next_statuses(peer, heard)[part]
    end = time.monotonic() + 10.0
    while words not in found.message:
        assert time.monotonic() < end, found.message
        found = next_statuses(peer, heard)[part]
    return found


def refuses(peer, *transitions):
    """Ask for transitions that are not there in this state; they change nothing."""
    before = state(peer)
    for transition in transitions:
        assert not transit(peer, transition)
    assert not peer.call(
        ChangeState, '/actuator/change_state', transition=Transition(label='no_such')).success
    assert state(peer) == before


def assign(peer, **values):
    """Set parameters together; names with two underscores for the dot. Return the result."""
    parameters = [
        Parameter(name.replace('__', '.'), value=value).to_parameter_msg()
        for name, value in values.items()]
    return peer.call(SetParametersAtomically, '/actuator/set_parameters_atomically',
                     parameters=parameters).result


def described_over_dds(peer):
    """See that every parameter has type, unit, range and meaning in its descriptor."""
    names = sorted(PARAMETERS)
    found = peer.call(DescribeParameters, '/actuator/describe_parameters', names=names)
    assert [one.name for one in found.descriptors] == names
    for shown in found.descriptors:
        definition = PARAMETERS[shown.name]
        assert definition.meaning in shown.description
        if definition.unit not in ('', '1'):
            assert shown.description.endswith(f'[{definition.unit}]')
        limits = [*shown.floating_point_range, *shown.integer_range]
        for end, bound in (('from_value', definition.minimum), ('to_value', definition.maximum)):
            if bound is not None and not definition.is_array:
                assert getattr(limits[0], end) == bound
        assert ('not while active' in shown.additional_constraints) != definition.live
        assert all(choice in shown.additional_constraints for choice in definition.choices)


def stamps(heard):
    return np.array([one.header.stamp.sec * 10**9 + one.header.stamp.nanosec for one in heard])


def test_every_state_speaks_and_only_the_active_one_publishes(node_process, peer):
    node = node_process('-p', 'autostart:=false', active=False)
    heard = peer.hear(DiagnosticArray, '/diagnostics')
    states = peer.hear(JointState, '/joint_states')
    await_message(peer, heard, 'Solver', 'unconfigured')
    described_over_dds(peer)
    refuses(peer, Transition.TRANSITION_ACTIVATE, Transition.TRANSITION_DEACTIVATE,
            Transition.TRANSITION_CLEANUP, 99)
    assert transit(peer, Transition.TRANSITION_CONFIGURE)
    await_message(peer, heard, 'Solver', 'inactive')
    refuses(peer, Transition.TRANSITION_CONFIGURE, Transition.TRANSITION_DEACTIVATE)
    assert not states
    assert transit(peer, Transition.TRANSITION_ACTIVATE)
    peer.until(lambda: len(states) > 50)
    assert 'active: 1000 Hz, recording to ' in node.text
    command = peer.publisher(Float64, '/actuator/spool_command')
    peer.send(command, Float64(data=0.5), lambda: states[-1].position[1] > 0.0)
    refuses(peer, Transition.TRANSITION_ACTIVATE, Transition.TRANSITION_CONFIGURE,
            Transition.TRANSITION_CLEANUP)
    # All or none: what may not change while active keeps the rest as it was.
    refused = assign(peer, supply__pressure=19e6, cylinder__mass=20.0)
    assert not refused.successful
    assert refused.reason == 'cylinder.mass: not while the node is active; deactivate it first'
    kept = peer.call(GetParameters, '/actuator/get_parameters',
                     names=['supply.pressure', 'cylinder.mass']).values
    assert [one.double_value for one in kept] == [21e6, 10.0]

    assert transit(peer, Transition.TRANSITION_DEACTIVATE)
    await_message(peer, heard, 'Solver', 'inactive')
    peer.spin(0.2)
    before = len(states)
    command.publish(Float64(data=0.7))
    peer.spin(0.3)
    assert len(states) == before

    # Activated again: the state goes on, the command is 0, stamps follow the system time.
    resumed = time.time_ns()
    assert transit(peer, Transition.TRANSITION_ACTIVATE)
    peer.until(lambda: len(states) > before + 50)
    assert states[before].position[1] == 0.0
    assert states[before].position[0] != 0.0
    assert stamps(states)[before] >= resumed
    assert np.all(np.diff(stamps(states)) >= PERIOD_NS)
    recording = node.recording
    assert transit(peer, Transition.TRANSITION_DEACTIVATE)
    assert transit(peer, Transition.TRANSITION_CLEANUP)
    assert load_recording(recording).finished
    await_message(peer, heard, 'Recorder', 'not recording')

    # Configured again with other parameters: a new actuator, a new recording, topics anew.
    assert assign(peer, timing__period=0.002, cylinder__mass=20.0,
                  command__valve_joint='spool').successful
    assert transit(peer, Transition.TRANSITION_CONFIGURE)
    before = len(states)
    assert transit(peer, Transition.TRANSITION_ACTIVATE)
    peer.until(lambda: len(states) > before + 20)
    assert 'active: 500 Hz, recording to ' in node.text
    assert states[-1].name == ['piston', 'spool']
    assert np.all(np.diff(stamps(states)[before:]) % (2 * PERIOD_NS) == 0)
    assert node.recording != recording
    assert 'mass: 20.0' in load_recording(node.recording).custom_data['parameters']
    assert transit(peer, Transition.TRANSITION_ACTIVE_SHUTDOWN)
    await_message(peer, heard, 'Solver', 'finalized')
    refuses(peer, Transition.TRANSITION_CONFIGURE, Transition.TRANSITION_ACTIVATE)
    code, took = node.end()
    assert (code, took < 2.0) == (0, True)


@pytest.mark.parametrize('assignment, culprit', [
    ('valve.strok:=0.001', 'valve.strok'),
    ('valve.stroke:=-1.0', 'valve.stroke = -1.0'),
    ('use_sim_time:=true', 'follow_clock'),
    ('recording.directory:=/proc/nowhere', '/proc/nowhere'),
])
def test_a_failed_configure_leaves_a_living_node_that_says_why(
        node_process, peer, assignment, culprit):
    node = node_process('-p', assignment, active=False)
    heard = peer.hear(DiagnosticArray, '/diagnostics')
    node.wait_for_line('cannot configure')
    assert await_message(peer, heard, 'Solver', culprit).level == ERROR
    assert culprit in node.text
    assert 'Traceback' not in node.text
    assert state(peer) == State.PRIMARY_STATE_UNCONFIGURED
    peer.until(lambda: not peer.node.count_publishers('/joint_states'))
    code, took = node.end(signal.SIGTERM)
    assert (code, took < 2.0) == (0, True)


def test_a_refused_parameter_set_right_lets_the_node_configure(node_process, peer):
    node = node_process('-p', 'valve.stroke:=-1.0', active=False)
    node.wait_for_line('cannot configure')
    right = Parameter('valve.stroke', Parameter.Type.DOUBLE, 4e-4).to_parameter_msg()
    assert peer.call(SetParametersAtomically, '/actuator/set_parameters_atomically',
                     parameters=[right]).result.successful
    assert transit(peer, Transition.TRANSITION_CONFIGURE)
    assert transit(peer, Transition.TRANSITION_ACTIVATE)
    assert 'stroke: 0.0004' in load_recording(node.recording).custom_data['parameters']
    assert node.end()[0] == 0


def test_a_broken_method_stops_the_outputs_and_is_named(node_process, peer):
    node = node_process('-p', 'solver.max_mach:=0.0015')
    heard = peer.hear(DiagnosticArray, '/diagnostics')
    states = peer.hear(JointState, '/joint_states')
    command = peer.publisher(Float64, '/actuator/spool_command')
    peer.send(command, Float64(data=1.0), lambda: 'stopped: ' in node.text)
    peer.until(lambda: state(peer) == State.PRIMARY_STATE_UNCONFIGURED)
    assert await_message(peer, heard, 'Solver', 'solver.max_mach').level == ERROR
    peer.spin(0.2)
    silent = len(states)
    peer.spin(0.2)
    assert len(states) == silent
    recording = load_recording(node.recording)
    assert recording.finished
    events = [status['message'] for message in recording.messages('/actuator/events')
              for status in message['status']]
    assert any('solver.max_mach' in event for event in events)
    # It can begin anew.
    assert transit(peer, Transition.TRANSITION_CONFIGURE)
    assert transit(peer, Transition.TRANSITION_ACTIVATE)
    assert node.end()[0] == 0


def test_a_recording_that_is_removed_costs_only_the_recording(node_process, peer):
    node = node_process()
    heard = peer.hear(DiagnosticArray, '/diagnostics')
    states = peer.hear(JointState, '/joint_states')
    shutil.rmtree(node.recording)
    assert await_message(peer, heard, 'Recorder', str(node.recording)).level == ERROR
    count = len(states)
    peer.until(lambda: len(states) > count + 100)
    assert transit(peer, Transition.TRANSITION_DEACTIVATE)
    assert transit(peer, Transition.TRANSITION_CLEANUP)
    assert state(peer) == State.PRIMARY_STATE_UNCONFIGURED
    assert f'{node.recording} is not complete' in node.text
    assert transit(peer, Transition.TRANSITION_CONFIGURE)
    assert transit(peer, Transition.TRANSITION_ACTIVATE)
    assert node.end()[0] == 0
    assert load_recording(node.recording).finished
    assert 'Traceback' not in node.text


@pytest.mark.parametrize('text, words', [
    ('a: [1\n b: 2', 'params file'),
    ('/**:\n  ros__parameters:\n  - 1\n', 'params file'),
])
def test_a_file_that_ros_cannot_parse_ends_in_one_line_and_code_2(
        demo_process, tmp_path, text, words):
    path = tmp_path / 'bad.yaml'
    path.write_text(text)
    node = demo_process('node', '--ros-args', '--params-file', path)
    assert node.popen.wait(30.0) == 2
    own = [line for line in node.text.splitlines() if line.startswith('hydra_actuator node: ')]
    assert len(own) == 1
    assert words in own[0] and str(path) in own[0]
    assert 'Traceback' not in node.text


def test_security_that_the_middleware_lacks_is_refused_in_one_line(demo_process):
    from hydra_actuator.ros.security import security_missing

    node = demo_process('node', '--ros-args', '-p', 'autostart:=false',
                        environment={'ROS_SECURITY_ENABLE': 'true'})
    if security_missing():
        assert node.popen.wait(30.0) == 2
        own = [line for line in node.text.splitlines() if 'hydra_actuator node: ' in line]
        assert len(own) == 1 and 'ROS_SECURITY_ENABLE' in own[0]
        assert 'Traceback' not in node.text
    else:
        time.sleep(2.0)
        assert node.end()[0] in (0, 2)
    assert os.environ.get('ROS_SECURITY_ENABLE') is None


def test_arguments_that_are_not_for_ros_are_refused(demo_process):
    node = demo_process('node', '--fast')
    assert node.popen.wait(30.0) == 2
    assert node.text.startswith('hydra_actuator node: ')
