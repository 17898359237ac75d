# SPDX-License-Identifier: Apache-2.0
"""An offline run: its instants, its command at every step, and what stays when it breaks off."""

import math
import os
from pathlib import Path
import signal
import subprocess
import sys

from hydra_actuator.actuator import Actuator, SolverError
from hydra_actuator.channels import Channels
from hydra_actuator.errors import InputError
from hydra_actuator.parameters import ParameterError, Parameters
from hydra_actuator.recording.reader import load_recording
from hydra_actuator.recording.writer import RecordingError
from hydra_actuator.signals import Hold, Sine, Step, Table
from hydra_actuator.simulate import simulate
import numpy as np
import pytest

# Coarse and quick: what is tested here does not depend on the mesh.
QUICK = Parameters({'solver.cells': 60})
STEP_TIME = Actuator(QUICK).step_time
SINE = Sine(50.0)


def stamps_due(rate, duration):
    """Return the stamps [ns] of the first steps not before the output instants."""
    instants = np.arange(math.floor(duration * rate) + 1) / rate
    steps = np.unique(np.ceil(instants / STEP_TIME - 1e-6))
    return np.round(steps * STEP_TIME * 1e9).astype(int)


@pytest.mark.parametrize('rate', [1.0, 48.0, 700.0, 1000.0, 1024.0, 16000.0, 24000.0])
def test_an_output_instant_between_two_steps_is_the_next_step(rate):
    times = simulate(QUICK, SINE, 0.03, rate=rate).rows[:, Channels.TIME]
    assert np.round(times * 1e9).astype(int).tolist() == stamps_due(rate, 0.03).tolist()


@pytest.mark.parametrize('rate', [48000.0, 1e6, 1e300])
def test_outputs_faster_than_the_steps_are_one_per_step(rate):
    times = simulate(QUICK, SINE, 0.005, rate=rate).rows[:, Channels.TIME]
    assert 1.0 / STEP_TIME < rate
    assert times.tolist() == (np.arange(len(times)) * STEP_TIME).tolist()
    assert times[-1] == pytest.approx(0.005)


def test_a_rate_slower_than_anything_gives_the_initial_state_only():
    assert len(simulate(QUICK, SINE, 0.005, rate=5e-324).rows) == 1


def test_the_initial_state_is_the_first_record_at_time_zero(tmp_path):
    run = simulate(QUICK, Hold(1.0), 0.002, tmp_path / 'run')
    rest = Actuator(QUICK).state
    assert run.rows[0, Channels.TIME] == 0.0
    assert run.rows[0, Channels.POSITION] == rest.position
    assert run.rows[0, run.channels.pressure].tolist() == list(rest.pressure.values())
    recording = load_recording(tmp_path / 'run')
    assert recording.start_ns == 0
    assert {s.stamps[0] for s in recording._series.values() if len(s)} == {0}


def test_a_run_of_no_duration_is_the_initial_state():
    assert simulate(QUICK, duration=0.0).rows.shape == (1, Actuator(QUICK).channels.width)


def test_two_runs_give_the_same_bits():
    rows = [simulate(QUICK, SINE, 0.02).rows for _ in range(2)]
    assert rows[0].tobytes() == rows[1].tobytes()


@pytest.mark.parametrize('rate, every', [(500.0, 2), (250.0, 4)])
def test_the_rate_of_the_outputs_changes_no_state(rate, every):
    rows = simulate(QUICK, SINE, 0.02).rows
    assert simulate(QUICK, SINE, 0.02, rate=rate).rows.tobytes() == rows[::every].tobytes()


def test_a_rate_off_the_grid_changes_no_state():
    rows = [simulate(QUICK, SINE, 0.02, rate=rate).rows for rate in (1000.0, 700.0)]
    assert rows[0][0].tobytes() == rows[1][0].tobytes()
    assert rows[0][10].tobytes() == rows[1][7].tobytes()


