# SPDX-License-Identifier: Apache-2.0
"""`sweep`: what it says, what it refuses before any work, and how Ctrl-C ends it."""

import json
import os
from pathlib import Path
import signal
import subprocess
import sys
import time

from hydra_actuator.cli.main import main
import pytest

ROOT = Path(__file__).parents[2]
MASS = ['--vary', 'cylinder.mass=1:20']


@pytest.fixture
def small(tmp_path):
    path = tmp_path / 'small.yaml'
    path.write_text('/**:\n  ros__parameters:\n    solver: {cells: 40}\n')
    return ['--config', str(path)]


def test_ctrl_c_leaves_valid_files_and_the_same_command_goes_on(tmp_path, small):
    out = tmp_path / 'sweep'
    command = [sys.executable, '-m', 'hydra_actuator', 'sweep', *small, *MASS, '--sine', '100',
               '--duration', '0.3', '--workers', '1', '--samples', '16', '-o', str(out)]
    with subprocess.Popen(
            command, cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
            start_new_session=True,
            preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL)) as process:
        journal = out / 'journal.jsonl'
        deadline = time.monotonic() + 500.0
        while not (journal.exists() and journal.read_text()) and time.monotonic() < deadline:
            time.sleep(0.01)
        # As a terminal does: all of the group.
        os.killpg(process.pid, signal.SIGINT)
        told, errors = process.communicate(timeout=60.0)
    assert (process.returncode, errors) == (130, '')
    done = [json.loads(line)[0] for line in journal.read_text().splitlines()]
    assert 0 < len(done) < 16
    assert told == f'{len(done)} of 16 runs are in {out}; the same command goes on\n'
    finished = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=500)
    assert finished.stdout == f'16 runs done, 0 failed, in {out}\n'
    assert (finished.returncode, finished.stderr) == (0, '')
    runs = [json.loads(line)[0] for line in journal.read_text().splitlines()]
    assert runs[:len(done)] == done
    assert sorted(runs) == list(range(16))


@pytest.mark.parametrize(('arguments', 'message'), [
    ([], 'nothing is varied'),
    (['--vary', 'cylinder.mas=1:2'], "did you mean 'cylinder.mass'"),
    ([*MASS, '--samples', '0'], '0 samples are not within'),
    ([*MASS, '--seed', '-1'], '--seed -1 is not within'),
    ([*MASS, '--workers', '0'], '--workers 0 is not within'),
    ([*MASS, '--workers', '2', '--scheduler', 'tcp://x:1'], '--workers goes without --scheduler'),
    ([*MASS, '--from', '2'], '--from 2 s is not before the end at 1 s'),
    ([*MASS, '--sine', '-5'], '--sine -5 is not a positive number'),
    ([*MASS, '--command', 'nowhere.csv'], 'nowhere.csv'),
    ([*MASS, '--scheduler', 'rubbish://x'], 'no scheduler answers at rubbish://x')])
def test_rubbish_is_refused_in_one_line(tmp_path, capsys, arguments, message):
    assert main(['sweep', *arguments, '-o', str(tmp_path / 'out')]) == 2
    told = capsys.readouterr()
    assert told.out == ''
    assert message in told.err
    assert told.err.count('\n') == 1


def test_reasons_of_failed_runs_are_told(tmp_path, capsys, small):
    out = tmp_path / 'sweep'
    assert main(['sweep', *small, '--vary', 'initial.position=0,0.5', '--method', 'grid',
                 '--duration', '0.002', '--workers', '1', '-o', str(out)]) == 0
    told = capsys.readouterr().out.splitlines()
    assert told[0] == f'1 runs done, 1 failed, in {out}'
    assert told[1] == 'refused: 1'
    assert told[2].startswith('  run 1: initial.position = 0.5 lies outside')
