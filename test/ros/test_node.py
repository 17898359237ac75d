# SPDX-License-Identifier: Apache-2.0
"""The node as a process of its own, over DDS: commands, states, recording, bad input."""

import math
import time

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from hydra_actuator import Actuator, load_parameters, load_recording
from hydra_actuator.recording.messages import decode, FLOAT64
from hydra_actuator.replay import Replay
import numpy as np
import pytest
from rcl_interfaces.srv import SetParametersAtomically
import rclpy
from rclpy.parameter import Parameter
from rclpy.qos import ReliabilityPolicy
from rclpy.serialization import deserialize_message, serialize_message
from rosbags.highlevel import AnyReader
from sensor_msgs.msg import FluidPressure, JointState
from std_msgs.msg import Float64, Float64MultiArray
from std_srvs.srv import SetBool, Trigger

PERIOD_NS = 1_000_000


def latest(heard, name):
    """Return the newest status of that name and its values, an empty one before the first."""
    for message in reversed(heard):
        for status in message.status:
            if status.name == f'/actuator: {name}':
                return status, {one.key: one.value for one in status.values}
    return DiagnosticStatus(), {}


def last_values(recording, name):
    """Return the values of the last status of that name in a recording."""
    return next(
        {one['key']: one['value'] for one in status['values']}
        for message in reversed(list(recording.messages('/diagnostics')))
        for status in message['status'] if status['name'] == f'/actuator: {name}')


def set_parameter(peer, name, kind, value):
    return peer.call(
        SetParametersAtomically, '/actuator/set_parameters_atomically',
        parameters=[Parameter(name, kind, value).to_parameter_msg()]).result


def replayed(recording, ticks):
    """Return the rows that an offline run gives for what the recording says was applied."""
    parameters = load_parameters(overrides={'solver.cells': 100})
    actuator = Actuator(parameters)
    changes = recording.applied[1]
    rows = np.empty((ticks, actuator.channels.width))
    for tick in range(ticks):
        _, spool, load_force = changes[changes[:, 0] <= tick][-1]
        assert actuator.tick_once(spool, spool, load_force) == 0
        rows[tick] = actuator.row
    return rows


def test_a_sine_over_dds_comes_back_as_motion_and_is_recorded_whole(node_process, peer):
    node = node_process()
    states = peer.hear(JointState, '/joint_states')
    pressures = peer.hear(FluidPressure, '/actuator/pressure/E')
    command = peer.publisher(Float64, '/actuator/spool_command')
    peer.until(lambda: states and pressures)
    for k in range(300):
        command.publish(Float64(data=math.sin(2.0 * math.pi * k / 50.0)))
        time.sleep(2e-3)
    assert node.end()[0] == 0

    first = states[0]
    assert first.name == ['piston', 'valve']
    assert len(first.position) == len(first.velocity) == len(first.effort) == 2
    assert math.isnan(first.velocity[1]) and math.isnan(first.effort[1])
    assert pressures[0].header.frame_id == 'E'
    assert pressures[0].variance == 0.0
    positions = [state.position[0] for state in states]
    assert max(positions) - min(positions) > 1e-4

    recording = load_recording(node.recording)
    stamps = recording.row_stamps
    assert recording.finished
    for section in 'OABCDEFGHIJK':
        assert recording.topics[f'/actuator/pressure/{section}'].count == len(stamps)
    # What was heard is what was recorded, stamp by stamp and bit by bit.
    by_stamp = dict(zip(stamps.tolist(), recording.rows[:, recording.channels.POSITION]))
    for state in states:
        stamp = state.header.stamp.sec * 10**9 + state.header.stamp.nanosec
        assert by_stamp[stamp] == state.position[0]
    # Every instant of the grid is there once, but for declared slip.
    assert set(np.unique(np.diff(stamps)) % PERIOD_NS) == {0}
    assert np.all(np.diff(stamps) >= PERIOD_NS)
    # The recording alone says what the plant was told: the run can be repeated bit by bit.
    ticks = len(stamps) - 1
    assert np.array_equal(
        replayed(recording, ticks)[:, recording.channels.POSITION],
        recording.rows[1:, recording.channels.POSITION])
    received = recording.series('/actuator/spool_command')
    assert len(received) > 100
    now = time.time_ns()
    assert all(now - 300e9 < stamp <= now for stamp in received.stamps)


