# SPDX-License-Identifier: Apache-2.0
"""The measurement of punctuality: that it measures what it says."""

from hydra_actuator.cli.main import main
from hydra_actuator.parameters import Parameters
from hydra_actuator.realtime.durations import DurationHistogram
from hydra_actuator.ros.loads import sleeper
from hydra_actuator.ros.punctuality import Case, Lateness, lines
import pytest

QUIET = Lateness((1.0, 2.0, 3.0), 4.0, 5000, 6)


def test_a_sleeper_counts_its_ticks_in_a_process_of_its_own():
    with sleeper(Parameters().replace({'timing.period': 1e-3})) as queue:
        pass
    lateness, ticks, missed = queue.get(timeout=60.0)
    assert ticks >= 100 and ticks % 100 == 0
    assert lateness.count == ticks
    assert lateness.percentile(50.0) <= lateness.maximum
    assert missed >= 0


def test_a_case_is_shown_with_the_sleeper_beside_it():
    latency = DurationHistogram()
    latency.add(1_500_000)
    case = Case('node', QUIET, QUIET, (7.0, 8.0, 9.0), latency, 'all well')
    shown = [line.split() for line in lines(case)]
    assert shown[0] == ['node', '(all', 'well)']
    assert shown[1][-7:] == ['1', '2', '3', '4', '6', 'of', '5000']
    assert shown[2][:4] == ['of', 'a', 'sleeper', 'beside']
    assert shown[3][-3:] == ['7', '8', '9']
    assert shown[4][-1] == '1500'
    assert len(lines(Case('bare sleeper', QUIET))) == 2


@pytest.mark.soak
def test_every_case_counts_ticks_and_answers(tmp_path, capsys):
    coarse = tmp_path / 'coarse.yaml'
    coarse.write_text('/**:\n  ros__parameters:\n    solver: {cells: 40}\n')
    assert main(['bench', '--real-time', '--duration', '2', '--config', str(coarse)]) == 0
    shown = capsys.readouterr().out.splitlines()
    ticks = [int(line.split()[-1]) for line in shown if line.startswith('  late')]
    assert len(ticks) == 7 and min(ticks) > 100
    answers = [line.split() for line in shown if line.startswith('  command to state')]
    assert len(answers) == 2
    assert all(float(answer[3]) > 0.0 for answer in answers)
