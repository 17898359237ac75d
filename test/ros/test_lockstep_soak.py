# SPDX-License-Identifier: Apache-2.0
"""
A thousand periods in lockstep: same commands, same bits, whatever happens to either side.

Prints the rates of the round trip (-s).
"""

import hashlib
import math
import signal
import threading
import time

from hydra_actuator import load_recording
from hydra_actuator.cli.main import main
from hydra_actuator.ros.client import LockstepClient
import numpy as np
import pytest
import rclpy
from rclpy.executors import SingleThreadedExecutor
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64, Float64MultiArray

COUNT = 1000
LOCKSTEP = ('-p', 'timing.mode:=lockstep', '-p', 'solver.cells:=200')
pytestmark = pytest.mark.soak


def command(k):
    return math.sin(0.05 * k) * math.cos(0.003 * k)


def trace(path):
    """Return the digest of all states of a recording, pressures and velocities among them."""
    recording = load_recording(path)
    rows = recording.rows
    used = rows[:, [recording.channels.POSITION, recording.channels.VELOCITY,
                    recording.channels.EFFORT]]
    digest = hashlib.sha256(recording.row_stamps.tobytes())
    for part in (used, rows[:, recording.channels.pressure],
                 rows[:, recording.channels.flow_velocity]):
        digest.update(np.ascontiguousarray(part).tobytes())
    return len(rows), digest.hexdigest()


def stepped(node_process, peer, between=lambda client, node, k: None):
    """Run a node for COUNT commands; return its recording and the rate of steps [1/s]."""
    node = node_process(*LOCKSTEP)
    with LockstepClient(peer.node) as client:
        client.connect()
        begin = time.monotonic()
        for k in range(COUNT):
            between(client, node, k)
            client.step(command(k))
        rate = COUNT / (time.monotonic() - begin)
    assert node.end()[0] == 0
    return node.recording, rate


def stop_for_a_while(client, node, k):
    if k == COUNT // 2:
        node.popen.send_signal(signal.SIGSTOP)
        threading.Timer(2.5, node.popen.send_signal, [signal.SIGCONT]).start()


def slowly(client, node, k):
    time.sleep(2e-3)


def test_same_commands_give_same_bits_at_any_speed_and_stopped_in_between(
        node_process, peer, capsys):
    runs = {name: stepped(node_process, peer, between) for name, between in {
        'first': lambda *_: None, 'second': lambda *_: None, 'third': lambda *_: None,
        'slow': slowly, 'stopped': stop_for_a_while}.items()}
    traces = {name: trace(path) for name, (path, _) in runs.items()}
    with capsys.disabled():
        for name, (_, rate) in runs.items():
            print(f'\n{name}: {rate:.0f} steps/s, {traces[name]}', end='')
    assert {count for count, _ in traces.values()} == {COUNT + 1}
    assert len(set(traces.values())) == 1
    assert main(['simulate', '--replay', str(runs['stopped'][0])]) == 0
    assert 'bit-identical' in capsys.readouterr().out


class Rubbish:
    """Sends what is to be dropped, between the commands."""

    def __init__(self, node):
        self._spool = node.create_publisher(Float64, '/actuator/spool_command', 100)
        self._array = node.create_publisher(Float64MultiArray, '/actuator/commands', 100)
        self._joints = node.create_publisher(JointState, '/joint_commands', 100)
        self._load = node.create_publisher(Float64, '/actuator/load_force', 100)
        inf, nan, name = math.inf, math.nan, 'valve'
        self.dropped = [
            *((self._spool, Float64(data=value)) for value in (nan, inf, -inf)),
            *((self._load, Float64(data=value)) for value in (nan, inf)),
            *((self._array, Float64MultiArray(data=data)) for data in (
                [], [0.1, 0.2], [nan], [inf], np.zeros(10**6).tolist())),
            *((self._joints, JointState(name=names, position=positions)) for names, positions in (
                ([name, name], [1e-4, 1e-4]), (['x', name], [1e-4]), ([name], []),
                ([name], [inf]))),
        ]
        self.without_command = [
            (self._joints, JointState(name=names, position=positions)) for names, positions in (
                ([], []), (['unknown'], [1e-4]), ([''], [1e-4]), (['x' * 10_000], [1e-4]),
                ([name], [nan]))]

    def send(self, k):
        """Send the k-th of all kinds."""
        kinds = self.dropped + self.without_command
        publisher, message = kinds[k % len(kinds)]
        publisher.publish(message)

    @property
    def known(self):
        return all(one.get_subscription_count()
                   for one in (self._spool, self._array, self._joints, self._load))


