# SPDX-License-Identifier: Apache-2.0
"""A run repeated from what was applied gives the same bits, or is said to differ and where."""

from hydra_actuator import load_parameters, load_recording, simulate
from hydra_actuator.cli.main import main
from hydra_actuator.errors import InputError
from hydra_actuator.recording.timeline import pieces
from hydra_actuator.replay import Replay
from hydra_actuator.signals import Sine, Step
import numpy as np
import pytest

COARSE = {'solver.cells': 60}


@pytest.fixture(scope='module')
def stepped(tmp_path_factory):
    path = tmp_path_factory.mktemp('run') / 'stepped'
    simulate(load_parameters(overrides={**COARSE, 'sensor.position_noise': 1e-6}),
             Step(0.4, 0.010001), 0.03, path, 5000.0)
    return path


def test_a_run_of_held_commands_is_repeated_bit_by_bit(stepped, capsys):
    assert main(['simulate', '--replay', str(stepped)]) == 0
    assert capsys.readouterr().out == f'151 states of {stepped}: bit-identical\n'


def test_a_run_whose_command_moves_within_a_tick_differs_and_it_is_said_where(tmp_path, capsys):
    path = tmp_path / 'sine'
    simulate(load_parameters(overrides=COARSE), Sine(50.0), 0.02, path)
    assert main(['simulate', '--replay', str(path)]) == 1
    told = capsys.readouterr().out
    assert told.startswith(f'20 of 21 states of {path} differ, the first at 0.001')
    assert 'recorded' in told and 'replayed' in told


def test_other_parameters_give_another_run(stepped, tmp_path, capsys):
    path = tmp_path / 'heavier.yaml'
    path.write_text(
        '/**:\n  ros__parameters:\n    solver: {cells: 60}\n    cylinder: {mass: 11.0}\n')
    assert main(['simulate', '--replay', str(stepped), '--config', str(path)]) == 1
    assert 'differ' in capsys.readouterr().out


def test_the_repeated_run_can_be_recorded(tmp_path, capsys):
    first, second = tmp_path / 'first', tmp_path / 'second'
    simulate(load_parameters(overrides=COARSE), Step(0.4), 0.02, first)
    assert main(['simulate', '--replay', str(first), '-o', str(second)]) == 0
    one, two = (load_recording(path) for path in (first, second))
    assert np.array_equal(one.rows, two.rows, equal_nan=True)
    assert main(['simulate', '--replay', str(second)]) == 0


@pytest.mark.parametrize('arguments, words', [
    (['--replay', 'nowhere'], 'nowhere'),
    (['--replay', '{run}', '--duration', '1'], '--duration does not go with --replay'),
    (['--replay', '{run}', '--rate', '10'], '--rate'),
    (['--replay', '{run}', '--sine', '10'], 'not allowed with'),
    (['--sine', '10'], '-o/--output'),
])
def test_what_makes_no_sense_is_refused_in_one_line(stepped, capsys, arguments, words):
    try:
        code = main(['simulate', *(one.replace('{run}', str(stepped)) for one in arguments)])
    except SystemExit as exit:
        code = exit.code
    assert code == 2
    assert words in capsys.readouterr().err


def test_a_recording_that_begins_later_is_refused(stepped, monkeypatch):
    run = load_recording(stepped)
    stamps, applied = run.applied
    run.applied = stamps, applied + np.array([5.0, 0.0, 0.0])
    with pytest.raises(InputError, match='begins with tick 5'):
        pieces(run, 1e-5, 100)


class Recorded:
    """What a timeline reads of a recording of a node, without a field."""

    path = 'run'
    custom_data = {'source': 'node'}
    topics = {}

    def __init__(self, stamps, applied):
        self.row_stamps = np.array(stamps, np.int64)
        self.applied = (np.array([one[0] for one in applied], np.int64),
                        np.array([one[1:] for one in applied], float))


def steps_of(stamps, applied):
    """Return the ticks of states by piece, with ticks of 1 ms and one step each."""
    ms = 1_000_000
    found = pieces(Recorded([ms * one for one in stamps],
                            [(ms * stamp, *rest) for stamp, *rest in applied]), 1e-3, 1)
    return [piece.steps.tolist() for piece in found]


def test_slip_is_found_at_the_gap_between_two_known_ticks():
    assert steps_of([10, 11, 12, 15, 16, 17], [(10, 0, 0, 0), (16, 4, 1, 0)]) == [
        [0, 1, 2, 3, 4, 5]]


def test_states_that_were_not_published_leave_their_ticks_out():
    assert steps_of([10, 11, 12, 15, 16, 17], [(10, 0, 0, 0), (16, 6, 1, 0)]) == [
        [0, 1, 2, 5, 6, 7]]


def test_a_pause_puts_stamps_off_the_grid():
    assert steps_of([10, 11, 12, 20.3, 21.3], [(10, 0, 0, 0), (19.3, 2, 1, 0)]) == [
        [0, 1, 2, 3, 4]]


def test_a_reset_begins_a_new_piece():
    assert steps_of([10, 11, 12, 13, 14, 15], [(10, 0, 1, 0), (13, 0, 1, 0)]) == [
        [0, 1, 2], [0, 1, 2]]


def test_inputs_that_change_before_the_first_tick_are_no_reset():
    assert steps_of([10, 11, 12], [(10, 0, 0, 0), (10, 0, 1, 0)]) == [[0, 1, 2]]


def test_a_replay_knows_the_parameters_of_its_run(stepped):
    run = Replay(stepped)
    assert run.parameters['sensor.position_noise'] == 1e-6
    assert run.command.duration == pytest.approx(0.03)
    assert run.compare().identical