def test_an_independent_reader_finds_all_topics_and_types(node_process, peer):
    node = node_process()
    applied = peer.hear(Float64MultiArray, '/actuator/applied')
    load = peer.publisher(Float64, '/actuator/load_force')
    peer.send(load, Float64(data=250.0), lambda: applied and applied[-1].data[2] == 250.0)
    node.end()
    recording = load_recording(node.recording)
    with AnyReader([node.recording]) as reader:
        types = {one.topic: one.msgtype for one in reader.connections}
        counts = {one.topic: one.msgcount for one in reader.connections}
        assert types['/joint_states'] == 'sensor_msgs/msg/JointState'
        assert types['/actuator/pressure/K'] == 'sensor_msgs/msg/FluidPressure'
        assert types['/actuator/sections'] == 'std_msgs/msg/Float64MultiArray'
        assert types['/actuator/field'] == 'std_msgs/msg/Float32MultiArray'
        assert types['/diagnostics'] == 'diagnostic_msgs/msg/DiagnosticArray'
        assert counts['/joint_states'] == len(recording.row_stamps)
        assert counts['/actuator/load_force'] >= 1
        own = [one for one in reader.connections if one.topic == '/joint_states']
        stamps = []
        for connection, log_time, data in reader.messages(own):
            state = reader.deserialize(data, connection.msgtype)
            stamp = state.header.stamp
            assert log_time == stamp.sec * 10**9 + stamp.nanosec
            stamps.append(log_time)
    assert stamps == recording.row_stamps.tolist()
    assert 'discharge_coefficient' in recording.custom_data['parameters']


