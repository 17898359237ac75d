# SPDX-License-Identifier: Apache-2.0
"""A node in lockstep, in a process of its own, and clients that step it over DDS."""

import hashlib
import math

from diagnostic_msgs.msg import DiagnosticArray
from hydra_actuator import Actuator, load_parameters, load_recording
from hydra_actuator.replay import Replay
from hydra_actuator.ros.client import LockstepClient
import numpy as np
import pytest
from rclpy.qos import ReliabilityPolicy
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64, Float64MultiArray
from std_srvs.srv import SetBool, Trigger

START = 1_000_000_000
PERIOD_NS = 1_000_000
LOCKSTEP = ('-p', 'timing.mode:=lockstep')


def stamp(state):
    return state.header.stamp.sec * 10**9 + state.header.stamp.nanosec


def command(k):
    return 0.3 * math.sin(0.1 * k)


def bits(rows):
    """Return the digest of a trace; equal digests are equal bits."""
    return hashlib.sha256(np.ascontiguousarray(rows).tobytes()).hexdigest()


def trace(states):
    return [(stamp(state), *state.position, state.velocity[0], state.effort[0])
            for state in states]


def offline(commands, load_force=0.0):
    """Return position, velocity and effort after each of the commands, without any middleware."""
    actuator = Actuator(load_parameters(overrides={'solver.cells': 100}))
    channels, rows = actuator.channels, []
    for spool in commands:
        assert actuator.tick_once(spool, spool, load_force) == 0
        rows.append(actuator.row[[channels.POSITION, channels.VELOCITY, channels.EFFORT]])
    return np.array(rows)


@pytest.fixture
def client(peer):
    with LockstepClient(peer.node) as client:
        yield client


def test_a_client_steps_the_node_which_gives_time_and_begins_anew_after_a_reset(
        node_process, peer, client):
    node = node_process(*LOCKSTEP)
    initial = client.connect()
    clock = peer.hear(Clock, '/clock')
    loads = peer.publisher(Float64, '/actuator/load_force')
    assert stamp(initial) == START
    assert initial.position[0] == 0.0
    # The command topics are reliable, and /clock is heard before the first command.
    endpoint, = peer.node.get_subscriptions_info_by_topic('/actuator/commands')
    assert endpoint.qos_profile.reliability == ReliabilityPolicy.RELIABLE
    peer.until(lambda: clock)
    assert clock[0].clock.sec * 10**9 + clock[0].clock.nanosec == START

    states = [client.step(command(k)) for k in range(100)]
    assert [stamp(state) for state in states] == [START + k * PERIOD_NS for k in range(1, 101)]
    expected = offline([command(k) for k in range(100)])
    got = np.array(trace(states))[:, [1, 3, 4]]
    assert bits(got) == bits(expected)
    peer.until(lambda: clock[-1].clock.nanosec == 100 * PERIOD_NS)
    # Neither a load, nor a message that is dropped, nor one without a command is a step.
    loads.publish(Float64(data=100.0))
    rejected = peer.publisher(Float64MultiArray, '/actuator/commands')
    for data in ([math.nan], [], [0.1, 0.2]):
        rejected.publish(Float64MultiArray(data=data))
    peer.spin(0.3)
    assert stamp(client.step(0.5)) == START + 101 * PERIOD_NS

    # Paused: a step is a step, a command waits.
    assert peer.call(SetBool, '/actuator/pause', data=True).success
    assert peer.call(Trigger, '/actuator/step').success
    assert peer.call(SetBool, '/actuator/pause', data=False).success
    assert stamp(client.step(0.5)) >= START + 102 * PERIOD_NS

    first = node.recording
    assert peer.call(Trigger, '/actuator/reset').success
    assert load_recording(first).finished
    assert stamp(client.connect()) == START
    again = [client.step(command(k)) for k in range(3)]
    # The load holds, everything else is as at the start.
    assert bits(np.array(trace(again))[:, [1, 3, 4]]) == bits(
        offline([command(k) for k in range(3)], 100.0))
    assert node.end()[0] == 0
    recordings = sorted(first.parent.iterdir(), key=lambda path: path.stat().st_mtime)
    before, after = (load_recording(path) for path in recordings)
    assert before.row_stamps.tolist() == [START + k * PERIOD_NS for k in range(104)]
    assert after.row_stamps[0] == START
    assert np.all(np.diff(after.row_stamps) == PERIOD_NS)
    assert after.applied[1][0].tolist()[:2] == [0.0, 0.0]
    # Everything in them has simulated time.
    assert before.end_ns == START + 103 * PERIOD_NS
    assert before.start_ns >= START
    assert all(Replay(path).compare().identical for path in recordings)


def test_a_plain_client_that_sends_at_once_has_every_message_obeyed(node_process, peer):
    node = node_process(*LOCKSTEP, '-p', 'timing.lockstep_period:=0.002')
    states = peer.hear(JointState, '/joint_states')
    sent = peer.node.create_publisher(Float64, '/actuator/spool_command', 100)
    peer.until(lambda: states and sent.get_subscription_count())
    # The node may find the publisher later than that one the node.
    peer.spin(0.5)
    for k in range(60):
        sent.publish(Float64(data=command(k)))
    peer.until(lambda: len({stamp(state) for state in states}) == 61)
    node.end()
    recording = load_recording(node.recording)
    assert recording.row_stamps.tolist() == [START + 2 * k * PERIOD_NS for k in range(61)]
    expected = offline([command(k // 2) for k in range(120)])[1::2]
    assert bits(recording.rows[1:, recording.channels.POSITION]) == bits(expected[:, 0])
    assert [row[0] for row in recording.applied[1]] == [0, *range(2, 120, 2)]


def test_free_wheeling_it_runs_until_the_first_command_and_waiting_is_told(node_process, peer):
    node = node_process(*LOCKSTEP, '-p', 'timing.free_wheel:=true', '-p', 'timing.speed:=0.1')
    events = peer.hear(DiagnosticArray, '/actuator/events')
    states = peer.hear(JointState, '/joint_states')
    command = peer.publisher(Float64, '/actuator/spool_command')
    peer.until(lambda: len(states) > 20)
    peer.send(command, Float64(data=0.5), lambda: states[-1].position[1] > 0.0)
    peer.until(lambda: any('waiting for a command' in status.message
                           for event in events for status in event.status))
    last = stamp(states[-1])
    command.publish(Float64(data=0.5))
    peer.until(lambda: stamp(states[-1]) > last)
    assert stamp(states[-1]) == last + PERIOD_NS
    assert node.end()[0] == 0
    stamps = load_recording(node.recording).row_stamps
    assert set(np.diff(stamps).tolist()) == {PERIOD_NS}
    assert Replay(node.recording).compare().identical
