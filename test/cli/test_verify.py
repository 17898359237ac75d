# SPDX-License-Identifier: Apache-2.0
"""`hydra_actuator verify` shows what was expected and got, and fails when they differ."""

from dataclasses import replace

from hydra_actuator.cli.main import main
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


def test_a_real_case_passes_from_the_command_line(capsys):
    assert main(['verify', 'joukowsky']) == 0
    assert 'front at mid-line' in capsys.readouterr().out
