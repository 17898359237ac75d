# SPDX-License-Identifier: Apache-2.0
"""Faults of the plant: what each does to the actuator, live, scripted, and after a reset."""

from hydra_actuator.actuator import Actuator
from hydra_actuator.channels import Channels
from hydra_actuator.parameters import ParameterError, Parameters
import numpy as np
import pytest

QUICK = {'solver.cells': 60, 'fault.enabled': True}
STROKE = Parameters()['valve.stroke']


def make(**faults) -> Actuator:
    """Return a coarse actuator with faults."""
    return Actuator(Parameters({
        **QUICK, **{f'fault.{name}': value for name, value in faults.items()}}))


def rows(actuator: Actuator, ticks: int, spool: float = 0.3) -> np.ndarray:
    """Return the rows of some ticks under one command."""
    found = []
    for _ in range(ticks):
        assert actuator.tick_once(spool, spool, 0.0) == 0
        found.append(actuator.row.copy())
    return np.array(found)


def same(one: Actuator, other: Actuator, ticks: int = 20) -> bool:
    return rows(one, ticks).tolist() == rows(other, ticks).tolist()


def test_the_switch_alone_changes_no_bit():
    assert same(make(), Actuator(Parameters({'solver.cells': 60})))


def test_a_stuck_valve_stays_where_it_is_and_is_free_afterwards():
    actuator = make()
    rows(actuator, 3, 0.25)
    actuator.set_faults({'fault.valve_stuck': True})
    assert set(rows(actuator, 5, -1.0)[:, Channels.SPOOL_1]) == {0.25 * STROKE}
    actuator.set_faults({'fault.valve_stuck': False})
    assert rows(actuator, 1, -1.0)[0, Channels.SPOOL_1] == -STROKE


def test_a_null_shift_moves_the_spool_within_its_stroke():
    spools = [rows(make(null_shift=0.125), 2, command)[-1, Channels.SPOOL_1]
              for command in (0.0, 0.5, 1.0)]
    assert spools == [0.125 * STROKE, 0.625 * STROKE, STROKE]


def test_a_lost_command_centres_the_valve_but_for_its_null_shift():
    assert rows(make(command_lost=True), 2)[-1, Channels.SPOOL_1] == 0.0
    shifted = make(command_lost=True, null_shift=-0.5)
    assert rows(shifted, 2)[-1, Channels.SPOOL_1] == -0.5 * STROKE


@pytest.mark.parametrize('loss', [0.25, 1.0])
def test_a_supply_loss_takes_its_part_of_the_pressure_above_the_tank(loss):
    actuator = make(supply_loss=loss)
    pump = rows(actuator, 60, 0.0)[:, actuator.channels.pressure.start]
    expected = 2.5e6 + (1.0 - loss) * 18.5e6 + 101325.0
    assert pump[-1] == pytest.approx(expected, rel=1e-9)
    assert (np.diff(pump) <= 0.0).all()


def test_leakage_is_that_of_the_cylinder_and_as_much_again():
    of_fault = Actuator(Parameters({
        **QUICK, 'cylinder.leakage': 1e-12, 'fault.leakage': 3e-12}))
    of_cylinder = Actuator(Parameters({**QUICK, 'cylinder.leakage': 4e-12}))
    assert same(of_fault, of_cylinder)
    assert not same(make(), make(leakage=1e-12))


def test_air_lowers_the_speed_of_sound_by_the_formula():
    # A small wave from the pump: c = c0/sqrt(1 + rho c0^2 alpha/p*), alpha = alpha0 p0*/p*.
    p, air = Parameters(), 0.02
    star0 = p['ambient_pressure'] - p['fluid.vapour_pressure']
    star = p['supply.pressure'] + star0
    stiffness = p['fluid.bulk_modulus'] + p['supply.pressure']
    alpha = air * star0 / star
    expected = 1.0 / np.sqrt(1.0 + stiffness * alpha / star)
    arrivals = []
    for fraction in (0.0, air):
        actuator = Actuator(Parameters({
            'fault.enabled': True, 'fault.air_fraction': fraction, 'solver.cells': 800,
            'supply_line.length': 3.0}))
        actuator.advance(0.001)
        start = actuator.state.pressure['A']
        actuator.set_supply_pressure(p['supply.pressure'] + 1e4)
        steps = 0
        while actuator.advance(actuator.step_time).pressure['A'] < start + 1e4:
            steps += 1
        arrivals.append(steps)
    assert arrivals[0] / arrivals[1] == pytest.approx(expected, abs=0.004)


