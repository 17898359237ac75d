# SPDX-License-Identifier: Apache-2.0
"""Four actuators to a step are each what they are alone, to the last bit."""

from campaign.draw import draw_set
from hydra_actuator.actuator import Actuator
from hydra_actuator.core.lanes import WIDTH
from hydra_actuator.core.together.advance import advance_together
from hydra_actuator.core.together.ensemble import fits
from hydra_actuator.errors import InputError
from hydra_actuator.limits import SolverError
from hydra_actuator.offline import Stretch
from hydra_actuator.parameters import ParameterError, Parameters
from hydra_actuator.parameters.table_hydraulics import LINES
from hydra_actuator.recording.reader import load_recording
from hydra_actuator.side_by_side import group, SideBySide, simulate_side_by_side
from hydra_actuator.signals import Sine, Step
from hydra_actuator.simulate import simulate
import numpy as np
import pytest

SMALL = {'solver.cells': 100, 'cylinder.dead_length_1': 0.25, 'cylinder.dead_length_2': 0.25}
# What the formulas in lanes have a branch for, two and more of each in one group.
DIFFERENT = [
    {'cylinder.mass': 5.0, 'line_1.length': 0.25},
    {'valve.stroke': 0.0006, 'supply.pressure': 18e6, 'cylinder.stiffness': 4e5},
    {'valve.natural_frequency': 150.0, 'valve.damping_ratio': 0.7, 'cylinder.area_2': 8e-4},
    {'valve.natural_frequency': 90.0, 'valve.slew_rate': 0.2, 'supply.max_flow': 1e-3},
    {'cylinder.coulomb_friction': 100.0, 'cylinder.static_friction': 150.0},
    {'cylinder.leakage': 1e-12, 'fluid.density': 800.0},
    {'supply.accumulator_volume': 1e-3, 'supply.accumulator_precharge': 10e6},
    {'valve.overlap_pa': -2e-5, 'valve.overlap_pb': -2e-5, 'return_line.loss_coefficient': 4.0}]


def sets(changes):
    return [Parameters().replace({**SMALL, **change}) for change in changes]


def same(together, alone):
    return all(np.array_equal(a.rows, b.rows, equal_nan=True) for a, b in zip(together, alone))


@pytest.fixture
def calls(monkeypatch):
    """Note what the calls for four at once returned."""
    told = []

    def noted(self, schedules, count):
        done = plain(self, schedules, count)
        told.append(done)
        return done
    plain = SideBySide._advance
    monkeypatch.setattr(SideBySide, '_advance', noted)
    return told


@pytest.mark.parametrize('more', [
    {}, {'solver.interpolation': 'linear'},
    *(pytest.param({'solver.iterations': count}, marks=pytest.mark.soak) for count in (1, 3))])
def test_each_has_the_bits_it_has_alone(more, calls):
    parameters = [p.replace(more) for p in sets(DIFFERENT)]
    command = Sine(40.0, 0.9)
    together = simulate_side_by_side(parameters, command, 0.06)
    assert len(calls) == 2 * 61 and all(calls)
    assert same(together, [simulate(p, command, 0.06) for p in parameters])
    assert len(together[0].rows) == 61


def test_random_sets_under_a_step_are_the_same_side_by_side_and_alone(calls):
    random = np.random.default_rng(5)
    changes = [{
        'cylinder.mass': random.uniform(1.0, 40.0), 'line_1.length': random.uniform(0.15, 0.5),
        'line_2.length': random.uniform(0.15, 0.5), 'initial.position': random.uniform(-.05, .05),
        'fluid.bulk_modulus': random.uniform(1.2e9, 1.6e9),
        'solver.cells': int(random.integers(100, 140))} for _ in range(2 * WIDTH)]
    parameters = sets(changes)
    command = Step(0.6, 0.01)
    together = simulate_side_by_side(parameters, command, 0.05)
    assert sum(calls) > 80
    assert same(together, [simulate(p, command, 0.05) for p in parameters])


def test_a_piston_at_its_stop_and_a_run_that_fails_are_as_alone(calls):
    changes = [{'initial.position': 0.095, 'cylinder.stiffness': 0.0}, {},
               {'solver.max_mach': 0.002}, {'cylinder.mass': 2.0}]
    parameters = sets(changes)
    command = Step(1.0)
    together = simulate_side_by_side(parameters, command, 0.06)
    assert isinstance(together[2], SolverError)
    with pytest.raises(SolverError) as alone:
        simulate(parameters[2], command, 0.06)
    assert str(together[2]) == str(alone.value)
    assert not all(calls) and any(calls)
    rest = [0, 1, 3]
    assert same([together[k] for k in rest],
                [simulate(parameters[k], command, 0.06) for k in rest])
    assert together[0].rows[-1, 1] == pytest.approx(0.1)


def test_recordings_are_those_of_runs_alone(tmp_path):
    parameters = sets([{'cylinder.mass': float(mass)} for mass in (4, 8, 16, 32)])
    together = simulate_side_by_side(
        parameters, Sine(30.0), 0.03, [tmp_path / f'{k}' for k in range(4)])
    for k, p in enumerate(parameters):
        simulate(p, Sine(30.0), 0.03, tmp_path / f'alone_{k}')
        assert together[k].recording == tmp_path / f'{k}'
        assert np.array_equal(load_recording(tmp_path / f'{k}').rows,
                              load_recording(tmp_path / f'alone_{k}').rows, equal_nan=True)


