# SPDX-License-Identifier: Apache-2.0
"""The steady state about which the plant is linearised."""

from hydra_actuator.actuator import Actuator
from hydra_actuator.errors import InputError
from hydra_actuator.parameters import Parameters
from hydra_actuator.response.operating_point import find_operating_point
from hydra_actuator.steady_flow import AT, BT, PA, PAST, PB
import pytest

FREE = Parameters().replace({'cylinder.stiffness': 0.0, 'cylinder.viscous_friction': 0.0})


def test_null_of_a_closed_valve_is_the_start():
    point = find_operating_point(Parameters())
    assert (point.position, point.velocity, point.face_1) == (0.0, 0.0, 10.5e6)


def test_a_closed_valve_holds_a_load_between_trapped_oil():
    point = find_operating_point(FREE, load=4000.0)
    assert point.velocity == 0.0
    assert point.face_1 - point.face_2 == pytest.approx(4000.0 / 1e-3)


def test_a_load_without_valve_flow_moves_the_piston_until_the_spring_holds_it():
    point = find_operating_point(Parameters(), load=4000.0)
    assert point.position == pytest.approx(-4000.0 / 2e5)


def test_an_open_valve_moves_the_piston_as_the_solver_does():
    point = find_operating_point(FREE, spool=0.2, load=1000.0)
    # the piston starts off the middle, so that it passes it when all is quiet
    actuator = Actuator(FREE.replace({
        'initial.position': -0.02, 'cylinder.viscous_friction': 3000.0}))
    damped = find_operating_point(
        FREE.replace({'cylinder.viscous_friction': 3000.0}), spool=0.2, load=1000.0)
    state = actuator.advance(0.1, spool=0.2, load_force=1000.0)
    assert state.velocity == pytest.approx(damped.velocity, rel=2e-3)
    assert point.velocity > damped.velocity


def test_mass_and_forces_balance_in_motion():
    p = FREE.replace({'cylinder.area_2': 6e-4, 'cylinder.leakage': 2e-12, 'valve.leakage': 1e-12})
    point = find_operating_point(p, spool=-0.4, load=500.0)
    x, chi = point.network, p['fluid.bulk_modulus']
    assert 1e-3 * point.face_1 - 6e-4 * point.face_2 == pytest.approx(500.0, abs=1e-3)
    assert x[PA] - x[AT] - x[PAST] == pytest.approx(
        1e-3 * point.velocity * (1.0 + point.face_1 / chi), rel=1e-7)
    assert x[BT] - x[PB] - x[PAST] == pytest.approx(
        6e-4 * point.velocity * (1.0 + point.face_2 / chi), rel=1e-7)


def test_pump_at_its_limit_gives_its_flow_at_less_pressure():
    point = find_operating_point(FREE.replace({'supply.max_flow': 5e-4}), spool=1.0)
    assert point.limited
    assert point.network[PA] + point.network[PB] == pytest.approx(5e-4, rel=1e-8)
    assert point.pump < 21e6


def test_a_given_position_holds_the_springs_force():
    point = find_operating_point(Parameters(), position=0.01)
    assert (point.face_1 - point.face_2) * 1e-3 == pytest.approx(0.01 * 2e5)


def test_seal_friction_is_left_out_and_said_so():
    point = find_operating_point(Parameters().replace({
        'cylinder.coulomb_friction': 50.0, 'cylinder.static_friction': 80.0}))
    assert any('80 N' in note for note in point.notes)


@pytest.mark.parametrize(('point', 'message'), [
    ({'load': 1e6}, 'leans against its stop'),
    ({'position': 0.2}, 'beyond the stops'),
    ({'spool': 1.0, 'position': 0.0, 'load': 3e4}, 'cavitates')])
def test_what_is_no_operating_point_is_refused(point, message):
    with pytest.raises(InputError, match=message):
        find_operating_point(Parameters(), **point)


def test_a_load_on_a_leaking_piston_behind_a_closed_valve_is_refused():
    with pytest.raises(InputError, match='nothing is steady'):
        find_operating_point(FREE.replace({'cylinder.leakage': 1e-12}), load=100.0)
