# SPDX-License-Identifier: Apache-2.0
"""`hydra_actuator verify` shows what was expected and got, and fails when they differ."""

from dataclasses import replace
import sys

from hydra_actuator.cli.main import main
from hydra_actuator.cli.verify import table
from hydra_actuator.errors import Failure
from hydra_actuator.verification.case import Case, Row
from hydra_actuator.verification.registry import CASES
import pytest

ROW = Row('made_up', 'rise', 'Pa', 200.0, 201.0, 0.01, True, 'one part in a hundred')


@pytest.fixture
def made_up(monkeypatch):
    """Return a function that makes a case `made_up` of rows."""
    return lambda *rows: monkeypatch.setitem(
        CASES, 'made_up', Case(lambda: list(rows), 'a made-up case'))


def test_verify_prints_expected_got_tolerance_and_verdict(made_up, capsys):
    made_up(ROW)
    assert main(['verify', 'made_up']) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0].startswith('made_up: a made-up case')
    assert lines[1].split() == ['expected', 'got', 'error', 'tolerance']
    assert lines[2].split() == ['rise', '[Pa]', '200', '201', '0.005', '0.01', 'relative', 'ok']
    assert lines[3] == '1 of 1 quantities within tolerance'


def test_a_missed_tolerance_fails_and_tells_its_reason(made_up, capsys):
    made_up(ROW, replace(ROW, got=300.0), replace(ROW, got=float('nan')))
    assert main(['verify', 'made_up']) == 1
    captured = capsys.readouterr()
    assert captured.out.count('FAILED (one part in a hundred)') == 2
    assert captured.err == (
        'hydra_actuator verify: 2 of 3 quantities miss their tolerance\n')


def test_an_unknown_case_is_refused_with_the_names_there_are(capsys):
    assert main(['verify', 'joukowsky', 'jukowsky']) == 2
    captured = capsys.readouterr()
    assert captured.out == ''
    assert captured.err.startswith("hydra_actuator verify: no case 'jukowsky'; there are ")
    assert 'joukowsky' in captured.err


def test_a_table_fits_a_terminal_by_breaking_long_quantities():
    quantity = 'the rise of the pressure at the far end of the line, worst of all the steps'
    rows = [ROW, replace(ROW, quantity=quantity)]
    wide, narrow = table(rows), table(rows, 80)
    assert max(map(len, wide)) > 100
    assert len(wide) == 3
    assert max(map(len, narrow)) <= 80
    told = ' '.join(line[:34].strip() for line in narrow[2:])
    assert told == f'{quantity} [Pa]'
    assert narrow[-1].endswith('ok')


def test_a_case_that_breaks_off_fails_and_the_rest_is_computed(made_up, monkeypatch, capsys):
    def break_off():
        raise Failure('NaN in line at 0.1 s')

    made_up(ROW)
    monkeypatch.setitem(CASES, 'broken', Case(break_off, 'breaks off'))
    assert main(['verify', 'broken', 'made_up']) == 1
    captured = capsys.readouterr()
    assert 'broken: breaks off\n  FAILED: NaN in line at 0.1 s' in captured.out
    assert '1 of 1 quantities within tolerance' in captured.out
    assert captured.err == 'hydra_actuator verify: broken: not computed to the end\n'


def test_an_interrupt_ends_in_130_without_a_word(monkeypatch, capsys):
    def interrupt():
        raise KeyboardInterrupt

    monkeypatch.setitem(CASES, 'made_up', Case(interrupt, 'a made-up case'))
    assert main(['verify', 'made_up']) == 130
    captured = capsys.readouterr()
    assert captured.out == captured.err == ''


def test_on_a_terminal_the_case_in_work_is_shown_and_wiped(made_up, monkeypatch, capsys):
    made_up(ROW)
    monkeypatch.setattr(sys.stderr, 'isatty', lambda: True, raising=False)
    assert main(['verify', 'made_up']) == 0
    shown = capsys.readouterr().err
    assert 'verify, at made_up' in shown
    assert shown.endswith('\r\x1b[2K')


def test_plots_writes_a_figure_of_each_case_with_or_without_one_of_its_own(
        made_up, monkeypatch, tmp_path, capsys):
    drawn = []
    made_up(ROW, replace(ROW, got=float('nan')))
    monkeypatch.setitem(CASES, 'own', Case(lambda: [ROW], 'own', figure=drawn.append))
    output = tmp_path / 'new' / 'figures'
    assert main(['verify', 'made_up', 'own', '--plots', str(output)]) == 1
    assert sorted(path.name for path in output.iterdir()) == ['made_up.png', 'own.png']
    assert all(path.read_bytes().startswith(b'\x89PNG') for path in output.iterdir())
    assert len(drawn) == 1
    assert f'2 figures in {output}' in capsys.readouterr().out


def test_plots_accepts_an_empty_directory_and_refuses_anything_else(made_up, tmp_path, capsys):
    made_up(ROW)
    assert main(['verify', 'made_up', '--plots', str(tmp_path)]) == 0
    capsys.readouterr()
    for output, complaint in ((tmp_path, 'is not empty'),
                              (tmp_path / 'made_up.png', 'exists already'),
                              (tmp_path / 'made_up.png' / 'figures', 'is not a directory')):
        assert main(['verify', 'made_up', '--plots', str(output)]) == 2
        captured = capsys.readouterr()
        assert captured.out == ''
        assert complaint in captured.err
        assert captured.err.count('\n') == 1


def test_a_real_case_passes_from_the_command_line(capsys):
    assert main(['verify', 'joukowsky']) == 0
    assert 'front at mid-line' in capsys.readouterr().out
