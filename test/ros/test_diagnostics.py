# SPDX-License-Identifier: Apache-2.0
"""What /diagnostics say of one running node, and when."""

from diagnostic_msgs.msg import DiagnosticArray
from hydra_actuator import __version__
from lifecycle_msgs.msg import Transition
from lifecycle_msgs.srv import ChangeState
from std_msgs.msg import Float64

# A collector that is frozen after all imports leaves at least so many objects alone.
MANY = 10_000


def values_of(message, part):
    return next(
        {one.key: one.value for one in status.values}
        for status in message.status if status.name == f'/actuator: {part}')


def level_of(message, part):
    return next(one.level for one in message.status if one.name == f'/actuator: {part}')


def stamp(message):
    return message.header.stamp.sec + 1e-9 * message.header.stamp.nanosec


def test_a_running_node_tells_a_rig_operator_how_it_stands(node_process, peer):
    node = node_process('-p', 'timing.cpu_affinity:=[0]')
    heard = peer.hear(DiagnosticArray, '/diagnostics')
    command = peer.publisher(Float64, '/actuator/spool_command')
    peer.until(lambda: heard)
    assert values_of(heard[-1], 'Command')['command_age'] == 'no command yet'
    peer.send(command, Float64(data=0.3), lambda: (
        values_of(heard[-1], 'Command')['received'] != '0'))
    count = len(heard)
    peer.until(lambda: len(heard) > count)
    regular = heard[-1]
    command.publish(Float64(data=float('nan')))
    peer.until(lambda: level_of(heard[-1], 'Command') == b'\x01')
    first = next(one for one in heard if level_of(one, 'Command') == b'\x01')
    # At once: the next regular one would have come a second after the last.
    assert stamp(first) - stamp(regular) < 0.9
    peer.spin(1.2)
    last = heard[-1]

    real_time = values_of(last, 'Real time')
    assert int(real_time['ticks']) > 0
    assert float(real_time['lateness_p50']) <= float(real_time['lateness_p99.9'])
    assert float(real_time['lateness_p99.9']) <= float(real_time['lateness_max'])
    assert float(real_time['execution_p50']) > 0.0
    assert real_time['cpu_affinity_requested'] == real_time['cpu_affinity_obtained'] == '0'
    assert int(real_time['collector_frozen_objects']) > MANY

    commands = values_of(last, 'Command')
    assert int(commands['received']) == int(commands['accepted']) + int(commands['rejected'])
    assert 1 <= int(commands['applied']) <= int(commands['accepted'])
    assert commands['rejected: not finite'] == commands['rejected'] == '1'
    assert float(commands['command_age']) > 1.0

    solver = values_of(last, 'Solver')
    assert solver['state'] == 'active' and solver['mode'] == 'realtime'
    assert 0.0 < float(solver['largest_mach']) < float(solver['max_mach'])
    assert 0.5 < float(solver['courant']) <= 1.0
    assert solver['version: hydra_actuator'] == __version__
    assert len(solver['parameter_hash']) == 16
    assert float(solver['mass_passed']) > 0.0
    assert 0.0 < abs(float(solver['mass_residual'])) < 1e-3 * float(solver['mass_passed'])

    recorder = values_of(last, 'Recorder')
    on_disk = sum(file.stat().st_size for file in node.recording.iterdir())
    assert 0 < int(recorder['bytes']) <= on_disk
    assert int(recorder['written']) > 0 and recorder['dropped'] == '0'
    assert int(recorder['free_disk_bytes']) > 0

    for transition in (Transition.TRANSITION_DEACTIVATE, Transition.TRANSITION_CLEANUP):
        assert peer.call(ChangeState, '/actuator/change_state',
                         transition=Transition(id=transition)).success
    peer.until(lambda: values_of(heard[-1], 'Solver')['state'] == 'unconfigured')
    peer.spin(1.1)
    assert values_of(heard[-1], 'Real time')['collector_frozen_objects'] == '0'
    assert values_of(heard[-1], 'Solver')['rmw'].startswith('rmw_')