def test_a_recording_that_cannot_be_is_told_in_its_place_and_the_others_go_on(tmp_path):
    parameters = sets([{'cylinder.mass': float(mass)} for mass in (4, 8, 16, 32)])
    outputs = [tmp_path / f'{k}' for k in range(4)]
    outputs[1].mkdir()
    (outputs[1] / 'kept').write_text('')
    together = simulate_side_by_side(parameters, Sine(30.0), 0.01, outputs)
    with pytest.raises(InputError) as alone:
        simulate(parameters[1], Sine(30.0), 0.01, outputs[1])
    assert isinstance(together[1], InputError) and str(together[1]) == str(alone.value)
    assert [path.name for path in outputs[1].iterdir()] == ['kept']
    for k in (0, 2, 3):
        assert len(load_recording(together[k].recording).rows) == 11


def test_what_cannot_go_side_by_side_is_in_a_group_of_its_own():
    plain = sets([{'cylinder.mass': 1.0 + k} for k in range(5)])
    odd = sets([{'fluid.cavitation': True, 'tank.pressure': 1e5}, {'valve.leakage': 1e-12},
                {'line_1.friction': 'steady'}, {'fault.enabled': True},
                {'solver.iterations': 3}])
    groups = group(odd + plain)
    assert [len(indices) for indices in groups].count(1) == 6
    assert [5, 6, 7, 8] in groups
    assert sorted(index for indices in groups for index in indices) == list(range(10))


def test_shares_are_told_and_rubbish_is_refused():
    shares = []
    simulate_side_by_side(sets(DIFFERENT[:5]), None, 0.01, progress=shares.append)
    assert shares == sorted(shares) and shares[-1] == 1.0
    with pytest.raises(InputError, match='duration'):
        simulate_side_by_side(sets(DIFFERENT), None, -1.0)


def test_an_actuator_too_short_for_the_lanes_runs_alone(calls):
    parameters = sets([{'line_1.length': 0.1, 'cylinder.mass': 2.0 + k} for k in range(4)])
    together = simulate_side_by_side(parameters, Sine(30.0), 0.01)
    assert calls == []
    assert same(together, [simulate(p, Sine(30.0), 0.01) for p in parameters])


def test_the_kernel_leaves_all_as_it_was_where_it_gives_up():
    actuators = [Actuator(p) for p in sets([{}, {}, {}, {'solver.max_mach': 0.002}])]
    together = SideBySide(actuators)
    for actuator in actuators:
        actuator.solver.schedule[1][0, :2] = 1.0
    before = [actuator.solver.state.wave_p.copy() for actuator in actuators]
    schedules = tuple(actuator.solver.schedule for actuator in actuators)
    assert not together._advance(schedules, 400)
    for actuator, waves in zip(actuators, before):
        assert actuator.time == 0.0
        assert np.array_equal(actuator.solver.state.wave_p, waves)
    assert advance_together.nopython_signatures


def drawn(number, cells):
    """Return the actuator parameters of a random set that may go side by side, or None."""
    values = draw_set(number, False) | {
        'fluid.cavitation': False, 'valve.leakage': 0.0, 'solver.cells': cells,
        'solver.interpolation': 'cubic'}
    values |= {f'{line}.friction': 'constant' for line in LINES}
    try:
        parameters = Parameters(values)
        actuator = Actuator(parameters)
    except ParameterError:
        return None
    return parameters if actuator.steps_per_period < 400 and fits(actuator.solver.model) else None


def differences(four, random, ticks):
    """Advance four side by side and alone under held commands; return where they differ."""
    at_once, apart = ([Actuator(p) for p in four] for _ in range(2))
    together, differ = SideBySide(at_once), []
    for tick in range(ticks):
        stretches = []
        for actuator in at_once:
            steps = actuator.steps_per_period
            commands = np.clip(random.normal(0.0, (0.5, 0.5, 0.0)), -1.0, 1.0)
            commands[2] = random.normal(0.0, 2000.0)
            stretches.append(Stretch((
                actuator.time + np.arange(1, steps + 1) * actuator.step_time,
                np.tile(commands, (steps, 1)), True), steps))
        codes = together.follow(stretches)
        for k, (one, other) in enumerate(zip(at_once, apart)):
            if (other.follow(*stretches[k]) != codes[k]
                    or not np.array_equal(one.row, other.row, equal_nan=True)):
                differ.append((k, tick))
        if any(codes):
            return differ
    return differ


def fours(cells, first, last):
    """Yield the sets of the numbers in fours."""
    found = [p for p in (drawn(number, cells) for number in range(first, last)) if p is not None]
    for k in range(0, len(found) - WIDTH + 1, WIDTH):
        yield found[k:k + WIDTH]


@pytest.mark.parametrize('last', [
    pytest.param(150, id='sample'), pytest.param(6000, marks=pytest.mark.soak, id='all')])
def test_random_actuators_are_what_they_are_alone_status_and_bits(last, calls):
    random = np.random.default_rng(11)
    groups = 0
    for four in fours(200, 0, last):
        assert differences(four, random, 10) == []
        groups += 1
    assert groups > last / 60 and sum(calls) > 3 * groups