@pytest.mark.parametrize('spools', [1, 2])
@pytest.mark.parametrize('compression', ['none', 'zstd'])
def test_the_recording_holds_the_rows_of_a_run_without_one(tmp_path, spools, compression):
    parameters = QUICK.replace({'valve.spools': spools, 'recording.compression': compression})
    command = Table(np.array([0.0, 0.01, 0.02]), np.array([0.0, 1.0, -1.0]),
                    np.array([500.0, -900.0, 0.0]))
    expected = simulate(parameters, command, 0.02).rows
    run = simulate(parameters, command, 0.02, tmp_path / 'run')
    assert run.recording == tmp_path / 'run'
    assert run.kept_rows is None
    assert load_recording(run.recording).custom_data['parameters'] == parameters.as_yaml()
    assert run.rows.shape == expected.shape
    # Stamps are whole nanoseconds; no topic carries the Mach number, nor cavities without gas.
    assert np.abs(run.rows[:, 0] - expected[:, 0]).max() <= 0.5e-9
    other = np.delete(np.arange(run.channels.cavity_volume), [Channels.TIME, Channels.MACH])
    assert np.array_equal(run.rows[:, other], expected[:, other])


def test_cavities_are_recorded_only_where_they_are_modelled(tmp_path):
    torn = QUICK.replace({'tank.pressure': 0.0, 'fluid.cavitation': True})
    expected = simulate(torn, SINE, 0.03).rows
    run = simulate(torn, SINE, 0.03, tmp_path / 'torn')
    columns = run.channels
    assert np.array_equal(run.rows[:, columns.cavities], expected[:, columns.cavities])
    assert run.rows[:, columns.cavity_volume].max() > 0.0
    plain = simulate(QUICK, SINE, 0.01, tmp_path / 'plain')
    assert np.isnan(plain.rows[:, columns.cavities]).all()
    counts = [load_recording(tmp_path / name).topics['/actuator/cavities'].count
              for name in ('torn', 'plain')]
    assert counts == [31, 0]


def test_the_rate_sets_states_and_pressures_and_nothing_else(tmp_path):
    simulate(QUICK, SINE, 0.02, tmp_path / 'run', rate=100.0)
    topics = load_recording(tmp_path / 'run').topics
    counts = {name: topics[name].count for name in (
        '/joint_states', '/actuator/pressure/E', '/actuator/sections', '/actuator/field',
        '/actuator/applied')}
    assert list(counts.values()) == [3, 3, 21, 5, 21]


@pytest.mark.parametrize('command, stamps, values', [
    (Hold(0.3, 700.0), [0], [[0, 0.3, 700.0]]),
    (Step(-1.0, 0.0045), [0, 5_000_000], [[0, 0.0, 0.0], [5, -1.0, 0.0]]),
    (Table(np.array([0.002, 0.004]), np.array([0.0, 1.0]), np.zeros(2)),
     [0, 3_000_000, 4_000_000], [[0, 0.0, 0.0], [3, 0.5, 0.0], [4, 1.0, 0.0]]),
])
def test_a_command_is_recorded_when_it_has_changed(tmp_path, command, stamps, values):
    simulate(QUICK, command, 0.01, tmp_path / 'run')
    recording = load_recording(tmp_path / 'run')
    assert recording.applied[0].tolist() == stamps
    assert recording.applied[1] == pytest.approx(np.array(values))
    at, spool = recording.commands['/actuator/spool_command']
    assert at.tolist() == stamps
    assert spool[:, 0].tolist() == recording.applied[1][:, 1].tolist()
    assert recording.commands['/actuator/load_force'][0].tolist() == [0]


def test_commands_of_two_spools_are_recorded_for_each(tmp_path):
    def apart(times):
        return np.column_stack([np.full_like(times, 0.5), -times, np.zeros_like(times)])

    parameters = QUICK.replace({'valve.spools': 2, 'valve.natural_frequency': 0.0})
    run = simulate(parameters, apart, 0.003, tmp_path / 'run')
    commands = load_recording(run.recording).commands
    assert '/actuator/spool_command' not in commands
    assert commands['/actuator/commands'][1] == pytest.approx(
        np.array([[0.5, 0.0], [0.5, -0.001], [0.5, -0.002], [0.5, -0.003]]))
    # An ideal spool is where it was commanded to be.
    spools = run.rows[1:, [Channels.SPOOL_1, Channels.SPOOL_2]] / parameters['valve.stroke']
    assert spools == pytest.approx(np.array([[0.5, -0.001], [0.5, -0.002], [0.5, -0.003]]))


