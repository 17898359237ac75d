# SPDX-License-Identifier: Apache-2.0
"""Which faults are at work: set, scripted, cleared; and what is said of them."""

from hydra_actuator.faults import Faults
from hydra_actuator.faults.announcements import Announcer, standing
from hydra_actuator.parameters import ParameterError, Parameters
import pytest

ENABLED = {'fault.enabled': True}


@pytest.fixture
def scripted(tmp_path):
    """Return faults with a script."""
    script = tmp_path / 'script.csv'
    script.write_text('time,parameter,value\n1,fault.leakage,2e-12\n1,fault.null_shift,0.1\n'
                      '2,fault.leakage,0\n')
    return Faults(Parameters({**ENABLED, 'fault.script': str(script)}))


@pytest.mark.parametrize('change', [
    {'fault.leakage': 1e-12}, {'fault.valve_stuck': True}, {'fault.pressure.A.off': True},
    {'fault.script': 'script.csv'}])
def test_without_the_switch_a_fault_is_refused_at_the_door(change):
    (name,) = change
    with pytest.raises(ParameterError, match=f'^{name} = .* needs fault.enabled = true$'):
        Parameters(change)


def test_a_live_fault_is_refused_without_the_switch_and_taken_with_it():
    faults = Faults(Parameters())
    with pytest.raises(ParameterError, match=r'needs fault\.enabled = true'):
        faults.check({'fault.leakage': 1e-12})
    faults.take(faults.check({'fault.leakage': 1e-12, 'fault.enabled': True}))
    assert faults.active == {'fault.leakage': 1e-12}
    faults.take(faults.check({'fault.enabled': False}))
    assert faults.active == {}


@pytest.mark.parametrize('change, complaint', [
    ({'fault.leakage': 1.0}, 'above the maximum'), ({'fault.leekage': 0.0}, 'did you mean'),
    ({'fault.pressure.Q.off': True}, "no 'Q', but O, A"), ({'tank.pressure': 0.0}, 'is no fault'),
    ({'fault.valve_stuck': 1.0}, 'true or false is wanted')])
def test_a_bad_change_is_refused_whole(change, complaint):
    faults = Faults(Parameters(ENABLED))
    with pytest.raises(ParameterError, match=complaint):
        faults.check({'fault.null_shift': 0.5, **change})
    assert faults.active == {}


def test_air_is_refused_where_its_kernel_is_not_at_hand(tmp_path):
    faults = Faults(Parameters(ENABLED))
    faults.air_may_come = False
    (tmp_path / 'script.csv').write_text('time,parameter,value\n1,fault.air_fraction,0.01\n')
    for change in ({'fault.air_fraction': 0.01}, {'fault.script': str(tmp_path / 'script.csv')}):
        with pytest.raises(ParameterError, match=r'air_fraction needs .* from the start'):
            faults.check(change)
    faults.check({'fault.air_fraction': 0.0, 'fault.leakage': 1e-12})


def test_a_script_sets_what_is_due_and_rows_of_one_time_together(scripted):
    assert not scripted.follow(0.999)
    assert scripted.follow(1.0)
    assert scripted.active == {'fault.null_shift': 0.1, 'fault.leakage': 2e-12}
    assert scripted.edition == 1
    assert not scripted.follow(1.5)
    assert scripted.follow(7.0)
    assert scripted.active == {'fault.null_shift': 0.1}


def test_a_restart_keeps_faults_and_runs_the_script_again(scripted):
    scripted.follow(5.0)
    scripted.restart()
    assert scripted.active == {'fault.null_shift': 0.1}
    assert scripted.follow(1.2)
    assert 'fault.leakage' in scripted.active


def test_whoever_sets_a_fault_last_wins(scripted):
    scripted.take(scripted.check({'fault.leakage': 5e-12}))
    scripted.follow(1.0)
    assert scripted.active['fault.leakage'] == 2e-12
    scripted.take(scripted.check({'fault.leakage': 0.0}))
    assert 'fault.leakage' not in scripted.active


def test_clearing_ends_faults_and_script(scripted):
    scripted.follow(1.0)
    assert scripted.clear()
    assert not scripted.follow(100.0)
    assert scripted.active == {}


def test_each_fault_is_announced_when_it_begins_changes_and_ends():
    announcer = Announcer()
    begun = {'fault.leakage': 2e-12, 'fault.valve_stuck': True}
    assert announcer.news(begun) == [
        (1, 'fault.leakage = 2e-12', {'fault.leakage': '2e-12'}),
        (1, 'fault.valve_stuck = true', {'fault.valve_stuck': 'true'})]
    assert announcer.news(begun) == []
    assert announcer.news({'fault.leakage': 3e-12}) == [
        (1, 'fault.leakage = 3e-12', {'fault.leakage': '3e-12'}),
        (0, 'fault.valve_stuck ended', {'fault.valve_stuck': '0'})]


def test_how_it_stands_names_faults_and_values():
    assert standing(True, {'fault.leakage': 2e-12, 'fault.spool.off': True}) == (
        1, 'at work: fault.leakage, fault.spool.off',
        {'enabled': 'true', 'fault.leakage': '2e-12', 'fault.spool.off': 'true'})
    assert standing(False, {}) == (0, 'no faults', {'enabled': 'false'})
