# SPDX-License-Identifier: Apache-2.0
"""`simulate`: what it records, what it refuses without a trace, and how Ctrl-C ends it."""

import os
from pathlib import Path
import pty
import signal
import subprocess
import sys
import time

from hydra_actuator.cli.main import main
from hydra_actuator.recording.reader import load_recording
import numpy as np
import pytest
from rosbags.rosbag2 import Reader
from rosbags.typesys import get_typestore, Stores

ROOT = Path(__file__).parents[2]
QUICK = 'solver: {cells: 60}'


def config(tmp_path, text):
    """Return a parameter file that holds these parameters, in YAML's flow style."""
    path = tmp_path / 'actuator.yaml'
    path.write_text(f'/**:\n  ros__parameters:\n    {text}\n')
    return str(path)


def started(*arguments, **streams):
    """Start `hydra_actuator simulate` as a process that takes Ctrl-C as on a terminal."""
    return subprocess.Popen(
        [sys.executable, '-m', 'hydra_actuator', 'simulate', *map(str, arguments)], cwd=ROOT,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL), **streams)


def refused(tmp_path, capsys, *arguments, output=None):
    """Run to be refused; return the one line, and see that nothing was written."""
    before = sorted(tmp_path.rglob('*'))
    output = tmp_path / 'new' / 'run' if output is None else output
    assert main(['simulate', *map(str, arguments), '-o', str(output)]) == 2
    assert sorted(tmp_path.rglob('*')) == before
    told = capsys.readouterr()
    assert told.out == ''
    assert told.err.startswith('hydra_actuator simulate: ')
    assert told.err.count('\n') == 1
    return told.err


def test_a_run_says_where_its_recording_is(tmp_path, capsys):
    output = tmp_path / 'new' / 'run'
    assert main(['simulate', '--config', config(tmp_path, QUICK), '--sine', '50', '--duration',
                 '0.02', '-o', str(output)]) == 0
    told = capsys.readouterr()
    assert told.out == f'0.02 s simulated, recorded in {output}\n'
    assert told.err == ''
    recording = load_recording(output)
    assert recording.time == pytest.approx(np.arange(21) / 1000)
    assert recording.custom_data['source'] == 'simulate'


@pytest.mark.parametrize('options, spool', [
    ([], [0, 0, 0, 0, 0]), (['--step'], [1, 1, 1, 1, 1]),
    (['--step', '--amplitude', '-0.5'], [-0.5, -0.5, -0.5, -0.5, -0.5]),
    (['--sine', '250'], [0, 1, 0, -1, 0]),
    (['--sine', '250', '--amplitude', '0.5'], [0, 0.5, 0, -0.5, 0]),
    (['--chirp', '250', '250'], [0, 1, 0, -1, 0]),
    (['--command', 'linear.csv'], [0, 0, 0.5, 1, 1]),
    (['--command', 'linear.csv', '--hold'], [0, 0, 0, 1, 1]),
])
def test_the_command_is_that_of_the_options(tmp_path, monkeypatch, capsys, options, spool):
    monkeypatch.chdir(tmp_path)
    (tmp_path / 'linear.csv').write_text('time,spool\n0.001,0\n0.003,1\n')
    assert main(['simulate', '--config', config(tmp_path, QUICK), *options, '--duration', '0.004',
                 '-o', 'run']) == 0
    stamps, applied = load_recording('run').applied
    times = np.arange(5) * 1_000_000
    latest = np.searchsorted(stamps, times, 'right') - 1
    assert applied[latest, 1] == pytest.approx(np.array(spool), abs=1e-9)


def test_the_command_file_says_how_long_and_how_much_load(tmp_path, capsys):
    (tmp_path / 'c.csv').write_text('time,spool,load_force\n0,0.5,0\n0.006,0.5,600\n')
    assert main(['simulate', '--config', config(tmp_path, QUICK), '--command',
                 str(tmp_path / 'c.csv'), '-o', str(tmp_path / 'run')]) == 0
    recording = load_recording(tmp_path / 'run')
    assert recording.end_ns == 6_000_000
    load = recording.rows[:, recording.channels.LOAD_FORCE]
    assert load == pytest.approx(np.arange(7) * 100.0)


def test_later_parameter_files_win(tmp_path, capsys):
    first = config(tmp_path, 'supply: {pressure: 1.0e7, max_flow: 0.001}')
    second = tmp_path / 'second.yaml'
    second.write_text('/**:\n  ros__parameters:\n    supply.pressure: 9.0e6\n')
    assert main(['simulate', '--config', first, '--config', str(second), '--duration', '0.001',
                 '-o', str(tmp_path / 'run')]) == 0
    text = load_recording(tmp_path / 'run').custom_data['parameters']
    assert 'pressure: 9000000.0' in text
    assert 'max_flow: 0.001' in text


