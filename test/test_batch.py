# SPDX-License-Identifier: Apache-2.0
"""Many runs at once are each what they are alone, to the last bit."""

import signal
import subprocess
import sys
import time

from hydra_actuator import batch as batch_module
from hydra_actuator.batch import read_batch, simulate_batch
from hydra_actuator.cli.main import main
from hydra_actuator.errors import InputError
from hydra_actuator.parameters import load_parameters
from hydra_actuator.recording.reader import load_recording
from hydra_actuator.signals import Sine
from hydra_actuator.simulate import simulate
import numpy as np
import pytest


@pytest.fixture
def small(tmp_path):
    path = tmp_path / 'small.yaml'
    path.write_text('/**:\n  ros__parameters:\n    solver: {cells: 40}\n')
    return str(path)


def batch(tmp_path, text):
    path = tmp_path / 'runs.csv'
    path.write_text(text)
    return str(path)


def test_each_run_is_bit_identical_to_itself_alone_and_failures_are_told(
        tmp_path, small, capsys):
    runs = batch(tmp_path, 'name,cylinder.mass,solver.max_mach\n'
                           'light,5,\nheavy,20,\nfast,10,0.001\n')
    out = tmp_path / 'out'
    assert main(['simulate', '--config', small, '--batch', runs, '--sine', '50',
                 '--duration', '0.02', '-o', str(out)]) == 1
    told = capsys.readouterr().out.splitlines()
    assert told[0] == f'2 runs of 0.02 s simulated, 1 failed, recorded below {out}'
    assert told[1].startswith('  fast: |u|/c = ')
    for name, mass in (('light', 5.0), ('heavy', 20.0)):
        alone = tmp_path / f'alone_{name}'
        parameters = load_parameters(small, overrides={'cylinder.mass': mass})
        simulate(parameters, Sine(50.0), 0.02, alone)
        one, other = load_recording(out / name), load_recording(alone)
        assert np.array_equal(one.rows, other.rows, equal_nan=True)
        assert len(one.rows) == 21


@pytest.mark.parametrize(('text', 'message'), [
    ('name,cylinder.mass\n', 'has no rows'), ('mass\n1\n', 'the header is name'),
    ('name,cylinder.mas\na,1\n', "line 2: unknown parameter 'cylinder.mas'"),
    ('name,cylinder.mass\na,1\na,2\n', "line 3: 'a' is no name of a recording, or is there"),
    ('name,cylinder.mass\n../a,1\n', "'../a' is no name"),
    ('name,cylinder.mass\na\n', 'line 2: 1 values for 2 columns'),
    ('name,cylinder.mass\na,-1\n', 'line 2: cylinder.mass = -1.0: below the minimum')])
def test_a_batch_that_cannot_be_run_is_refused_by_its_line(tmp_path, text, message):
    with pytest.raises(InputError) as refused:
        read_batch(batch(tmp_path, text))
    assert message in str(refused.value)


def test_runs_go_in_fours_where_that_leaves_every_process_some(monkeypatch):
    runs = [batch_module.Run(f'run_{k}', load_parameters(overrides={'cylinder.mass': 5.0 + k}))
            for k in range(9)]
    ready = []
    monkeypatch.setattr(batch_module, 'ready_together', ready.append)
    monkeypatch.setattr(batch_module, 'has_together', lambda passes: False)

    def sizes(count, duration, workers):
        return [len(members) for members in batch_module._groups(runs[:count], duration, workers)]
    assert sizes(9, 1000.0, 2) == [4, 4, 1]
    assert len(ready) == 1 and len(ready[0]) == 4
    # one process would have none; the kernel would take longer than it saves
    assert sizes(7, 1000.0, 2) == [1] * 7
    assert sizes(9, 1.0, 2) == [1] * 9
    monkeypatch.setattr(batch_module, 'has_together', lambda passes: True)
    assert sizes(9, 1.0, 2) == [4, 4, 1]


def test_a_batch_in_fours_is_the_same_as_one_by_one(tmp_path, monkeypatch):
    runs = [batch_module.Run(f'run_{k}', load_parameters(overrides={
        'cylinder.mass': 5.0 + k, 'solver.max_mach': 0.001 if k == 2 else 0.025}))
        for k in range(5)]
    drive = (Sine(50.0), 0.02, None)
    told = simulate_batch(runs, drive, tmp_path / 'alone', 1)
    monkeypatch.setattr(batch_module, 'WORTH', 0.0)
    monkeypatch.setattr(batch_module, 'LOOK', 0.001)
    shares = []
    assert simulate_batch(runs, drive, tmp_path / 'fours', 1, shares.append) == told
    assert shares == sorted(shares) and shares[-1] == 1.0
    # told while runs are under way, not at their ends alone
    assert any(0.0 < share < 1.0 and 5.0 * share % 1.0 for share in shares)
    assert told['run_2'].startswith('|u|/c') and not told['run_3']
    for run in runs:
        one, other = (load_recording(tmp_path / how / run.name) for how in ('alone', 'fours'))
        assert np.array_equal(one.rows, other.rows, equal_nan=True)


def test_an_interrupt_ends_all_processes_soon_and_leaves_whole_recordings(tmp_path, small):
    runs = batch(tmp_path, 'name,cylinder.mass\n' + ''.join(f'r{k},{5 + k}\n' for k in range(3)))
    out = tmp_path / 'out'
    process = subprocess.Popen(
        [sys.executable, '-m', 'hydra_actuator', 'simulate', '--config', small, '--batch', runs,
         '--sine', '50', '--duration', '100000', '-o', str(out)], stderr=subprocess.PIPE)
    until = time.monotonic() + 100.0
    while not list(out.glob('*/*.mcap')) and time.monotonic() < until:
        time.sleep(0.1)
    process.send_signal(signal.SIGINT)
    process.communicate(timeout=60.0)
    assert process.returncode == 130
    begun = list(out.iterdir())
    assert begun and all(load_recording(one).finished for one in begun)