def test_bad_commands_are_dropped_whole_counted_and_leave_no_trace(node_process, peer):
    node = node_process('-p', 'command.max_age:=60.0')
    heard = peer.hear(DiagnosticArray, '/diagnostics')
    spool = peer.publisher(Float64, '/actuator/spool_command')
    array = peer.publisher(Float64MultiArray, '/actuator/commands')
    joints = peer.publisher(JointState, '/joint_commands')
    load = peer.publisher(Float64, '/actuator/load_force')
    long_name = 'n' * 10_000

    def stamped(seconds):
        message = JointState(name=['valve'], position=[1e-4])
        message.header.stamp.sec = seconds
        return message
    bad = {
        'not finite': [
            (publisher, message(data=value)) for value in (math.nan, math.inf, -math.inf)
            for publisher, message in (
                (spool, Float64), (load, Float64),
                (array, lambda data: Float64MultiArray(data=[data])))
        ] + [(joints, JointState(name=['valve'], position=[math.inf]))],
        'wrong length': [
            (array, Float64MultiArray()), (array, Float64MultiArray(data=[0.5, 0.5]))],
        'duplicate joint name': [
            (joints, JointState(name=['valve', 'valve'], position=[1e-4, 1e-4])),
            (joints, JointState(name=['valve', '', ''], position=[1e-4, 1e-4, 1e-4])),
            (joints, JointState(name=[long_name] * 2 + ['valve'], position=[1e-4] * 3))],
        'index beyond the array': [
            (joints, JointState(name=['piston', 'valve'], position=[1e-4])),
            (joints, JointState(name=['valve']))],
        'unreadable': [
            (joints, b'\x00\x01\x00\x00' + b'\xff' * 40), (array, bytes(range(200))),
            (joints, serialize_message(JointState(name=['valve'], position=[1e-4]))[:-40]),
            (spool, b'\x07' * 12), (load, b'\x00\x01\x00\x00\x01')],
        'too large': [
            (array, Float64MultiArray(data=[0.5] * 10_000)),
            (joints, JointState(name=['valve'], position=[1e-4] * 10_000))],
        'stale stamp': [(joints, stamped(-1)), (joints, stamped(1))],
        'stamp in the future': [(joints, stamped(2**31 - 1))],
    }
    harmless = [
        (joints, JointState(name=['valve'], position=[math.nan])),
        (joints, JointState(name=['piston'], position=[1e-4])),
        (joints, JointState(name=[long_name, ''], position=[1e-4, 1e-4])),
        (joints, JointState(position=[1e-4])),
    ]
    # Best effort may lose the first of a publisher, depth 1 keeps the last of a burst only.
    for _ in range(3):
        for publisher, message in [one for group in bad.values() for one in group] + harmless:
            publisher.publish(message)
            peer.spin(0.03)
    peer.send(array, Float64MultiArray(data=[0.5] * 1_000_000),
              lambda: latest(heard, 'Command')[1]['last_rejection'].startswith('too large: 800'))

    def count(reason):
        return int(latest(heard, 'Command')[1].get(f'rejected: {reason}', 0))
    peer.until(lambda: all(count(reason) >= 2 * len(bad[reason]) for reason in bad))
    status, _ = latest(heard, 'Command')
    assert status.level == b'\x01'
    assert 'message dropped' in status.message
    node.end()
    assert 'Traceback' not in node.text and 'remaining buffer' not in node.text
    assert max(map(len, node.text.splitlines())) < 400
    recording = load_recording(node.recording)
    taken = sum(
        topic.count for name, topic in recording.topics.items()
        if name.endswith(('command', 'commands', 'load_force')))
    values = last_values(recording, 'Command')
    assert values['accepted'] == values['clamped'] == '0'
    assert {key.removeprefix('rejected: ') for key in values if ': ' in key} - set(bad) == {
        f'publishers: {topic}'
        for topic in ('~/spool_command', '~/commands', 'joint_commands', '~/load_force')}
    # What cannot be read is counted, and not recorded.
    unread = int(values['rejected: unreadable']) + int(values['rejected: too large'])
    assert int(values['rejected']) + int(values['without_command']) == taken + unread
    assert len(recording.applied[1]) == 1
    ticks = len(recording.row_stamps) - 1
    undisturbed = replayed(recording, ticks)
    for column in (recording.channels.POSITION, recording.channels.VELOCITY,
                   recording.channels.EFFORT):
        assert np.array_equal(undisturbed[:, column], recording.rows[1:, column])
    assert np.array_equal(undisturbed[:, recording.channels.pressure],
                          recording.rows[1:, recording.channels.pressure])


def test_commands_hold_are_clamped_and_recorded_as_they_came(node_process, peer):
    node = node_process('-p', 'command.scale:=10.0')
    applied = peer.hear(Float64MultiArray, '/actuator/applied')
    array = peer.publisher(Float64MultiArray, '/actuator/commands')
    joints = peer.publisher(JointState, '/joint_commands')
    sent = Float64MultiArray(data=[2.5])
    peer.send(array, sent, lambda: applied and applied[-1].data[1] == 0.25)
    full = JointState(name=['valve', 'x'], position=[-1.0])
    peer.send(joints, full, lambda: applied[-1].data[1] == -1.0)
    # It is the arrival that counts, unless asked otherwise: a stamp may be of any clock.
    for seconds, spool in ((-1, 0.5), (2**31 - 1, -0.5)):
        full.header.stamp.sec, full.position = seconds, [5e-4 * spool]
        peer.send(joints, full, lambda spool=spool: applied[-1].data[1] == spool)
    node.end()
    recording = load_recording(node.recording)
    assert recording.applied[1][:, 1].tolist() == [0.0, 0.25, -1.0, 0.5, -0.5]
    for _, _, data in _raw(node.recording, '/actuator/commands'):
        assert deserialize_message(data, Float64MultiArray) == sent
    values = last_values(recording, 'Command')
    own = recording.messages('/joint_commands')
    assert int(values['clamped']) == sum(one['position'] == [-1.0] for one in own)
    assert int(values['accepted']) == sum(
        recording.topics[name].count for name in ('/joint_commands', '/actuator/commands'))


