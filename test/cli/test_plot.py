# SPDX-License-Identifier: Apache-2.0
"""`plot`: from the command line to a file, and what it refuses in one line."""

from hydra_actuator.cli.main import main
from hydra_actuator.recording import messages
from hydra_actuator.recording.topics import ActuatorTopics
from hydra_actuator.recording.writer import RecordingWriter
import pytest


@pytest.fixture(scope='module')
def recording(tmp_path_factory):
    """Return a recording of 40 states and nothing else."""
    topics, path = ActuatorTopics(), tmp_path_factory.mktemp('plot') / 'run'
    with RecordingWriter(path, topics.all()) as writer:
        for k in range(40):
            stamp = k * 1_000_000
            state = messages.joint_state(
                stamp, ['piston', 'valve'], [0.001 * k, 0], [1, 0], [0, 0])
            writer.write(topics.joint_states, stamp, stamp, state)
    return path


@pytest.mark.parametrize('options', [
    [], ['--from', '0.01', '--to', '0.02'], ['--size', '4', '3', '--dpi', '50'],
    ['--units', 'bar']])
def test_a_figure_becomes_a_file(recording, tmp_path, capsys, options):
    output = tmp_path / 'piston.png'
    assert main(['plot', str(recording), 'piston', '-o', str(output), *options]) == 0
    assert str(output) in capsys.readouterr().out
    assert output.read_bytes().startswith(b'\x89PNG')


def test_size_and_dots_per_inch_give_the_pixels(recording, tmp_path):
    output = tmp_path / 'piston.png'
    main(['plot', str(recording), 'piston', '-o', str(output), '--size', '4', '3', '--dpi', '50'])
    width, height = (int.from_bytes(output.read_bytes()[k:k + 4], 'big') for k in (16, 20))
    assert (width, height) == (200, 150)


@pytest.mark.parametrize('arguments, culprit', [
    (['nonsense', '-o', 'a.png'], 'there are surface-pressure'),
    (['piston', '-o', 'a.jpg'], '.png, .svg, .pdf'),
    (['piston', '-o', 'nowhere/a.png'], 'no directory nowhere'),
    (['piston', '-o', 'a.png', '--from', '5'], '--from 5 --to 0.039'),
    (['piston', '-o', 'a.png', '--from', 'nan'], 'not a finite number'),
    (['piston', '-o', 'a.png', '--at', '0.01'], '--at goes with'),
    (['streamline', '-o', 'a.png', '--at', '9'], '--at 9'),
    (['piston', '-o', 'a.png', '--size', '0', '3'], '--size 0'),
    (['piston', '-o', 'a.png', '--dpi', '1'], '--dpi 1'),
    (['piston', '-o', 'a.png', '--units', 'psi'], 'psi'),
    (['piston', '-o', 'a.png', '--nondimensional'], 'holds no parameters'),
    (['stations', '-o', 'a.png'], 'no sections'),
    (['surface-pressure', '-o', 'a.png'], 'neither the field nor enough stations'),
])
def test_bad_input_is_one_line_and_no_file(recording, tmp_path, monkeypatch, capsys, arguments,
                                           culprit):
    monkeypatch.chdir(tmp_path)
    assert main(['plot', str(recording), *arguments]) == 2
    message = capsys.readouterr().err
    assert message.count('\n') == 1
    assert culprit in message
    assert not list(tmp_path.iterdir())


def test_a_picture_that_fails_leaves_the_earlier_one(recording, tmp_path, monkeypatch):
    from matplotlib.figure import Figure

    output = tmp_path / 'piston.png'
    output.write_bytes(b'earlier')

    def interrupted(self, path, **_):
        path.write_bytes(b'half')
        raise KeyboardInterrupt
    monkeypatch.setattr(Figure, 'savefig', interrupted)
    assert main(['plot', str(recording), 'piston', '-o', str(output)]) == 130
    assert [one.name for one in tmp_path.iterdir()] == ['piston.png']
    assert output.read_bytes() == b'earlier'