@pytest.mark.parametrize('text, culprits', [
    ('supply: {presure: 1.0e7}', ['supply.presure', 'supply.pressure']),
    ('colour: red', ['colour']),
    ('supply: {pressure: high}', ['supply.pressure', 'high']),
    ('supply: {pressure: true}', ['supply.pressure', 'true']),
    ('supply: {pressure: [1.0e7]}', ['supply.pressure']),
    ('supply: {pressure: .nan}', ['supply.pressure', 'nan']),
    ('supply: {pressure: .inf}', ['supply.pressure', 'inf']),
    ('supply: {pressure: -1.0}', ['supply.pressure', '-1']),
    ('solver: {cells: 60.5}', ['solver.cells', '60.5']),
    ('solver: {cells: 3}', ['solver.cells', '3', '20']),
    ('solver: {interpolation: quintic}', ['solver.interpolation', 'quintic', 'cubic']),
    ('initial: {position: 0.5}', ['initial.position', '0.5', 'cylinder.stroke']),
    ('sections: {names: [A, A]}', ['sections.names', 'A']),
    ('line_1: {length: 0.002}', ['line_1', '0.002', 'solver.cells']),
    ('supply: {pressure: 1.0e7', ['not YAML', 'line']),
])
def test_a_parameter_that_cannot_be_is_refused_by_name_and_value(tmp_path, capsys, text,
                                                                 culprits):
    line = refused(tmp_path, capsys, '--config', config(tmp_path, text))
    for culprit in culprits:
        assert culprit in line


@pytest.mark.parametrize('make, culprit', [
    (lambda path: None, 'No such file'), (lambda path: path.mkdir(), 'directory'),
    (lambda path: path.write_text(''), 'ros__parameters'),
    (lambda path: path.write_bytes(b'\x89PNG\xff\x00'), 'UTF-8'),
    (lambda path: path.write_text('supply: {pressure: 1.0e7}'), 'ros__parameters'),
])
def test_a_file_without_parameters_is_refused(tmp_path, capsys, make, culprit):
    path = tmp_path / 'given.yaml'
    make(path)
    line = refused(tmp_path, capsys, '--config', path)
    assert str(path) in line
    assert culprit in line


@pytest.mark.parametrize('text, culprit', [
    (None, 'No such file'), ('', 'is empty'), (b'\x89PNG\xff\x00', 'no CSV text'),
    ('time,spool\n', 'no rows'), ('time,spol\n0,0\n', 'spol'),
    ('time,spool\n0,0\n0,1\n', 'line 3: time 0 s does not increase'),
    ('time,spool\n0,nan\n', 'line 2: spool'), ('time,spool\n0,1.5\n', 'line 2: spool 1.5'),
    ('time,spool\n0,0.5\n', 'say --duration'),
])
def test_a_file_without_commands_is_refused(tmp_path, capsys, text, culprit):
    path = tmp_path / 'given.csv'
    if text is not None:
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
    line = refused(tmp_path, capsys, '--command', path)
    assert str(path) in line
    assert culprit in line


@pytest.mark.parametrize('options, culprit', [
    (['--duration', 'nan'], '--duration nan'), (['--duration', '-1'], '--duration -1'),
    (['--duration', '0'], '--duration 0'), (['--duration', 'inf'], '--duration inf'),
    (['--duration', 'long'], "--duration: invalid float value: 'long'"),
    (['--rate', '0'], '--rate 0'), (['--rate', 'nan'], '--rate nan'),
    (['--sine', '-3'], '--sine -3'), (['--sine', 'nan'], '--sine nan'),
    (['--chirp', '1', 'inf'], '--chirp inf'), (['--chirp', '1'], '--chirp'),
    (['--step', '--amplitude', '1.1'], '--amplitude 1.1'),
    (['--step', '--amplitude', 'nan'], '--amplitude nan'),
    (['--amplitude', '0.5'], '--amplitude goes with'), (['--hold'], '--hold goes with'),
    (['--step', '--sine', '1'], 'not allowed with'), (['--colour', 'red'], '--colour'),
])
def test_an_option_that_cannot_be_is_refused(tmp_path, capsys, options, culprit):
    assert culprit in refused(tmp_path, capsys, *options)


