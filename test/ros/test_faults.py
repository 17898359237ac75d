# SPDX-License-Identifier: Apache-2.0
"""Sensors and faults of a running node, over DDS: the truth beside the readings, loud, cleared."""

import math

from diagnostic_msgs.msg import DiagnosticArray
from hydra_actuator import load_parameters, load_recording, simulate
from rcl_interfaces.srv import GetParameters, SetParametersAtomically
from rclpy.parameter import Parameter
from sensor_msgs.msg import FluidPressure, JointState
from std_srvs.srv import SetBool, Trigger

SCRIPT = ('time,parameter,value\n0.05,fault.null_shift,0.25\n0.1,fault.position.noise,1e-6\n'
          '0.15,fault.pressure.E.stuck,true\n')
INSTRUMENTS = {
    'sensor.position_noise': 1e-6, 'sensor.pressure_noise': 2e4, 'sensor.delay': 0.002}
COUNTED = 300


def set_parameters(peer, changes):
    return peer.call(
        SetParametersAtomically, '/actuator/set_parameters_atomically',
        parameters=[Parameter(name, value=value).to_parameter_msg()
                    for name, value in changes.items()]).result


def get_parameters(peer, *names):
    return peer.call(GetParameters, '/actuator/get_parameters', names=names).values


def faults_status(heard):
    """Return (level, message, values) of the newest status of faults."""
    for message in reversed(heard):
        for status in message.status:
            if status.name == '/actuator: Faults':
                return (status.level, status.message,
                        {one.key: one.value for one in status.values})
    return None, '', {}


def readings(recording, topic):
    """Return the numbers of a topic's first messages, bit by bit, stamps left out."""
    return [row.tobytes() for row in recording.series(topic).numbers()[:COUNTED]]


def test_a_scripted_run_of_the_node_has_the_bits_of_an_offline_one(
        node_process, peer, tmp_path):
    (tmp_path / 'script.csv').write_text(SCRIPT)
    faults = {**INSTRUMENTS, 'fault.enabled': True, 'fault.script': str(tmp_path / 'script.csv')}
    node = node_process(*(
        word for name, value in faults.items()
        for word in ('-p', f'{name}:={str(value).lower() if value is True else value}')))
    truth = peer.hear(JointState, '/actuator/true_joint_states')
    pressure = peer.hear(FluidPressure, '/actuator/pressure/A')
    heard = peer.hear(DiagnosticArray, '/diagnostics')
    peer.until(lambda: 'fault.pressure.E.stuck' in faults_status(heard)[1] and truth and pressure)
    assert faults_status(heard)[0] == b'\x01'
    assert faults_status(heard)[2]['fault.null_shift'] == '0.25'
    assert pressure[-1].variance == 4e8
    assert truth[-1].name == ['piston', 'valve']
    assert node.end()[0] == 0

    simulate(load_parameters(overrides={'solver.cells': 100, **faults}), None, COUNTED * 1e-3,
             tmp_path / 'offline')
    online, offline = load_recording(node.recording), load_recording(tmp_path / 'offline')
    for topic in ('/joint_states', '/actuator/true_joint_states', '/actuator/pressure/E',
                  '/actuator/pressure/A'):
        assert len(readings(offline, topic)) == COUNTED
        assert readings(online, topic) == readings(offline, topic)
    for recording in (online, offline):
        events = [status for message in recording.messages('/actuator/events')
                  for status in message['status'] if status['name'] == '/actuator: Faults']
        assert [event['message'] for event in events] == [
            'fault.null_shift = 0.25', 'fault.position.noise = 1e-06',
            'fault.pressure.E.stuck = true']
        assert {event['level'] for event in events} == {1}


def test_faults_are_live_loud_and_cleared_and_the_emergency_stop_lasts(node_process, peer):
    node = node_process('-p', 'fault.enabled:=true')
    states = peer.hear(JointState, '/joint_states')
    truth = peer.hear(JointState, '/actuator/true_joint_states')
    heard = peer.hear(DiagnosticArray, '/diagnostics')
    events = peer.hear(DiagnosticArray, '/actuator/events')
    peer.until(lambda: states and faults_status(heard)[1] == 'no faults')
    assert not truth

    refused = set_parameters(peer, {'fault.null_shift': 0.1, 'fault.leakage': 1.0})
    assert not refused.successful
    assert 'fault.leakage out of range' in refused.reason
    assert set_parameters(peer, {'fault.script': '/nowhere.csv'}).reason.startswith(
        '/nowhere.csv cannot be read')
    assert not set_parameters(peer, {'fault.enabled': False, 'fault.leakage': 1e-12}).successful

    assert set_parameters(peer, {
        'fault.null_shift': 0.5, 'fault.position.off': True,
        'fault.velocity.offset': 100.0}).successful
    peer.until(lambda: states[-1].velocity[0] > 50.0)
    both = [(math.isnan(state.position[0]), state.velocity[0] > 50.0) for state in states]
    assert {*both} == {(False, False), (True, True)}
    peer.until(lambda: len(truth) > 10)
    assert abs(truth[-1].velocity[0]) < 50.0 and not math.isnan(truth[-1].position[0])
    peer.until(lambda: faults_status(heard)[0] == b'\x01')
    assert faults_status(heard)[1] == (
        'at work: fault.null_shift, fault.position.off, fault.velocity.offset')

    answer = peer.call(Trigger, '/actuator/reset')
    assert answer.success, node.text
    peer.until(lambda: math.isnan(states[-1].position[0]))
    assert peer.call(Trigger, '/actuator/clear_faults').success
    peer.until(lambda: not math.isnan(states[-1].position[0]))
    shift, off = get_parameters(peer, 'fault.null_shift', 'fault.position.off')
    assert (shift.double_value, off.bool_value) == (0.0, False)
    peer.until(lambda: faults_status(heard)[1] == 'no faults')
    told = [status.message for message in events for status in message.status]
    assert told.count('fault.null_shift = 0.5') == told.count('fault.null_shift ended') == 1

    assert peer.call(SetBool, '/actuator/enable', data=False).success
    assert peer.call(SetBool, '/actuator/pause', data=True).success
    assert peer.call(SetBool, '/actuator/pause', data=False).success
    assert peer.call(Trigger, '/actuator/reset').success
    pressures = peer.hear(FluidPressure, '/actuator/pressure/O')
    peer.until(lambda: pressures and abs(pressures[-1].fluid_pressure - 2601325.0) < 1.0)
    assert node.end()[0] == 0
    recording = load_recording(node.recording)
    kept = [status['message'] for message in recording.messages('/actuator/events')
            for status in message['status']]
    assert 'emergency stop: valve centred, supply off' in kept
    assert 'fault.velocity.offset = 100' in kept
    changed = [one['name'] for message in recording.messages('/parameter_events')
               for one in message['changed_parameters']]
    assert changed.count('fault.position.off') == 2
