# SPDX-License-Identifier: Apache-2.0
"""The recorder of a running node: a disk that fills and has room again."""

import shutil
import subprocess

from diagnostic_msgs.msg import DiagnosticArray
from hydra_actuator.recording.reader import load_recording
import pytest
from sensor_msgs.msg import JointState

LEVELS = {b'\x00': 'ok', b'\x01': 'warn', b'\x02': 'error'}


@pytest.fixture
def small_disk(tmp_path):
    """Give a tmpfs of 16 MB, where this process may mount one."""
    place = tmp_path / 'disk'
    place.mkdir()
    command = ['mount', '-t', 'tmpfs', '-o', 'size=16m', 'tmpfs', str(place)]
    if shutil.which('mount') is None or subprocess.run(command, capture_output=True).returncode:
        pytest.skip('a file system cannot be mounted here')
    yield place
    subprocess.run(['umount', '-l', str(place)], check=True)


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
