# SPDX-License-Identifier: Apache-2.0
"""`report`: what it writes, and what it refuses without touching a file."""

from hydra_actuator.cli.main import main
from hydra_actuator.recording import messages
from hydra_actuator.recording.topics import ActuatorTopics
from hydra_actuator.recording.writer import RecordingWriter
import pytest


@pytest.fixture
def recording(tmp_path):
    """Return a recording of two states: no field, no sections, no diagnostics."""
    topics = ActuatorTopics()
    with RecordingWriter(tmp_path / 'run', topics.all()) as writer:
        for stamp in (0, 1_000_000):
            state = messages.joint_state(stamp, ['piston', 'valve'], [0.01, 0], [0, 0], [0, 0])
            writer.write(topics.joint_states, stamp, stamp, state)
    return tmp_path / 'run'


def test_a_bare_recording_still_gives_a_page_that_says_what_is_missing(recording, capsys):
    page = recording.parent / 'report.html'
    assert main(['report', str(recording), '-o', str(page)]) == 0
    assert str(page) in capsys.readouterr().out
    text = page.read_text(encoding='utf-8')
    for key in ('field', 'sections', 'real_time'):
        assert f'data-missing="{key}"' in text
    assert 'id="piston"' in text


def test_an_earlier_report_is_replaced_and_nothing_left_beside_it(recording):
    page = recording.parent / 'report.html'
    for _ in range(2):
        assert main(['report', str(recording), '-o', str(page)]) == 0
    assert sorted(path.name for path in recording.parent.iterdir()) == ['report.html', 'run']


def test_any_other_file_is_left_as_it_is(recording, capsys):
    precious = recording.parent / 'thesis.html'
    precious.write_text('<p>years of work</p>')
    assert main(['report', str(recording), '-o', str(precious)]) == 2
    assert precious.read_text() == '<p>years of work</p>'
    assert 'thesis.html exists and is not a report' in capsys.readouterr().err


@pytest.mark.parametrize('given, output, culprit', [
    ('nowhere', 'report.html', 'nowhere'), ('.', 'report.html', 'is not a recording'),
    ('run', 'nowhere/report.html', 'no directory'), ('run', '.', 'is a directory'),
    ('run', 'run/metadata.yaml', 'is not a report'),
])
def test_bad_paths_are_one_line_and_exit_code_2(recording, capsys, monkeypatch, given, output,
                                                culprit):
    monkeypatch.chdir(recording.parent)
    assert main(['report', given, '-o', output]) == 2
    message = capsys.readouterr().err
    assert message.count('\n') == 1
    assert culprit in message


def test_a_second_recording_is_compared_with(recording):
    page = recording.parent / 'report.html'
    assert main(['report', str(recording), str(recording), '-o', str(page)]) == 0
    text = page.read_text(encoding='utf-8')
    assert 'id="comparison"' in text
    assert 'run and run differ' in text
    assert 'data-missing="difference_pressure"' in text


def test_the_papers_units_are_refused_without_parameters(recording, capsys):
    page = recording.parent / 'report.html'
    assert main(['report', str(recording), '-o', str(page), '--nondimensional']) == 2
    assert 'holds no parameters' in capsys.readouterr().err
    assert not page.exists()


def test_a_recording_of_one_state_gives_a_page(tmp_path):
    topics = ActuatorTopics()
    with RecordingWriter(tmp_path / 'run', topics.all()) as writer:
        state = messages.joint_state(5, ['piston', 'valve'], [0.01, 0], [0, 0], [0, 0])
        writer.write(topics.joint_states, 5, 5, state)
    page = tmp_path / 'report.html'
    assert main(['report', str(tmp_path / 'run'), '-o', str(page)]) == 0
    assert 'data-missing="stamps"' in page.read_text(encoding='utf-8')