@pytest.mark.parametrize('hold', [True, False])
def test_a_table_is_evaluated_at_every_step(hold):
    table = Table(np.array([0.0, 0.00313, 0.00777, 0.012]), np.array([0.0, 0.9, -0.4, 0.2]),
                  np.array([0.0, 800.0, -800.0, 0.0]), hold)
    rows = simulate(QUICK, table, 0.02).rows
    actuator = Actuator(QUICK)
    commands = np.column_stack([table.spool, table.spool, table.load_force])
    assert actuator.follow((table.times, commands, hold), round(0.02 / actuator.step_time)) == 0
    # Two ways to write a straight line differ in the last place; a hold does not.
    assert rows[-1] == pytest.approx(actuator.row, rel=0.0 if hold else 1e-9,
                                     abs=0.0 if hold else 1e-12)


def test_a_held_command_does_what_advance_does():
    state = Actuator(QUICK).advance(0.01, spool=0.4, load_force=300.0)
    row = simulate(QUICK, Hold(0.4, 300.0), 0.01).rows[-1]
    assert (row[Channels.POSITION], row[Channels.VELOCITY]) == (state.position, state.velocity)


def test_a_positive_load_opposes_positive_motion():
    load = 2000.0
    free, pushed, pulled = (
        simulate(QUICK, Hold(0.5, force), 0.01).rows[-1, Channels.POSITION]
        for force in (0.0, load, -load))
    assert 0.0 < pushed < free < pulled


def broken(cells=60):
    """Return parameters whose oil soon flows faster than the step allows for."""
    return Parameters({'solver.cells': cells, 'solver.max_mach': 0.002})


def test_a_run_that_breaks_off_leaves_a_finished_recording_of_all_before(tmp_path):
    with pytest.raises(SolverError, match=r'\|u\|/c = .* exceeds solver.max_mach 0.002'):
        simulate(broken(), Step(start=0.0095), 0.1, tmp_path / 'run')
    recording = load_recording(tmp_path / 'run')
    assert recording.finished
    assert len(recording.rows) >= 10
    assert np.isfinite(recording.rows[:, :Channels.MACH]).all()
    assert recording.end_ns < 0.1e9


