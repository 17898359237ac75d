# SPDX-License-Identifier: Apache-2.0
"""kill -9 of a subscriber, of the commander, and of the node itself: what was promised holds."""

import os
import signal
import subprocess
import sys

from hydra_actuator import load_recording
from hydra_actuator.cli.main import main
import numpy as np
import pytest
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64MultiArray

PERIOD_NS = 1_000_000
FLUSH_PERIOD = 0.5
# What a recording may lose besides [s].
MARGIN = 0.2
COMMANDER = """
import rclpy, time
from std_msgs.msg import Float64
rclpy.init()
node = rclpy.create_node('commander')
publisher = node.create_publisher(Float64, '/actuator/spool_command', 10)
while True:
    # What is applied is told when it changes: who was not yet found then hears of the next change.
    publisher.publish(Float64(data=0.25 - 0.05 * (int(time.monotonic()) % 2)))
    time.sleep(0.01)
"""
SUBSCRIBER = """
import rclpy
from sensor_msgs.msg import JointState
rclpy.init()
node = rclpy.create_node('listener')
heard = []
node.create_subscription(
    JointState, '/joint_states', lambda state: heard or heard.append(print('heard', flush=True)),
    10)
rclpy.spin(node)
"""


@pytest.fixture
def script(domain):
    """Start Python programs on the test's domain; they end with the test."""
    processes = []

    def start(text):
        processes.append(subprocess.Popen(
            [sys.executable, '-c', text], stdout=subprocess.PIPE, stdin=subprocess.DEVNULL))
        return processes[-1]
    yield start
    for process in processes:
        process.kill()
        process.wait()
        process.stdout.close()


def stamp(state):
    return state.header.stamp.sec * 10**9 + state.header.stamp.nanosec


def test_nothing_that_dies_takes_more_with_it_than_was_said(
        node_process, peer, script, capsys):
    node = node_process(
        '-p', 'command.timeout:=0.5', '-p', 'command.on_timeout:=centre',
        '-p', f'recording.flush_period:={FLUSH_PERIOD}')
    states = peer.hear(JointState, '/joint_states')
    applied = peer.hear(Float64MultiArray, '/actuator/applied')
    subscriber, commander = script(SUBSCRIBER), script(COMMANDER)
    assert subscriber.stdout.readline() == b'heard\n'
    peer.until(lambda: applied and applied[-1].data[1] > 0.0, 30.0)

    # A reliable subscriber that takes nothing any more holds nobody up.
    subscriber.kill()
    count = len(states)
    peer.until(lambda: len(states) > count + 500)
    assert applied[-1].data[1] > 0.0

    # Without its commander the valve goes where it was told to go, once the time is over.
    commander.kill()
    last = applied[-1].data[0]
    peer.until(lambda: applied[-1].data[1] == 0.0)
    assert applied[-1].data[0] > last
    assert node.popen.poll() is None

    node.popen.send_signal(signal.SIGKILL)
    assert node.popen.wait() == -signal.SIGKILL
    peer.spin(0.2)
    recording = load_recording(node.recording)
    assert not recording.finished
    stamps = recording.row_stamps
    lost = (stamp(states[-1]) - stamps[-1]) / 1e9
    print(f'lost {lost:.3f} s of {len(stamps) / 1e3:.1f} s')
    assert lost <= FLUSH_PERIOD + MARGIN
    assert np.all(np.diff(stamps) % PERIOD_NS == 0)
    assert recording.applied[1][-1][1] == 0.0 or lost > 0.0
    capsys.readouterr()
    assert main(['info', str(node.recording)]) == 0
    told = capsys.readouterr()
    assert 'finished    no: its end is missing\n' in told.out
    assert told.err == ''
    # The next one begins a recording of its own beside it.
    again = node_process()
    assert again.recording != node.recording
    assert again.end()[0] == 0
    assert load_recording(again.recording).finished
    assert not load_recording(node.recording).finished
    assert os.path.samefile(again.recording.parent, node.recording.parent)
