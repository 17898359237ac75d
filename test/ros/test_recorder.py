# SPDX-License-Identifier: Apache-2.0
"""The recorder of a running node: a disk that fills and has room again, snapshots."""

from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from diagnostic_msgs.msg import DiagnosticArray
from hydra_actuator.parameters import load_parameters
from hydra_actuator.recording import messages
from hydra_actuator.recording.reader import load_recording
from hydra_actuator.recording.topics import Topic
from hydra_actuator.ros.recorder import Recorder
import pytest
from rcl_interfaces.msg import Parameter, ParameterType, ParameterValue
from rcl_interfaces.srv import SetParameters
from sensor_msgs.msg import JointState
from std_srvs.srv import Trigger

LEVELS = {b'\x00': 'ok', b'\x01': 'warn', b'\x02': 'error'}


@pytest.fixture
def small_disk(make_disk):
    """Give a file system of 16 MB."""
    return make_disk(16)


def recorder_status(heard):
    """Return level and message of the recorder in the last diagnostics."""
    for status in heard[len(heard) - 1].status if len(heard) else ():
        if status.name.endswith(': Recorder'):
            return LEVELS[status.level], status.message
    return '', ''


def test_a_full_disk_is_told_at_once_disturbs_no_tick_and_recording_goes_on(
        small_disk, node_process, peer):
    process = node_process(
        '-p', f'recording.directory:={small_disk}', '-p', 'recording.min_free_space:=4000000',
        '-p', 'recording.field_rate:=0.0', '-p', 'timing.period:=0.005')
    diagnostics = peer.hear(DiagnosticArray, '/diagnostics')
    states = peer.hear(JointState, '/joint_states')
    peer.until(lambda: recorder_status(diagnostics)[0] == 'ok')
    ballast = small_disk / 'ballast'
    ballast.write_bytes(bytes(12_500_000))
    peer.until(lambda: recorder_status(diagnostics)[0] == 'error')
    assert 'bytes are free on the disk, 4000000 are needed' in recorder_status(diagnostics)[1]
    before = len(states)
    peer.until(lambda: len(states) > before + 100)
    recording = load_recording(process.recording)
    assert recording.finished
    ballast.unlink()
    peer.until(lambda: recorder_status(diagnostics)[0] != 'error')
    before = len(states)
    peer.until(lambda: len(states) > before + 100)
    code, _ = process.end()
    assert code == 0, process.text
    recording = load_recording(process.recording)
    assert recording.finished
    assert len(recording.files) == 2
    # What was applied stands in the new file as well.
    assert len(load_recording(recording.files[1]).applied[0]) == 1


def test_a_node_in_snapshot_mode_writes_its_last_seconds_when_asked_and_for_a_fault(
        node_process, peer, tmp_path):
    process = node_process(
        '-p', 'recording.mode:=snapshot', '-p', 'recording.snapshot_duration:=2.0',
        '-p', 'recording.field_rate:=0.0', '-p', 'timing.period:=0.005',
        '-p', 'fault.enabled:=true')
    assert 'keeping the last 2 s for snapshots' in process.text
    events = peer.hear(DiagnosticArray, '/actuator/events')
    diagnostics = peer.hear(DiagnosticArray, '/diagnostics')
    peer.until(lambda: recorder_status(diagnostics)[0] == 'ok')
    assert not list(tmp_path.glob('actuator_*'))
    peer.spin(2.5)
    answer = peer.call(Trigger, '/actuator/snapshot')
    assert answer.success, answer.message
    path = Path(answer.message.split(': ')[1])
    peer.until(lambda: any(status.message == f'snapshot: {path}'
                           for message in events for status in message.status))
    recording = load_recording(path)
    assert recording.finished
    assert 1.5 < (recording.end_ns - recording.start_ns) / 1e9 < 2.5
    assert len(recording.applied[0]) >= 1
    assert recording.rows.shape[0] > 200
    parameter = Parameter(name='fault.valve_stuck', value=ParameterValue(
        type=ParameterType.PARAMETER_BOOL, bool_value=True))
    answer = peer.call(SetParameters, '/actuator/set_parameters', parameters=[parameter])
    assert answer.results[0].successful, answer.results[0].reason
    peer.until(lambda: any(
        pair.key == 'reason' and 'fault.valve_stuck' in pair.value
        for message in events for status in message.status for pair in status.values))
    code, _ = process.end()
    assert code == 0, process.text
    assert len(list(tmp_path.glob('actuator_*'))) == 2


def test_twenty_recorders_that_begin_at_once_each_have_a_recording_of_their_own(tmp_path):
    parameters = load_parameters(overrides={'recording.directory': str(tmp_path / 'new')})
    topic = Topic('/a', messages.FLOAT64)
    recorders = [Recorder('/actuator', parameters, [topic], {}) for _ in range(20)]
    with ThreadPoolExecutor(20) as pool:
        list(pool.map(Recorder.open, recorders))
    for number, recorder in enumerate(recorders):
        recorder.put(topic.name, number, number, messages.float64(number))
        assert recorder.close()
    assert len({recorder.path for recorder in recorders}) == 20
    for number, recorder in enumerate(recorders):
        assert load_recording(recorder.path).series(topic.name).stamps.tolist() == [number]