def test_air_comes_and_goes_without_a_jump_of_pressure():
    actuator = make()
    rows(actuator, 10)
    before = actuator.state
    actuator.set_faults({'fault.air_fraction': 0.05})
    during = actuator.state
    assert during.pressure == pytest.approx(before.pressure, rel=1e-12)
    assert during.void_fraction['J'] > 1e-4
    rows(actuator, 20)
    before = actuator.state
    actuator.set_faults({'fault.air_fraction': 0.0})
    after = actuator.state
    assert after.pressure == pytest.approx(before.pressure, rel=1e-6)
    assert not any(after.void_fraction.values())
    rows(actuator, 10)


def test_nothing_compiles_when_air_gets_in():
    from hydra_actuator.kernels import compilations
    actuator = make()
    rows(actuator, 1)
    before = compilations()
    actuator.set_faults({'fault.air_fraction': 0.01})
    rows(actuator, 1)
    assert compilations() == before


def test_a_reset_keeps_faults():
    actuator = make(null_shift=0.25)
    first = rows(actuator, 10)
    actuator.set_faults({'fault.leakage': 1e-12})
    rows(actuator, 10)
    actuator.reset()
    assert actuator.faults.active == {'fault.null_shift': 0.25, 'fault.leakage': 1e-12}
    again = rows(actuator, 10)
    assert again[:, Channels.SPOOL_1].tolist() == first[:, Channels.SPOOL_1].tolist()
    assert again[-1, Channels.POSITION] != first[-1, Channels.POSITION]


def test_cleared_it_goes_on_as_without_faults():
    actuator = make(null_shift=0.25, supply_loss=0.5, air_fraction=0.01, valve_stuck=True)
    rows(actuator, 5)
    actuator.clear_faults()
    assert actuator.faults.active == {}
    actuator.reset()
    assert same(actuator, make())


def test_a_refused_fault_sets_none_of_a_change():
    actuator = make()
    with pytest.raises(ParameterError, match='above the maximum'):
        actuator.set_faults({'fault.null_shift': 0.5, 'fault.leakage': 1.0})
    with pytest.raises(ParameterError, match=r'needs fault\.enabled'):
        Actuator(Parameters({'solver.cells': 60})).set_faults({'fault.leakage': 1e-12})
    assert actuator.faults.active == {}


@pytest.fixture
def script(tmp_path):
    """Write a script: two faults at 5 ms, one of them until 12.3 ms."""
    path = tmp_path / 'script.csv'
    path.write_text('time,parameter,value\n0.005,fault.null_shift,0.5\n'
                    '0.005,fault.supply_loss,0.5\n0.0123,fault.null_shift,0\n')
    return str(path)


def test_a_script_acts_from_the_tick_at_or_after_its_time(script):
    spools = rows(make(script=script), 20, 0.0)[:, Channels.SPOOL_1]
    assert spools.tolist() == [0.0] * 5 + [0.5 * STROKE] * 8 + [0.0] * 7


def test_any_way_of_advancing_gives_the_same_bits_with_a_script(script):
    ticked, followed, advanced = (make(script=script) for _ in range(3))
    steps = ticked.steps_per_period
    rows(ticked, 20)
    schedule = (np.zeros(1), np.array([[0.3, 0.3, 0.0]]), True)
    for part in (7, 4 * steps, 3, 16 * steps - 10):
        followed.follow(schedule, part)
    advanced.advance(0.0033, spool=0.3)
    advanced.advance(0.02 - advanced.time)
    assert ticked.row.tolist() == followed.row.tolist() == advanced.row.tolist()


def test_a_live_change_makes_the_bits_of_a_script(script):
    scripted, live = make(script=script), make()
    first = rows(live, 5)
    live.set_faults({'fault.null_shift': 0.5, 'fault.supply_loss': 0.5})
    middle = rows(live, 8)
    live.set_faults({'fault.null_shift': 0.0})
    assert rows(scripted, 20).tolist() == [*first.tolist(), *middle.tolist(),
                                           *rows(live, 7).tolist()]