@pytest.mark.parametrize('output, culprit', [
    ('', 'exists already'), ('file', 'file exists already'), ('link', 'link exists already'),
    ('file/run', 'file is not a directory'), ('link/run', 'link is not a directory'),
    ('/proc/run', '/proc/run'), ('x' * 300, 'name too long'),
    (os.fsdecode(b'\xff'), 'not UTF-8'),
])
def test_an_output_that_cannot_be_made_is_refused(tmp_path, monkeypatch, capsys, output, culprit):
    monkeypatch.chdir(tmp_path)
    (tmp_path / 'file').write_text('mine')
    (tmp_path / 'link').symlink_to('nowhere')
    assert culprit in refused(tmp_path, capsys, output=output)
    assert (tmp_path / 'file').read_text() == 'mine'


def test_an_output_in_a_directory_without_write_permission_is_refused(tmp_path, monkeypatch,
                                                                      capsys):
    monkeypatch.setattr(os, 'access', lambda path, mode: False)
    assert f'{tmp_path} is not writable' in refused(tmp_path, capsys)


def test_an_output_that_is_missing_is_asked_for(capsys):
    assert main(['simulate']) == 2
    assert '-o/--output' in capsys.readouterr().err


def test_a_refusal_of_the_process_is_one_line_and_no_traceback(tmp_path):
    process = started('--config', config(tmp_path, 'supply: {presure: 1}'), '-o',
                      tmp_path / 'run', stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    out, error = process.communicate(timeout=60)
    assert process.returncode == 2
    assert out == ''
    assert error.count('\n') == 1
    assert 'supply.presure' in error
    assert not (tmp_path / 'run').exists()


def test_a_run_that_breaks_off_says_why_and_keeps_what_was_recorded(tmp_path, capsys):
    slow = config(tmp_path, 'solver: {cells: 60, max_mach: 0.002}')
    (tmp_path / 'c.csv').write_text('time,spool\n0,0\n0.01,0\n0.02,1\n')
    assert main(['simulate', '--config', slow, '--command', str(tmp_path / 'c.csv'), '--duration',
                 '1', '-o', str(tmp_path / 'run')]) == 1
    told = capsys.readouterr()
    assert told.out == ''
    assert told.err.count('\n') == 1
    assert 'exceeds solver.max_mach 0.002' in told.err
    recording = load_recording(tmp_path / 'run')
    assert recording.finished
    assert len(recording.rows) > 10


def wait_for_messages(file, process):
    """Return when a file has grown beyond its head; fail if the process ends before."""
    deadline = time.monotonic() + 120.0
    while not (file.exists() and file.stat().st_size > 300_000):
        assert process.poll() is None
        assert time.monotonic() < deadline
        time.sleep(0.01)


def opened_by_rosbags(directory):
    """Return the stamps of the joint states as an independent reader finds them."""
    store = get_typestore(Stores.ROS2_JAZZY)
    with Reader(directory) as reader:
        (joints,) = [c for c in reader.connections if c.topic == '/joint_states']
        read = [(stamp, store.deserialize_cdr(data, connection.msgtype))
                for connection, stamp, data in reader.messages([joints])]
    stamps = [stamp for stamp, _ in read]
    assert stamps == [m.header.stamp.sec * 10**9 + m.header.stamp.nanosec for _, m in read]
    return stamps


def test_ctrl_c_ends_a_run_with_a_finished_recording_and_code_130(tmp_path):
    output = tmp_path / 'run'
    with started('--config', config(tmp_path, QUICK), '--sine', 50, '--duration', 1e5, '-o',
                 output, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        try:
            wait_for_messages(output / 'run_0.mcap', process)
            process.send_signal(signal.SIGINT)
            out, error = process.communicate(timeout=10)
        finally:
            process.kill()
    assert (process.returncode, out, error) == (130, '', '')
    recording = load_recording(output)
    assert recording.finished
    stamps = opened_by_rosbags(output)
    assert stamps == list(range(0, recording.end_ns + 1, 1_000_000))
    assert len(stamps) > 50


def test_a_terminal_sees_progress_that_is_wiped_away_at_the_end(tmp_path):
    ours, theirs = pty.openpty()
    process = started('--config', config(tmp_path, QUICK), '--duration', 0.3, '-o',
                      tmp_path / 'run', stdout=subprocess.PIPE, stderr=theirs, text=True)
    os.close(theirs)
    shown = b''
    try:
        while part := os.read(ours, 4096):
            shown += part
    except OSError:
        # Linux reports so that the other side has closed.
        assert process.wait(timeout=60) == 0
    finally:
        os.close(ours)
    assert process.communicate()[0].startswith('0.3 s simulated')
    assert b'\rsimulate [' in shown
    assert b'%' in shown
    assert shown.endswith(b'\r\x1b[2K')
    assert b'\n' not in shown
