# SPDX-License-Identifier: Apache-2.0
"""`paper`: what it writes, what it refuses before any run, and how Ctrl-C ends it."""

import os
from pathlib import Path
import signal
import subprocess
import sys
import time

from hydra_actuator.cli.main import main
from hydra_actuator.paper.case import Case
import pytest

ROOT = Path(__file__).parents[2]


@pytest.fixture
def short_cases(monkeypatch):
    """Let the cases be short runs on few cells."""
    cases = {name: Case(name, name, name == 'cavitation', 100.0, 0.5, 0.01, 60)
             for name in ('plain', 'cavitation')}
    monkeypatch.setattr('hydra_actuator.paper.choice.CASES', cases)


def test_verb_writes_what_is_asked_for_and_says_where(tmp_path, capsys, short_cases):
    output = tmp_path / 'out'
    assert main(['paper', '-o', str(output), '--only', '5a', '3e', '--plain']) == 0
    told = capsys.readouterr()
    assert told.out == f'2 figures and 0 statements in {output}/paper.html\n'
    assert told.err == ''
    assert sorted(os.listdir(output)) == ['figure_3e.png', 'figure_5a.png', 'paper.html']


def test_cavitation_alone_has_its_own_names(tmp_path, capsys, short_cases):
    output = tmp_path / 'out'
    assert main(['paper', '-o', str(output), '--only', '5a', '--cavitation']) == 0
    assert sorted(os.listdir(output)) == ['figure_5a_cavitation.png', 'paper.html']


@pytest.mark.parametrize('options, culprit', [
    (['--only', '6a'], "'6a'"), (['--plain', '--cavitation'], 'not allowed with'),
    (['--colour'], '--colour'),
])
def test_bad_wishes_are_one_line_and_leave_no_trace(tmp_path, capsys, options, culprit):
    assert main(['paper', '-o', str(tmp_path / 'out'), *options]) == 2
    told = capsys.readouterr()
    assert told.err.startswith('hydra_actuator paper: ')
    assert culprit in told.err
    assert told.err.count('\n') == 1
    assert not list(tmp_path.iterdir())


def test_an_existing_directory_is_refused(tmp_path, capsys):
    assert main(['paper', '-o', str(tmp_path)]) == 2
    assert 'exists already, and nothing is overwritten' in capsys.readouterr().err


def test_a_place_below_a_file_is_refused(tmp_path, capsys):
    (tmp_path / 'file').write_text('')
    assert main(['paper', '-o', str(tmp_path / 'file' / 'out')]) == 2
    assert 'is not a directory' in capsys.readouterr().err


def test_ctrl_c_ends_in_130_and_leaves_nothing(tmp_path):
    process = subprocess.Popen(
        [sys.executable, '-m', 'hydra_actuator', 'paper', '-o', str(tmp_path / 'out')], cwd=ROOT,
        stdout=subprocess.PIPE, stderr=subprocess.PIPE,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL))
    time.sleep(3.0)
    process.send_signal(signal.SIGINT)
    out, error = process.communicate(timeout=120)
    assert (process.returncode, out, error) == (130, b'', b'')
    assert not list(tmp_path.iterdir())
