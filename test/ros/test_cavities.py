# SPDX-License-Identifier: Apache-2.0
"""Oil that boils, as those see it who look at the node: topic, diagnostics, events, recording."""

import math
import time

from diagnostic_msgs.msg import DiagnosticArray
from hydra_actuator import load_recording
from hydra_actuator.recording.messages import decode, FLOAT64_ARRAY
from hydra_actuator.ros import statuses
from hydra_actuator.tally import Cavities
import numpy as np
import pytest
from std_msgs.msg import Float64, Float64MultiArray

TORN = ('-p', 'fluid.cavitation:=true', '-p', 'tank.pressure:=0.0')


def drive(peer, seconds):
    """Command a full-stroke sine of 50 Hz, twenty messages a period."""
    command = peer.publisher(Float64, '/actuator/spool_command')
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        command.publish(Float64(data=math.sin(100.0 * math.pi * time.monotonic())))
        time.sleep(1e-3)


def solver_statuses(heard):
    """Return (level, message, values) of all statuses of the solver."""
    return [(status.level, status.message, {one.key: one.value for one in status.values})
            for message in heard for status in message.status
            if status.name == '/actuator: Solver']


def test_a_node_whose_oil_boils_warns_tells_of_it_and_records_it(node_process, peer):
    node = node_process(*TORN)
    topic = peer.hear(Float64MultiArray, '/actuator/cavities')
    diagnostics = peer.hear(DiagnosticArray, '/diagnostics')
    events = peer.hear(DiagnosticArray, '/actuator/events')
    peer.until(lambda: topic and diagnostics)
    drive(peer, 1.5)
    peer.until(lambda: any(level == b'\x01' for level, _, _ in solver_statuses(diagnostics)))
    assert node.end()[0] == 0

    names = topic[0].layout.dim[0].label.split(',')
    assert names[0] == 'cavity_volume'
    assert max(message.data[1] for message in topic) > 1e-7
    warned = [(message, values) for level, message, values in solver_statuses(diagnostics)
              if level == b'\x01']
    assert 'the oil boils' in warned[-1][0]
    assert int(warned[-1][1]['cavities_opened']) >= 1
    assert float(warned[-1][1]['largest_cavity_volume']) > 1e-7
    told = [message for _, message, _ in solver_statuses(events)]
    assert 'cavity opened' in told
    assert 'cavity collapsed' in told
    # each kind ten times a second at most, over the whole run
    assert told.count('cavity opened') <= 10 * 4

    recording = load_recording(node.recording)
    stamps, values = recording.cavities
    assert len(stamps) == len(recording.row_stamps)
    columns = recording.channels
    assert values[:, 0].max() > 1e-7
    counts = values[:, 2:5]
    assert (counts[:, 0] == counts[:, 1] - counts[:, 2]).all()
    assert counts[-1, 1] >= int(warned[-1][1]['cavities_opened'])
    assert np.array_equal(recording.rows[:, columns.cavity_volume], values[:, 0])
    assert set(map(len, (decode(FLOAT64_ARRAY, data)['data'] for data in topic._received))) == {12}


def test_a_plain_node_below_vacuum_says_what_to_do_and_has_no_cavities(node_process, peer):
    node = node_process('-p', 'tank.pressure:=0.0')
    events = peer.hear(DiagnosticArray, '/actuator/events')
    drive(peer, 0.7)
    peer.until(lambda: any(message == statuses.VACUUM for _, message, _ in
                           solver_statuses(events)))
    assert node.end()[0] == 0
    recording = load_recording(node.recording)
    assert recording.topics['/actuator/cavities'].count == 0
    values = [{one['key']: one['value'] for one in status['values']}
              for message in recording.messages('/diagnostics') for status in message['status']
              if status['name'] == '/actuator: Solver']
    assert values[-1]['cavitation'] == 'off'
    assert int(values[-1]['ticks_below_vacuum']) > 0


@pytest.mark.parametrize('cavities, vacuum, on, recently, level, words', [
    (Cavities(0, 0, 0, 0.0), 0, True, (False, False), statuses.OK, ''),
    (Cavities(2, 7, 5, 3e-6), 0, True, (False, False), statuses.WARN, '2 cavities open, 7 opened'),
    (Cavities(0, 7, 7, 3e-6), 0, True, (True, False), statuses.WARN, '0 cavities open, 7 opened'),
    (Cavities(0, 7, 7, 3e-6), 0, True, (False, False), statuses.OK, ''),
    (Cavities(0, 0, 0, 0.0), 3, False, (False, True), statuses.WARN, 'fluid.cavitation on'),
    (Cavities(0, 0, 0, 0.0), 3, False, (False, False), statuses.OK, ''),
])
def test_boiling_is_a_warning_while_and_shortly_after_it_lasts(
        cavities, vacuum, on, recently, level, words):
    status = statuses.oil(cavities, vacuum, on, recently)
    assert status.level == level
    assert words in status.message