def _raw(path, topic):
    with AnyReader([path]) as reader:
        own = [one for one in reader.connections if one.topic == topic]
        yield from [(one, stamp, bytes(data)) for one, stamp, data in reader.messages(own)]


def test_live_parameters_act_and_are_recorded_others_are_refused_while_active(
        node_process, peer):
    node = node_process()
    states = peer.hear(FluidPressure, '/actuator/pressure/O')
    peer.until(lambda: states)
    refused = set_parameter(peer, 'cylinder.mass', Parameter.Type.DOUBLE, 20.0)
    assert not refused.successful
    assert 'cylinder.mass' in refused.reason and 'active' in refused.reason
    refused = set_parameter(peer, 'supply.pressure', Parameter.Type.DOUBLE, math.nan)
    assert not refused.successful
    assert set_parameter(peer, 'supply.pressure', Parameter.Type.INTEGER, 18_000_000).successful
    peer.until(lambda: abs(states[-1].fluid_pressure - 18e6 - 101325.0) < 1.0)
    joints = peer.hear(JointState, '/joint_states')
    peer.until(lambda: joints and joints[-1].name == ['piston', 'valve'])
    assert set_parameter(
        peer, 'command.piston_joint', Parameter.Type.STRING, 'rod').successful
    peer.until(lambda: joints[-1].name == ['rod', 'valve'])
    node.end()
    recording = load_recording(node.recording)
    events = list(recording.messages('/parameter_events'))
    assert [one['name'] for event in events for one in event['changed_parameters']] == [
        'supply.pressure', 'command.piston_joint']


def test_pause_step_reset_and_resume(node_process, peer):
    node = node_process()
    states = peer.hear(JointState, '/joint_states')
    command = peer.publisher(Float64, '/actuator/spool_command')
    peer.until(lambda: states)
    peer.send(command, Float64(data=0.5), lambda: states[-1].position[1] > 0.0)
    assert not peer.call(Trigger, '/actuator/step').success
    assert peer.call(SetBool, '/actuator/pause', data=True).success
    peer.spin(0.2)
    silent, last = len(states), states[-1]
    peer.spin(0.2)
    assert len(states) == silent
    assert peer.call(Trigger, '/actuator/step').success
    peer.until(lambda: len(states) == silent + 1)
    assert _stamp(states[-1]) == _stamp(last) + PERIOD_NS
    assert states[-1].position[0] != last.position[0]
    assert peer.call(Trigger, '/actuator/reset').success
    peer.until(lambda: len(states) == silent + 2)
    assert states[-1].position == pytest.approx([0.0, 0.0], abs=0.0)
    assert peer.call(SetBool, '/actuator/pause', data=False).success
    peer.until(lambda: len(states) > silent + 100)
    assert states[-1].position[1] == 0.0
    assert np.all(np.diff([_stamp(state) for state in states]) >= PERIOD_NS)
    node.end()
    # Pauses and the reset included, the run can be repeated.
    assert Replay(node.recording).compare().identical