def test_messages_that_are_dropped_leave_no_trace(node_process, peer):
    clean, _ = stepped(node_process, peer)
    rubbish = Rubbish(peer.node)
    sent = []

    def between(client, node, k):
        if not sent:
            peer.until(lambda: rubbish.known)
            time.sleep(1.0)
        rubbish.send(k)
        sent.append(k)

    dirty, _ = stepped(node_process, peer, between)
    assert trace(dirty) == trace(clean)
    values = next(
        {one['key']: one['value'] for one in status['values']}
        for message in reversed(list(load_recording(dirty).messages('/diagnostics')))
        for status in message['status'] if status['name'].endswith(': Command'))
    kinds = len(rubbish.dropped) + len(rubbish.without_command)
    dropped = sum(k % kinds < len(rubbish.dropped) for k in range(COUNT))
    assert int(values['rejected']) == dropped
    assert int(values['without_command']) == COUNT - dropped
    assert int(values['accepted']) == COUNT


@pytest.mark.parametrize('seconds', [0, 2**31 - 1])
def test_the_stamp_of_a_command_is_not_looked_at(node_process, peer, seconds):
    node = node_process(*LOCKSTEP)
    states = peer.hear(JointState, '/joint_states')
    joints = peer.node.create_publisher(JointState, '/joint_commands', 100)
    peer.until(lambda: states and joints.get_subscription_count())
    peer.spin(1.0)
    for first in range(0, COUNT, 50):
        for _ in range(50):
            message = JointState(name=['valve'], position=[1e-4])
            message.header.stamp.sec = seconds
            joints.publish(message)
        peer.until(lambda wanted=first + 50: _last(states) >= wanted)
    assert node.end()[0] == 0
    assert len(load_recording(node.recording).row_stamps) == COUNT + 1


def _last(states):
    stamp = states[-1].header.stamp
    return round((stamp.sec - 1) * 1000 + stamp.nanosec * 1e-6)


def test_a_client_of_plain_rclpy_does_a_thousand_periods(node_process, domain, capsys):
    node = node_process(*LOCKSTEP)
    context = rclpy.Context()
    rclpy.init(context=context, args=[])
    own = rclpy.create_node('plain', context=context)
    executor = SingleThreadedExecutor(context=context)
    executor.add_node(own)
    states = []
    own.create_subscription(JointState, 'joint_states', states.append, 10)
    publisher = own.create_publisher(Float64MultiArray, '/actuator/commands', 10)
    end = time.monotonic() + 60.0
    while not states or not publisher.get_subscription_count():
        assert time.monotonic() < end
        executor.spin_once(timeout_sec=0.1)
    begin = time.monotonic()
    for k in range(COUNT):
        publisher.publish(Float64MultiArray(data=[command(k)]))
        while _last(states) < k + 1:
            assert time.monotonic() < begin + 300.0, k
            executor.spin_once(timeout_sec=1.0)
    rate = COUNT / (time.monotonic() - begin)
    with capsys.disabled():
        print(f'\nplain rclpy: {rate:.0f} steps/s', end='')
    executor.shutdown()
    own.destroy_node()
    rclpy.try_shutdown(context=context)
    assert node.end()[0] == 0
    assert len(load_recording(node.recording).row_stamps) == COUNT + 1
