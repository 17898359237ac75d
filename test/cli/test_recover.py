# SPDX-License-Identifier: Apache-2.0
"""`hydra_actuator recover`: 0 lossless, 3 lossy, 1 failed, 2 bad input, and what it says."""

from hydra_actuator.cli.main import main
from hydra_actuator.recording import messages
from hydra_actuator.recording.topics import Topic
from hydra_actuator.recording.writer import RecordingWriter
import pytest

TOPIC = Topic('/load', messages.FLOAT64)


@pytest.fixture
def run(tmp_path):
    """Return a finished recording of a hundred messages, 10 ms apart, of ten chunks."""
    with RecordingWriter(tmp_path / 'run', [TOPIC], {'source': 'node'}, chunk_size=430) as writer:
        for k in range(100):
            stamp = 10_000_000 * k
            writer.write(TOPIC.name, stamp, stamp, messages.float64(k))
    return tmp_path / 'run'


def test_an_undamaged_recording_is_lossless(run, tmp_path, capsys):
    assert main(['recover', str(run), '-o', str(tmp_path / 'out')]) == 0
    captured = capsys.readouterr()
    assert captured.err == ''
    assert captured.out.splitlines() == [
        f'recovered   100 messages of 1 topics, 0.990 s, in {tmp_path / "out"}',
        'lost        nothing of what the files held',
    ]


def test_a_cut_off_recording_is_lossy_and_says_what_it_lost(run, tmp_path, capsys):
    path = run / 'run_0.mcap'
    content = path.read_bytes()
    path.write_bytes(content[: content.rindex(messages.float64(95.0))])
    assert main(['recover', str(run), '-o', str(tmp_path / 'out')]) == 3
    lines = capsys.readouterr().out.splitlines()
    assert lines[0].startswith('recovered   90 messages of 1 topics, 0.890 s')
    assert lines[1] == 'lost        10 messages that are known of'
    assert lines[2].split() == ['/load', '10']
    assert lines[3].startswith('damage      run_0.mcap: cut-off chunk, ')
    assert lines[3].endswith(' bytes, after 0.890 s')


def test_nothing_sound_fails_in_one_line(tmp_path, capsys):
    (tmp_path / 'x.mcap').write_bytes(bytes(1000))
    assert main(['recover', str(tmp_path / 'x.mcap'), '-o', str(tmp_path / 'out')]) == 1
    assert capsys.readouterr().err.count('\n') == 1
    assert not (tmp_path / 'out').exists()


@pytest.mark.parametrize('arguments', [['nowhere', '-o', 'out'], ['run'], ['run', '-o', 'run']])
def test_bad_input_is_refused_in_one_line(run, tmp_path, capsys, monkeypatch, arguments):
    monkeypatch.chdir(tmp_path)
    assert main(['recover', *arguments]) == 2
    assert capsys.readouterr().err.count('\n') == 1
    assert not (tmp_path / 'out').exists()
