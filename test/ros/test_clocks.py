# SPDX-License-Identifier: Apache-2.0
"""Nodes that follow /clock, or run free, and what they say of who else gives time."""

from diagnostic_msgs.msg import DiagnosticArray
from hydra_actuator import load_recording
from hydra_actuator.replay import Replay
import numpy as np
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64
from std_srvs.srv import SetBool, Trigger

START = 1_000_000_000
PERIOD_NS = 1_000_000
WARN = b'\x01'


def stamps(states):
    return [one.header.stamp.sec * 10**9 + one.header.stamp.nanosec for one in states]


def clock(milliseconds):
    message = Clock()
    message.clock.sec, rest = divmod(milliseconds, 1000)
    message.clock.nanosec = rest * PERIOD_NS
    return message


def real_time(heard, name='Real time'):
    """Return the newest status of that name."""
    return next((status for message in reversed(heard) for status in message.status
                 if status.name.endswith(f': {name}')), None)


def obeyed(heard):
    """Tell whether a command is known to have been accepted."""
    status = real_time(heard, 'Command')
    return status is not None and {one.key: one.value for one in status.values}['accepted'] != '0'


def test_a_node_that_follows_the_clock_waits_resets_and_slips_with_it(node_process, peer):
    node = node_process(
        '-p', 'timing.mode:=follow_clock', '-p', 'use_sim_time:=true',
        '-p', 'timing.max_burst:=50')
    states = peer.hear(JointState, '/joint_states')
    heard = peer.hear(DiagnosticArray, '/diagnostics')
    time = peer.publisher(Clock, '/clock')
    peer.until(lambda: (status := real_time(heard)) and status.level == WARN
               and 'waiting for /clock' in status.message)
    assert not states
    peer.send(time, clock(5000), lambda: states)
    assert stamps(states) == [5000 * PERIOD_NS]
    peer.send(time, clock(5010), lambda: len(states) == 11)
    # A command acts as in real time; the clock stands meanwhile and nothing moves.
    command = peer.publisher(Float64, '/actuator/spool_command')
    peer.send(command, Float64(data=0.5), lambda: obeyed(heard))
    assert len(states) == 11
    peer.send(time, clock(5040), lambda: len(states) == 41)
    assert stamps(states) == [(5000 + k) * PERIOD_NS for k in range(41)]
    assert states[-1].position[0] > 0.0
    # 1000 periods forward: 50 of them are run, the last ones.
    peer.send(time, clock(6040), lambda: len(states) == 91)
    assert stamps(states)[41:] == [(6040 - k) * PERIOD_NS for k in reversed(range(50))]
    first = node.recording
    peer.send(time, clock(3000), lambda: len(states) == 92)
    assert stamps(states)[91] == 3000 * PERIOD_NS
    assert states[91].position[0] == 0.0
    peer.send(time, clock(3005), lambda: len(states) == 97)
    assert node.end()[0] == 0
    before, after = sorted(first.parent.iterdir(), key=lambda path: path.stat().st_mtime)
    assert load_recording(before).row_stamps.tolist() == stamps(states)[:91]
    assert load_recording(after).row_stamps.tolist() == stamps(states)[91:]
    assert Replay(before).compare().identical


def test_a_node_that_runs_free_loses_nothing_and_warns_of_another_clock(node_process, peer):
    node = node_process('-p', 'timing.mode:=free_run', '-p', 'publish.clock:=true')
    heard = peer.hear(DiagnosticArray, '/diagnostics')
    command = peer.publisher(Float64, '/actuator/spool_command')
    peer.until(lambda: heard)
    peer.send(command, Float64(data=0.2), lambda: obeyed(heard))
    peer.node.create_publisher(Clock, '/clock', 1)
    peer.until(lambda: (status := real_time(heard)) and status.level == WARN
               and '/clock' in status.message)
    assert peer.call(SetBool, '/actuator/pause', data=True).success
    assert peer.call(Trigger, '/actuator/step').success
    assert peer.call(SetBool, '/actuator/pause', data=False).success
    peer.spin(0.1)
    assert peer.call(Trigger, '/actuator/reset').success
    peer.spin(0.3)
    assert node.end()[0] == 0
    runs = sorted(node.recording.parent.iterdir(), key=lambda path: path.stat().st_mtime)
    assert len(runs) == 2
    for run in map(load_recording, runs):
        assert run.row_stamps[0] == START
        assert set(np.diff(run.row_stamps).tolist()) == {PERIOD_NS}
        clocks = run.series('/clock').stamps
        assert set(np.diff(clocks).tolist()) == {10 * PERIOD_NS}
    assert Replay(runs[1]).compare().identical
