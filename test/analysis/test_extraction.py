# SPDX-License-Identifier: Apache-2.0
"""A recording gives back the series it was written from."""

from dataclasses import replace

from hydra_actuator.analysis.extraction import series_of
from hydra_actuator.errors import InputError
from hydra_actuator.recording import messages
from hydra_actuator.recording.topics import ActuatorTopics
from hydra_actuator.recording.writer import RecordingWriter
import numpy as np
import pytest


def test_a_recorded_run_comes_back_whole(make_run, record):
    run = make_run(0.1, 200)
    found = series_of(record(run))
    for name in ('time', 'position', 'velocity', 'spool', 'pressure', 'flow_velocity', 'stamps',
                 'section_positions', 'load_force'):
        np.testing.assert_allclose(getattr(found, name), getattr(run, name), rtol=1e-12)
    assert found.section_names == run.section_names
    assert (found.source, found.versions, found.name) == ('node', run.versions, 'made_run')
    assert found.parameters == run.parameters
    np.testing.assert_allclose(found.send_delay, run.send_delay, atol=1e-9)


def test_the_field_comes_back_with_its_gaps(make_run, record):
    run = make_run(0.1, 200)
    found = series_of(record(run)).field
    assert found.faces == run.field.faces
    assert found.labels == run.field.labels
    np.testing.assert_allclose(found.time, run.field.time, atol=1e-9)
    np.testing.assert_allclose(found.pressure, run.field.pressure, rtol=1e-6)


def test_commands_and_diagnostics_come_back_with_their_times(make_run, record):
    run = make_run(1.0, 200)
    found = series_of(record(run))
    (command,) = found.commands
    assert command.topic == '/actuator/spool_command'
    np.testing.assert_allclose(command.values, run.commands[0].values)
    np.testing.assert_allclose(command.time, run.commands[0].time, atol=1e-9)
    assert [r.values for r in found.diagnostics] == [r.values for r in run.diagnostics]
    assert [r.time for r in found.diagnostics] == pytest.approx([1, 2, 3])


def test_joint_commands_are_read_by_name_over_the_stroke(tmp_path):
    topics = ActuatorTopics('/actuator', ())
    stamp = 1_700_000_000_000_000_000
    parameters = '/**:\n  ros__parameters:\n    valve: {stroke: 5.0e-4}\n'
    with RecordingWriter(tmp_path / 'joints', topics.all(), {'parameters': parameters}) as writer:
        state = messages.JointStateEncoder(['piston_joint', 'valve_joint'])
        writer.write(topics.joint_states, stamp, stamp,
                     state.encode(stamp, [0, 0], [0, 0], [0, 0]))
        command = messages.JointStateEncoder(['other', 'valve_joint'])
        writer.write(topics.joint_commands, stamp, stamp,
                     command.encode(stamp, [9.0, 2.5e-4], [0, 0], [0, 0]))
    (found,) = series_of(tmp_path / 'joints').commands
    np.testing.assert_allclose(found.values, [[0.5]])


def test_a_recording_without_states_is_refused_by_name(tmp_path):
    RecordingWriter(tmp_path / 'empty', ActuatorTopics().all()).close()
    with pytest.raises(InputError, match='empty holds no joint states'):
        series_of(tmp_path / 'empty')


def test_a_field_that_does_not_fit_its_positions_is_refused(make_run, record):
    run = make_run(0.02, 200)
    odd = replace(run, field=replace(run.field, labels=run.field.labels[:-1]))
    with pytest.raises(InputError, match='labels for'):
        series_of(record(odd))


def test_unreadable_parameters_are_refused(tmp_path):
    topics = ActuatorTopics()
    with RecordingWriter(tmp_path / 'odd', topics.all(), {'parameters': 'a: [1'}) as writer:
        state = messages.joint_state(1, ['p', 'v'], [0, 0], [0, 0], [0, 0])
        writer.write(topics.joint_states, 1, 1, state)
    with pytest.raises(InputError, match='odd: its parameters are not readable'):
        series_of(tmp_path / 'odd')