def test_emergency_stop_centres_the_valve_and_drains_the_supply(node_process, peer):
    node = node_process()
    states = peer.hear(JointState, '/joint_states')
    pressures = peer.hear(FluidPressure, '/actuator/pressure/O')
    heard = peer.hear(DiagnosticArray, '/diagnostics')
    command = peer.publisher(Float64, '/actuator/spool_command')
    peer.send(
        command, Float64(data=0.2), lambda: states and states[-1].position[1] > 0.0)
    assert peer.call(SetBool, '/actuator/enable', data=False).success
    peer.until(lambda: states[-1].position[1] == 0.0)
    command.publish(Float64(data=0.2))
    peer.until(lambda: abs(pressures[-1].fluid_pressure - 2.5e6 - 101325.0) < 1.0)
    assert states[-1].position[1] == 0.0
    peer.until(lambda: 'emergency stop' in latest(heard, 'Solver')[0].message)
    assert peer.call(SetBool, '/actuator/enable', data=True).success
    peer.until(lambda: abs(pressures[-1].fluid_pressure - 21e6 - 101325.0) < 1.0)
    node.end()


def test_recordings_end_and_begin_on_request_and_qos_overrides_hold(node_process, peer):
    override = 'qos_overrides./joint_states.publisher.reliability:=best_effort'
    node = node_process('-p', override)
    peer.until(lambda: peer.node.count_publishers('/joint_states'))
    offered, = peer.node.get_publishers_info_by_topic('/joint_states')
    assert offered.qos_profile.reliability == ReliabilityPolicy.BEST_EFFORT
    first = node.recording
    assert peer.call(SetBool, '/actuator/record', data=False).success
    assert load_recording(first).finished
    answer = peer.call(SetBool, '/actuator/record', data=True)
    assert answer.success
    peer.spin(0.3)
    node.end()
    second = answer.message.removeprefix('recording to ')
    assert second != str(first)
    assert len(load_recording(second).applied[1]) == 1
    assert len(load_recording(second).row_stamps) > 100


def _stamp(state):
    return state.header.stamp.sec * 10**9 + state.header.stamp.nanosec


def test_two_nodes_run_side_by_side_in_their_namespaces(node_process, peer):
    nodes = [node_process('-r', f'__ns:=/{name}') for name in ('left', 'right')]
    left = peer.hear(JointState, '/left/joint_states')
    right = peer.hear(JointState, '/right/joint_states')
    command = peer.publisher(Float64, '/left/actuator/spool_command')
    peer.until(lambda: left and right)
    peer.send(command, Float64(data=1.0), lambda: left[-1].position[1] > 0.0)
    assert right[-1].position[1] == 0.0
    assert [node.end()[0] for node in nodes] == [0, 0]
    assert nodes[0].recording.name.startswith('left_actuator_')
    assert '/left/actuator/pressure/A' in load_recording(nodes[0].recording).topics
    received = list(_raw(nodes[0].recording, '/left/actuator/spool_command'))
    assert {decode(FLOAT64, data)['data'] for _, _, data in received} == {1.0}


def test_several_nodes_that_command_the_valve_are_named(node_process, peer):
    node = node_process()
    heard = peer.hear(DiagnosticArray, '/diagnostics')
    rival = rclpy.create_node('rival', namespace='/other', context=peer.node.context)
    spool = peer.publisher(Float64, '/actuator/spool_command')
    array = rival.create_publisher(Float64MultiArray, '/actuator/commands', 10)
    peer.send(spool, Float64(data=0.1), lambda: '/peer' in latest(
        heard, 'Command')[1].get('publishers: ~/spool_command', ''))
    assert latest(heard, 'Command')[0].message == 'commands are obeyed'

    def told():
        spool.publish(Float64(data=0.1))
        status, values = latest(heard, 'Command')
        return status.message == 'several nodes command the valve: /other/rival, /peer'
    peer.send(array, Float64MultiArray(data=[0.2]), told)
    status, values = latest(heard, 'Command')
    assert status.level == b'\x01'
    assert values['publishers: ~/commands'] == '/other/rival'
    # One falls silent: it is over.
    peer.send(spool, Float64(data=0.1),
              lambda: latest(heard, 'Command')[0].message == 'commands are obeyed')
    rival.destroy_node()
    node.end()
