# SPDX-License-Identifier: Apache-2.0
"""What is said of a run comes back from its recording."""

from hydra_actuator import __version__, load_recording
from hydra_actuator.recording.run_data import run_data, versions
from hydra_actuator.recording.topics import ActuatorTopics
from hydra_actuator.recording.writer import RecordingWriter
import numpy as np


def test_run_data_comes_back_from_the_recording(tmp_path):
    places = np.linspace(0.0, 2.0, 7)
    data = run_data('node', '/**:\n  ros__parameters: {}\n', places[:2], places, ['line_1'] * 7)
    RecordingWriter(tmp_path / 'run', ActuatorTopics().all(), data).close()
    recording = load_recording(tmp_path / 'run')
    assert recording.custom_data == data
    assert recording.section_positions.tolist() == places[:2].tolist()
    assert recording.field_positions.tolist() == places.tolist()
    assert recording.field_labels == ['line_1'] * 7


def test_versions_name_this_package_and_numpy():
    assert versions()['hydra_actuator'] == __version__
    assert versions()['numpy'] == np.__version__
