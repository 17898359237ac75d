# SPDX-License-Identifier: Apache-2.0
"""The verb `bench`."""

from hydra_actuator.cli.main import main
from hydra_actuator.parameters.options import OPTIONS
import pytest

pytestmark = pytest.mark.once


@pytest.fixture
def small(tmp_path):
    path = tmp_path / 'small.yaml'
    path.write_text('/**:\n  ros__parameters:\n    solver: {cells: 40}\n')
    return str(path)


def test_speed_is_printed_beside_the_bare_sweep(small, capsys):
    assert main(['bench', '--config', small, '--duration', '0.3']) == 0
    shown = capsys.readouterr().out
    assert 'times real time' in shown
    assert 'step over bare sweep' in shown


def test_every_option_stands_in_the_table_of_costs(small, capsys):
    assert main(['bench', '--config', small, '--duration', '0.2', '--options']) == 0
    lines = capsys.readouterr().out.splitlines()
    assert len(lines) == len(OPTIONS) + 3
    ratios = {line[:32].strip(): float(line.split()[-1]) for line in lines[1:]}
    assert ratios['as configured'] == 1.0
    assert ratios['everything'] > 1.0


def test_a_step_in_fours_stands_beside_a_step_alone(capsys):
    assert main(['bench', '--batch', '--duration', '0.2']) == 0
    lines = capsys.readouterr().out.splitlines()
    times = {line[:32].strip(): float(line.split()[-1]) for line in lines[1:5]}
    assert set(times) == {f'{kind}, {how}' for kind in ('solver', 'run')
                          for how in ('alone', 'four at once')}
    assert times['solver, four at once'] < times['solver, alone']
    assert lines[5].startswith('solver: ') and lines[5].endswith(' times as many steps by a core')


def test_too_short_a_duration_is_refused(capsys):
    assert main(['bench', '--duration', '0.1']) == 2
    assert capsys.readouterr().err == 'hydra_actuator bench: --duration 0.1 s is below 0.2 s\n'
