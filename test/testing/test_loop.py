# SPDX-License-Identifier: Apache-2.0
"""A loop in one process: what the controller sees, what the actuator gets, and when."""

from hydra_actuator.testing import run_loop
import numpy as np
import pytest

PERIOD = 1e-3


@pytest.fixture
def coarse(make_actuator):
    return make_actuator({'solver.cells': 60})


def test_each_command_acts_for_one_period_from_the_state_it_follows_from(coarse, make_actuator):
    run = run_loop(coarse, lambda state: 0.1 + 100.0 * state.time, 5 * PERIOD, PERIOD)
    assert run.commands == pytest.approx([0.1, 0.2, 0.3, 0.4, 0.5])
    other = make_actuator({'solver.cells': 60})
    by_hand = [other.state, *(other.advance(PERIOD, spool=spool) for spool in run.commands)]
    assert run.states == tuple(by_hand)
    assert run.time.tolist() == [state.time for state in by_hand]
    assert run.position.tolist() == [state.position for state in by_hand]
    assert run.velocity[-1] == by_hand[-1].velocity != 0.0
    assert run.pressure('E').tolist() == [state.pressure['E'] for state in by_hand]
    assert run.of('spool_position').shape == (6, 1)


def test_a_period_that_is_no_whole_number_of_steps_does_not_drift(coarse):
    period = 10.4 * coarse.step_time
    run = run_loop(coarse, lambda state: 0.0, 200 * period, period)
    late = run.time - period * np.arange(201)
    assert len(run.commands) == 200
    assert late.min() > -1e-9
    assert late.max() < coarse.step_time


def test_a_loop_goes_on_where_the_last_one_ended(coarse):
    first = run_loop(coarse, lambda state: 0.5, 3 * PERIOD, PERIOD)
    second = run_loop(coarse, lambda state: 0.5, 3 * PERIOD, PERIOD)
    assert second.states[0] == first.states[-1]
    assert second.time[-1] == pytest.approx(6 * PERIOD)


def test_each_of_two_spools_has_its_command(make_actuator):
    actuator = make_actuator({'solver.cells': 60, 'valve.spools': 2})
    run = run_loop(actuator, lambda state: (0.5, -0.25), 2 * PERIOD, PERIOD)
    stroke = actuator.parameters['valve.stroke']
    assert run.of('spool_position')[-1] == pytest.approx([0.5 * stroke, -0.25 * stroke])


def test_a_command_that_is_none_is_refused_with_its_instant(coarse):
    with pytest.raises(ValueError, match=r'^at 0.002 s: spool nan'):
        run_loop(coarse, lambda state: float('nan') if state.time > 1.5e-3 else 0.0, 0.01, PERIOD)


@pytest.mark.parametrize(('duration', 'period', 'words'), [
    (1.0, 0.0, 'period = 0.0 s'), (1.0, float('nan'), 'period = nan'),
    (1.0, 1e-9, 'at least one step'), (0.0, PERIOD, 'duration = 0.0 s'),
    (float('inf'), PERIOD, 'duration = inf'),
])
def test_times_that_are_none_are_refused(coarse, duration, period, words):
    with pytest.raises(ValueError, match=words):
        run_loop(coarse, lambda state: 0.0, duration, period)
