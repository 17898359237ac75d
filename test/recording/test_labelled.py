# SPDX-License-Identifier: Apache-2.0
"""Labelled arrays hold what was recorded, under the names and in the units of the channels."""

import shutil

from hydra_actuator import load_recording
from hydra_actuator.channels import DOMAINS
from hydra_actuator.recording.errors import RecordingError
from hydra_actuator.recording.topics import ActuatorTopics
from hydra_actuator.recording.writer import RecordingWriter
import numpy as np
import pytest


@pytest.mark.parametrize('spools', [1, 2])
def test_states_are_those_recorded(make_recording, spools):
    made = make_recording(spools=spools)
    data, channels = load_recording(made.directory).dataset, made.channels
    assert np.array_equal(data.time, made.rows[:, channels.TIME])
    assert np.array_equal(data.stamp.values.astype(np.int64), made.stamps)
    assert np.array_equal(data.position, made.rows[:, channels.POSITION])
    assert np.array_equal(data.effort, made.rows[:, channels.EFFORT])
    assert data.spool_position.sizes == {'time': 50, 'spool': spools}
    assert np.array_equal(data.spool_position[:, 0], made.rows[:, channels.SPOOL_1])
    column = channels.pressure.start + channels.section_names.index('A')
    assert np.array_equal(data.pressure.sel(station='A'), made.rows[:, column])
    assert np.array_equal(data.flow_velocity, made.rows[:, channels.flow_velocity])
    assert np.array_equal(data.lowest_pressure, made.rows[:, channels.lowest_pressure])
    assert np.array_equal(data.domain_cavity_volume.sel(domain=DOMAINS[-1]), made.rows[:, -1])
    assert data.x.sel(station='K') == 2.0


def test_every_variable_has_a_unit_and_the_run_is_told(make_recording):
    recording = load_recording(make_recording().directory)
    for data in (recording.dataset, recording.field_dataset):
        assert all(array.attrs['units'] for array in data.data_vars.values())
        assert data.x.attrs['units'] == 'm'
        assert data.attrs['source'] == 'simulate'
        assert 'supply' in data.attrs['parameters']
    assert recording.dataset.pressure.attrs['units'] == 'Pa'
    assert recording.dataset.effort.attrs['units'] == 'N'


def test_the_command_in_force_is_the_last_applied_one(make_recording):
    data = load_recording(make_recording().directory).dataset
    held = [tick // 10 * 10 / 1000.0 for tick in range(50)]
    assert data.spool_command.sel(spool=1).values.tolist() == held


def test_the_field_has_place_domain_and_time_of_its_own(make_recording):
    made = make_recording()
    data = load_recording(made.directory).field_dataset
    assert data.pressure.sizes == {'time': 10, 'node': 7}
    assert np.array_equal(data.pressure, made.fields[:10, :, 0], equal_nan=True)
    assert np.array_equal(data.flow_velocity, made.fields[:10, :, 1], equal_nan=True)
    assert np.array_equal(data.time, made.rows[::5, made.channels.TIME])
    assert data.x.values == pytest.approx(0.1 * np.arange(7))
    assert set(data.domain.values) == {'supply_line'}


def test_several_unfinished_files_are_one_dataset(make_recording):
    made, later = make_recording(ticks=20), make_recording(name='later', ticks=40)
    content = (later.directory / 'later_0.mcap').read_bytes()
    (made.directory / 'run_1.mcap').write_bytes(content[:-500])
    shutil.rmtree(later.directory)
    data = load_recording(made.directory).dataset
    assert data.attrs['finished'] == 'no'
    assert data.sizes['time'] == 60
    assert np.array_equal(data.position[20:], later.rows[:, later.channels.POSITION])


def test_an_empty_recording_gives_empty_datasets(tmp_path):
    RecordingWriter(tmp_path / 'run', ActuatorTopics('/actuator', ('A',)).all()).close()
    recording = load_recording(tmp_path / 'run')
    assert recording.dataset.sizes['time'] == 0
    assert recording.field_dataset.sizes == {'time': 0, 'node': 0}


def test_a_field_without_places_is_refused(make_recording):
    made = make_recording()
    path = made.directory / 'metadata.yaml'
    path.write_text(path.read_text().replace('field_positions', 'other'))
    with pytest.raises(RecordingError, match='7 nodes'):
        load_recording(made.directory).field_dataset  # noqa: B018
