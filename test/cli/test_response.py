# SPDX-License-Identifier: Apache-2.0
"""`hydra_actuator response` prints the table, writes pictures and CSV, refuses rubbish."""

from hydra_actuator.cli.main import main
import pytest

FILES = {'bode_velocity.png', 'bode_pressure.png', 'stiffness.png', 'valve_null.png',
         'response.csv'}


def run(capsys, *arguments):
    """Return (exit code, stdout, stderr) of the verb."""
    code = main(['response', *arguments])
    captured = capsys.readouterr()
    return code, captured.out, captured.err


def test_it_prints_the_table_and_writes_all_files(capsys, tmp_path):
    out = tmp_path / 'made' / 'here'
    code, text, errors = run(capsys, '--config', 'config/paper.yaml', '--no-solver',
                             '--points', '60', '-o', str(out))
    assert (code, errors) == (0, '')
    assert {path.name for path in out.iterdir()} == FILES
    assert text.startswith('operating point\n')
    assert '175.79' in text


def test_a_moving_piston_needs_no_solver_and_says_so(capsys, tmp_path):
    code, text, _ = run(capsys, '--spool', '0.2', '--position', '0.01', '--points', '60',
                        '-o', str(tmp_path))
    assert code == 0
    assert 'note: the solver is left out' in text


@pytest.mark.parametrize(('arguments', 'message'), [
    (['--spool', '2'], '--spool 2 is not within -1 to 1'),
    (['--spool', 'nan'], '--spool nan is not within -1 to 1'),
    (['--spool', '0.1', '0.2'], '--spool takes one number per spool'),
    (['--load', 'inf'], '--load inf is not a finite number'),
    (['--position', '0.5'], 'beyond the stops'),
    (['--from', '10', '--to', '5'], 'no range of frequencies'),
    (['--points', '1'], '--points 1 is not within'),
    (['--config', '/nowhere.yaml'], '/nowhere.yaml'),
    (['-o', '/dev/null/x'], 'cannot be a directory'),
    (['--spool', '1', '--position', '0', '--load', '3e4'], 'the oil cavitates')])
def test_rubbish_is_refused_in_one_line(capsys, tmp_path, arguments, message):
    code, text, errors = run(capsys, '-o', str(tmp_path), *arguments)
    assert (code, text) == (2, '')
    assert message in errors
    assert errors.count('\n') == 1