@pytest.fixture
def python_handler():
    """Have Python's own handler, which a process started in the background has not."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.mark.usefixtures('python_handler')
def test_an_interrupt_leaves_a_finished_recording_of_all_before(tmp_path):
    def impatient(share):
        if share > 0.001:
            signal.raise_signal(signal.SIGINT)

    with pytest.raises(KeyboardInterrupt):
        simulate(QUICK, SINE, 10.0, tmp_path / 'run', progress=impatient)
    recording = load_recording(tmp_path / 'run')
    assert recording.finished
    assert 10_000_000 <= recording.end_ns <= 12_000_000


@pytest.mark.parametrize('changes, culprit', [
    ({'duration': math.nan}, 'duration nan'), ({'duration': -1.0}, 'duration -1.0'),
    ({'duration': math.inf}, 'duration inf'), ({'rate': 0.0}, 'rate 0.0'),
    ({'rate': math.nan}, 'rate nan'), ({'rate': -5.0}, 'rate -5.0'),
    ({'command': Hold(1.5)}, r'\[1.5, 1.5, 0.0\] at 0 s'),
    ({'command': Hold(0.0, math.nan)}, 'nan'), ({'command': np.sin}, r'shape \(1,\)'),
])
def test_what_cannot_be_run_writes_nothing(tmp_path, changes, culprit):
    with pytest.raises(InputError, match=culprit):
        simulate(**{'parameters': QUICK, 'output': tmp_path / 'new' / 'run', **changes})
    assert os.listdir(tmp_path) == []


def test_a_line_too_short_for_the_mesh_writes_nothing(tmp_path):
    with pytest.raises(ParameterError, match=r'line_1.*raise solver\.cells'):
        simulate(QUICK.replace({'line_1.length': 0.002}), output=tmp_path / 'run')
    assert os.listdir(tmp_path) == []


def test_a_command_that_goes_wrong_on_the_way_is_named_with_its_time(tmp_path):
    with pytest.raises(InputError, match=r'command \[2.0, 2.0, 0.0\] at 0.005'):
        simulate(QUICK, Step(2.0, 0.005), 0.01, tmp_path / 'run')
    assert load_recording(tmp_path / 'run').finished


def test_a_recording_is_never_overwritten(tmp_path):
    simulate(QUICK, duration=0.001, output=tmp_path / 'run')
    before = (tmp_path / 'run' / 'run_0.mcap').read_bytes()
    with pytest.raises(RecordingError, match='exists already'):
        simulate(QUICK, SINE, output=tmp_path / 'run')
    assert (tmp_path / 'run' / 'run_0.mcap').read_bytes() == before


def test_progress_rises_to_one():
    shares = []
    simulate(QUICK, duration=0.01, progress=shares.append)
    assert shares == sorted(shares)
    assert shares[-1] == 1.0


@pytest.mark.parametrize('first', ['import hydra_actuator.simulate', 'import hydra_actuator'])
def test_simulate_of_the_package_is_the_function_whatever_was_imported_before(first):
    code = f'{first}\nfrom hydra_actuator import simulate\nprint(callable(simulate))'
    done = subprocess.run([sys.executable, '-c', code], capture_output=True, text=True,
                          check=True, cwd=Path(__file__).parents[1])
    assert done.stdout == 'True\n'


SENSOR = {'sensor.position_noise': 1e-5, 'sensor.pressure_noise': 2e4, 'sensor.delay': 3e-3}


def test_a_sensor_model_reads_noise_and_leaves_the_truth_beside_it(tmp_path):
    plain = simulate(QUICK, SINE, 0.02).rows
    simulate(QUICK.replace(SENSOR), SINE, 0.02, tmp_path / 'run')
    recording = load_recording(tmp_path / 'run')
    true = recording.series('/actuator/true_joint_states').numbers().reshape(len(plain), 3, -1)
    read = recording.series('/joint_states').numbers().reshape(len(plain), 3, -1)
    assert true[:, 0, 0].tolist() == plain[:, Channels.POSITION].tolist()
    noise = read[3:, 0, 0] - true[:-3, 0, 0]
    assert 0.0 < np.abs(noise).max() < 5e-5
    sections = recording.series('/actuator/sections').numbers()
    assert sections[:, 1].tolist() == plain[:, Channels(QUICK['sections.names']).pressure][
        :, 0].tolist()
    pressure = recording.series('/actuator/pressure/A').numbers()
    assert set(pressure[:, 1]) == {4e8}


def test_readings_do_not_depend_on_the_rate_at_which_they_are_written():
    parameters = QUICK.replace(SENSOR)
    slow = simulate(parameters, SINE, 0.02, rate=250.0).rows
    fast = simulate(parameters, SINE, 0.02, rate=8000.0).rows
    times = np.isin(fast[:, Channels.TIME], slow[:, Channels.TIME])
    assert fast[times].tolist() == slow.tolist()


def test_a_fault_script_acts_in_an_offline_run_and_is_told_in_its_recording(tmp_path):
    script = tmp_path / 'script.csv'
    script.write_text('time,parameter,value\n0.005,fault.pressure.A.off,true\n'
                      '0.01,fault.pressure.A.off,false\n')
    parameters = QUICK.replace({'fault.enabled': True, 'fault.script': str(script)})
    simulate(parameters, SINE, 0.015, tmp_path / 'run')
    recording = load_recording(tmp_path / 'run')
    pressure = recording.series('/actuator/pressure/A').numbers()[:, 0]
    assert np.flatnonzero(np.isnan(pressure)).tolist() == [5, 6, 7, 8, 9]
    assert len(recording.series('/actuator/true_joint_states')) == 5
    told = [(message['header']['stamp']['nanosec'], status['level'], status['name'],
             status['message']) for message in recording.messages('/actuator/events')
            for status in message['status']]
    assert told == [
        (5_000_000, 1, '/actuator: Faults', 'fault.pressure.A.off = true'),
        (10_000_000, 0, '/actuator: Faults', 'fault.pressure.A.off ended')]
    plain = simulate(QUICK, SINE, 0.015).rows
    assert recording.rows[:, Channels.POSITION].tolist() == plain[:, Channels.POSITION].tolist()


def test_a_bad_fault_script_is_refused_before_anything_is_written(tmp_path):
    script = tmp_path / 'script.csv'
    script.write_text('time,parameter,value\n1,fault.leekage,1e-12\n')
    parameters = QUICK.replace({'fault.enabled': True, 'fault.script': str(script)})
    with pytest.raises(InputError, match=r'script\.csv, line 2: unknown parameter .*leekage'):
        simulate(parameters, SINE, 0.01, tmp_path / 'run')
    assert not (tmp_path / 'run').exists()
