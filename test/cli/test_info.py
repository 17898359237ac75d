# SPDX-License-Identifier: Apache-2.0
"""`hydra_actuator info` tells what a recording holds, and refuses what is none in one line."""

import json

from hydra_actuator.cli.main import main
from hydra_actuator.parameters import Parameters
from hydra_actuator.recording import messages
from hydra_actuator.recording.topics import ActuatorTopics
from hydra_actuator.recording.writer import RecordingWriter
import pytest

WALL = 1_763_877_600_000_000_000
TOPICS = ActuatorTopics('/ns/actuator', ('O', 'K'))


def record(directory, custom_data, start=WALL):
    """Write eleven loads, 10 ms apart, and return the writer, still open."""
    writer = RecordingWriter(directory, TOPICS.all(), custom_data)
    for tick in range(11):
        stamp = start + tick * 10_000_000
        writer.write(TOPICS.load_force, stamp, stamp, messages.float64(1.0))
    return writer


def described(path, capsys) -> str:
    """Run the verb on a path and return what it printed."""
    assert main(['info', str(path)]) == 0
    captured = capsys.readouterr()
    assert captured.err == ''
    return captured.out


def test_info_tells_times_topics_rates_parameters_and_versions(tmp_path, capsys):
    parameters = Parameters({'supply.pressure': 1.8e7, 'sections.names': ('O', 'K')})
    custom_data = {
        'parameters': parameters.as_yaml(), 'source': 'node',
        'versions': json.dumps({'hydra_actuator': '0.1.0', 'numpy': '2.0'}),
    }
    record(tmp_path / 'run', custom_data).close()
    text = described(tmp_path / 'run', capsys)
    assert f'recording   {tmp_path / "run"}\n' in text
    assert 'finished    yes\n' in text
    assert 'start       2025-11-23 06:00:00 UTC\n' in text
    assert 'duration    0.100 s\n' in text
    assert 'in 1 file\n' in text
    assert 'source      node\n' in text
    assert 'versions    hydra_actuator 0.1.0, numpy 2.0\n' in text
    (line,) = [line for line in text.splitlines() if 'load_force' in line]
    assert line.split() == ['/ns/actuator/load_force', '11', '100.0', 'Hz', messages.FLOAT64]
    (line,) = [line for line in text.splitlines() if '/ns/joint_states' in line]
    assert line.split() == ['/ns/joint_states', '0', '-', messages.JOINT_STATE]
    assert '  supply.pressure = 18000000.0  (default 21000000.0)\n' in text
    assert "  sections.names = ('O', 'K')  (default (" in text
    assert text.count('(default') == 2


def test_info_says_when_all_parameters_are_defaults(tmp_path, capsys):
    record(tmp_path / 'run', {'parameters': Parameters().as_yaml()}).close()
    assert 'parameters  all defaults\n' in described(tmp_path / 'run', capsys)


def test_info_marks_a_parameter_this_version_does_not_know(tmp_path, capsys):
    text = '/**:\n  ros__parameters:\n    supply:\n      colour: red\n'
    record(tmp_path / 'run', {'parameters': text}).close()
    assert 'supply.colour = red  (not a parameter of this version)' in described(
        tmp_path / 'run', capsys)


def test_info_reads_a_recording_without_run_data_in_simulated_time(tmp_path, capsys):
    record(tmp_path / 'run', {}, start=1_000_000_000).close()
    text = described(tmp_path / 'run', capsys)
    assert 'start       1.000 s of simulated time\n' in text
    assert 'source      unknown\n' in text
    assert 'versions    unknown\n' in text
    assert 'parameters  not recorded\n' in text


def test_info_reads_unreadable_run_data_as_such(tmp_path, capsys):
    record(tmp_path / 'run', {'parameters': 'a: [', 'versions': '[1]'}).close()
    text = described(tmp_path / 'run', capsys)
    assert 'versions    unknown\n' in text
    assert 'parameters  not readable: not YAML' in text


def test_info_tells_that_a_recording_is_unfinished(tmp_path, capsys):
    writer = record(tmp_path / 'run', {})
    writer.flush()
    assert 'finished    no: its end is missing\n' in described(tmp_path / 'run', capsys)
    writer.close()


def test_info_lists_several_files_and_tells_the_last_count_of_dropped_messages(tmp_path, capsys):
    writer = record(tmp_path / 'run', {})
    for dropped in ('3', '7'):
        status = (0, '/ns/actuator: Recorder', 'ok', 'x', {'dropped': dropped})
        stamp = WALL + int(dropped)
        writer.write(TOPICS.diagnostics, stamp, stamp, messages.diagnostic_array(stamp, [status]))
    writer.close()
    content = (tmp_path / 'run' / 'run_0.mcap').read_bytes()
    (tmp_path / 'run' / 'run_1.mcap').write_bytes(content[:-100])
    text = described(tmp_path / 'run', capsys)
    assert 'dropped     7 messages\n' in text
    assert 'in 2 files\n  run_0.mcap  0.0' in text
    assert ' MB, not finished\n' in text


def test_info_prints_all_parameters_when_asked(tmp_path, capsys):
    parameters = Parameters().as_yaml()
    record(tmp_path / 'run', {'parameters': parameters}).close()
    assert main(['info', str(tmp_path / 'run'), '--parameters']) == 0
    assert capsys.readouterr().out.endswith(f'\n\n{parameters.rstrip()}\n')


def test_info_reads_a_lone_file(tmp_path, capsys):
    record(tmp_path / 'run', {'source': 'simulate'}).close()
    assert 'source      simulate\n' in described(tmp_path / 'run' / 'run_0.mcap', capsys)


@pytest.mark.parametrize('name', ['nowhere', '.', 'text.mcap'])
def test_what_is_no_recording_is_refused_in_one_line(tmp_path, capsys, name):
    (tmp_path / 'text.mcap').write_text('not one')
    assert main(['info', str(tmp_path / name)]) == 2
    captured = capsys.readouterr()
    assert captured.out == ''
    assert captured.err.startswith('hydra_actuator info: ')
    assert str(tmp_path / name) in captured.err
    assert captured.err.count('\n') == 1


def test_info_without_a_recording_is_refused_in_one_line(capsys):
    assert main(['info']) == 2
    assert capsys.readouterr().err.count('\n') == 1
