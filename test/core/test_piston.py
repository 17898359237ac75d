# SPDX-License-Identifier: Apache-2.0
"""The piston between two arriving waves: momentum, friction, stops, leakage."""

from itertools import pairwise
import math

from hydra_actuator.core.end import End
from hydra_actuator.core.piston import (
    face_pressures,
    implicitness,
    momentum_defect,
    move_piston,
    seal_friction,
    slide,
)
from hydra_actuator.core.records import PISTON_PARAMETERS
from hypothesis import given
from hypothesis import strategies as st
import numpy as np
import pytest

DENSITY, SPEED = 860.0, 1300.0
MODULUS = DENSITY * SPEED ** 2
AREAS = (1e-3, 7e-4)
STEP, LIMIT = 1e-5, 0.1
LAW = 1e-10             # of the force one face can bear, 10 kN
NO_SLIP = (0.0, 0.0)

pressures = st.floats(0.0, 4e7)
speeds = st.floats(-8.0, 8.0)
masses = st.sampled_from([0.0, 1e-3, 0.1, 10.0, 1000.0])
leakages = st.sampled_from([1e-13, 1e-12, 1e-11])
slips = st.tuples(st.floats(-1.0, 1.0), st.floats(-1.0, 1.0))


def piston(**fields) -> np.record:
    record = np.zeros(1, PISTON_PARAMETERS)
    record['mass'], record['limit'], record['stribeck_velocity'] = 10.0, LIMIT, 0.01
    record['length_1'] = record['length_2'] = 0.2
    for name, value in fields.items():
        record[name] = value
    return record[0]


def ends(p_1: float, p_2: float, v_1: float = 0.0, v_2: float = 0.0) -> tuple[End, End]:
    """Return both faces, with arriving waves of these pressures [Pa] and outflows [m/s]."""
    return tuple(
        End(SPEED * math.log1p(p / MODULUS) + v, 0.0, 1.0 / SPEED, MODULUS, area,
            DENSITY * SPEED / area, 1.0 / area)
        for p, v, area in zip((p_1, p_2), (v_1, v_2), AREAS))


def balanced(p_2: float = 1e7, surplus: float = 0.0) -> tuple[End, End]:
    """Return faces whose force at rest is `surplus` [N]."""
    return ends((AREAS[1] * p_2 + surplus) / AREAS[0], p_2)


def motion(velocity: float = 0.0, position: float = 0.0, force: float = 0.0,
           theta: float = 0.5) -> tuple:
    return position, velocity, force, theta, STEP, NO_SLIP


@given(pressures, pressures, speeds, speeds, masses, st.floats(-5e4, 5e4))
def test_momentum_balances_at_the_velocity_found(p_1, p_2, v_1, v_old, mass, load):
    this = piston(mass=mass, stiffness=2e5, viscous=500.0)
    faces = ends(p_1, p_2, v_1, -v_1)
    old = motion(v_old, 0.01, 300.0, implicitness(faces, this, STEP))
    velocity = slide(faces, this, old, load, 0.0)
    defect, _, _ = momentum_defect(faces, this, old, load, velocity)
    scale = 1e4 + mass / STEP * max(abs(velocity), abs(v_old))
    assert defect == pytest.approx(0.0, abs=LAW * scale)


@given(pressures, pressures, speeds, masses, speeds)
def test_slope_is_the_derivative_of_the_defect(p_1, p_2, v_old, mass, velocity):
    this = piston(mass=mass, stiffness=2e5, viscous=500.0)
    faces = ends(p_1, p_2)
    old = motion(v_old, 0.0, 0.0, 0.7)
    width = 1e-3
    above, below = (momentum_defect(faces, this, old, 0.0, velocity + side * width)[0]
                    for side in (0.5, -0.5))
    slope = momentum_defect(faces, this, old, 0.0, velocity)[1]
    assert slope == pytest.approx((above - below) / width, rel=1e-5)


def test_heavy_piston_takes_the_trapezoid_and_massless_the_new_level():
    faces = ends(1e7, 1e7)
    assert implicitness(faces, piston(mass=10.0), STEP) == 0.5
    assert implicitness(faces, piston(mass=0.0), STEP) == 1.0
    assert 0.5 < implicitness(faces, piston(mass=0.001), STEP) < 1.0


def test_massless_piston_neither_rings_nor_drifts():
    this, faces = piston(mass=0.0, viscous=500.0), ends(1.2e7, 1e7)
    x, v, trace = 0.0, -3.0, []
    for _ in range(50):
        old = motion(v, x, 0.0, implicitness(faces, this, STEP))
        x, v, _ = move_piston(faces, this, old, 0.0, v)
        trace.append(v)
    assert trace == pytest.approx([trace[0]] * 50, rel=1e-9)
    p_1, p_2, *_ = face_pressures(faces, this, v, NO_SLIP)
    assert AREAS[0] * p_1 - AREAS[1] * p_2 - 500.0 * v == pytest.approx(0.0, abs=LAW * 1e4)


@given(st.floats(-0.999, 0.999), st.floats(1.0, 500.0))
def test_seals_hold_the_piston_up_to_their_breakaway_force(share, breakaway):
    this = piston(coulomb=0.5 * breakaway, breakaway=breakaway)
    faces = balanced(surplus=share * breakaway)
    old = motion(force=share * breakaway)
    assert move_piston(faces, this, old, 0.0, 0.0) == (0.0, 0.0, 0)


@pytest.mark.parametrize('sign', [1.0, -1.0])
def test_piston_breaks_away_just_above_the_force_and_slides_that_way(sign):
    this = piston(coulomb=50.0, breakaway=80.0)
    for surplus, moves in ((79.9, False), (80.1, True)):
        faces = balanced(surplus=sign * surplus)
        _, velocity, _ = move_piston(faces, this, motion(force=sign * surplus), 0.0, 0.0)
        assert (velocity * sign > 0.0) == moves


@given(pressures, pressures, speeds, masses, st.sampled_from([(50.0, 50.0), (50.0, 80.0),
                                                              (2000.0, 5000.0)]))
def test_sliding_root_obeys_friction_and_its_sign(p_1, p_2, v_old, mass, forces):
    coulomb, breakaway = forces
    this, faces = piston(mass=mass, coulomb=coulomb, breakaway=breakaway), ends(p_1, p_2)
    old = motion(v_old, 0.0, 0.0, implicitness(faces, this, STEP))
    velocity = slide(faces, this, old, 0.0, v_old)
    at_rest = momentum_defect(faces, this, old, 0.0, 0.0)[0]
    if abs(at_rest) <= breakaway:
        assert velocity == 0.0
        return
    defect = momentum_defect(faces, this, old, 0.0, velocity)[0]
    direction = -math.copysign(1.0, at_rest)
    assert velocity * direction >= 0.0
    scale = 1e4 + mass / STEP * max(abs(velocity), abs(v_old))
    if velocity != 0.0:
        assert defect + direction * seal_friction(this, abs(velocity))[0] == pytest.approx(
            0.0, abs=LAW * scale)


def test_held_piston_does_not_creep():
    this, faces = piston(coulomb=50.0, breakaway=80.0), balanced(surplus=79.0)
    x, v, force = 0.0123, 0.0, 79.0
    for _ in range(10_000):
        x, v, _ = move_piston(faces, this, motion(v, x, force), 0.0, v)
    assert (x, v) == (0.0123, 0.0)


def test_friction_stops_a_coasting_piston_for_good():
    this = piston(mass=1.0, coulomb=500.0, breakaway=500.0)
    faces = balanced()
    x, v, force, speeds_seen = 0.0, 0.5, 0.0, []
    for _ in range(3000):
        x, v, _ = move_piston(faces, this, motion(v, x, force), 0.0, v)
        p_1, p_2, *_ = face_pressures(faces, this, v, NO_SLIP)
        force = AREAS[0] * p_1 - AREAS[1] * p_2
        speeds_seen.append(v)
    assert v == 0.0
    assert min(speeds_seen) >= 0.0
    assert (np.diff(speeds_seen) <= 0.0).all()


@given(st.floats(1e-5, 0.3))
def test_friction_falls_from_breakaway_to_coulomb_along_its_slope(speed):
    this = piston(coulomb=50.0, breakaway=80.0)
    force, slope = seal_friction(this, speed)
    assert 50.0 <= force <= 80.0
    width = 1e-6
    above, below = (seal_friction(this, speed + side * width)[0] for side in (0.5, -0.5))
    assert slope == pytest.approx((above - below) / width, rel=1e-4, abs=1e-5)
    assert seal_friction(piston(coulomb=50.0, breakaway=50.0), speed) == (50.0, 0.0)


@given(st.floats(0.0, 1.0), st.floats(0.01, 8.0), st.sampled_from([1.0, -1.0]), masses)
def test_end_stop_never_gives_energy(restitution, speed, side, mass):
    this = piston(mass=mass, restitution=restitution)
    position, velocity, hit = move_piston(
        balanced(), this, motion(side * speed, side * (LIMIT - 1e-9), side * 1e6), 0.0,
        side * speed)
    if hit:
        assert position == side * LIMIT
        assert velocity == -side * restitution * speed
    assert abs(position) <= LIMIT
    assert not hit or abs(velocity) <= speed


def test_piston_pressed_against_a_stop_rests_and_leaves_when_pulled():
    this = piston(restitution=0.5)
    pressed, pulled = balanced(surplus=5000.0), balanced(surplus=-5000.0)
    x, v = LIMIT, 0.0
    for _ in range(10):
        x, v, hit = move_piston(pressed, this, motion(v, x, 5000.0), 0.0, v)
        assert (x, v, hit) == (LIMIT, 0.0, 0)
    x, v, _ = move_piston(pulled, this, motion(v, x, 0.0), 0.0, v)
    assert x < LIMIT
    assert v < 0.0


@pytest.mark.parametrize('restitution', [0.0, 0.3, 0.9, 1.0])
def test_bouncing_piston_loses_energy_at_each_stop_and_comes_to_rest(restitution):
    # a massive piston in oil of one pressure, pushed by a constant load against the stop
    this = piston(mass=5.0, restitution=restitution)
    x, v, force, load = 0.099, 0.0, 100.0, -100.0
    hits, arrivals = 0, []
    for _ in range(200_000):
        before = v
        x, v, hit = move_piston(balanced(), this, motion(v, x, force), load, v)
        if hit:
            arrivals.append(before)
            hits += 1
        p_1, p_2, *_ = face_pressures(balanced(), this, v, NO_SLIP)
        force = AREAS[0] * p_1 - AREAS[1] * p_2 - load
        if hits == 3:
            break
    assert hits >= 1
    assert all(later <= earlier * (1.0 + 1e-9)
               for earlier, later in pairwise(arrivals))


@given(pressures, pressures, speeds, leakages, slips)
def test_leakage_keeps_the_mass_of_both_faces(p_1, p_2, velocity, leakage, slip):
    this, faces = piston(leakage=leakage), ends(p_1, p_2)
    p_e, p_f, _, _, u_e, u_f = face_pressures(faces, this, velocity, slip)
    flow = leakage * (p_e - p_f)
    for pressure, u, area in ((p_e, u_e, AREAS[0]), (p_f, u_f, AREAS[1])):
        ratio = 1.0 + pressure / MODULUS
        assert ratio * area * (u - velocity) == pytest.approx(flow, rel=LAW, abs=1e-17)


@given(pressures, pressures, speeds, leakages, slips)
def test_a_leaking_pistons_pressures_are_those_at_its_faces(p_1, p_2, velocity, leakage, slip):
    this, faces = piston(leakage=leakage), ends(p_1, p_2)
    p_e, p_f, _, _, u_e, u_f = face_pressures(faces, this, velocity, slip)
    for end, pressure, outflow in ((faces[0], p_e, u_e), (faces[1], p_f, -u_f)):
        at_face = MODULUS * math.expm1((end.wave - outflow) / SPEED)
        assert pressure == pytest.approx(at_face, rel=LAW, abs=LAW * 1e7)


@given(st.floats(-2e7, 4e7), st.floats(-2e7, 4e7), speeds, leakages, slips,
       st.floats(-7.0, -2.0))
def test_a_leaking_piston_finds_its_flow_from_anywhere(p_1, p_2, velocity, leakage, slip, air):
    # with gas too, where a chamber may boil: the waves are those of far too low a pressure
    floor = 1e5
    faces = tuple(end._replace(strength=0.5 * SPEED * 10.0 ** air * floor, floor=floor,
                               held=0.5 * SPEED * 10.0 ** air) for end in ends(p_1, p_2))
    this = piston(leakage=leakage)
    cold = face_pressures(faces, this, velocity, NO_SLIP)
    warm = face_pressures(faces, this, velocity, slip)
    assert warm[:2] == pytest.approx(cold[:2], rel=LAW, abs=LAW * 1e7)
    assert warm[4:] == pytest.approx(cold[4:], rel=1e-9, abs=1e-9)


def test_piston_without_leakage_moves_with_its_oil():
    *_, u_e, u_f = face_pressures(ends(1e7, 2e7), piston(), 0.7, NO_SLIP)
    assert (u_e, u_f) == (0.7, 0.7)


def test_a_force_that_is_no_number_leaves_none():
    for fields in ({}, {'coulomb': 50.0, 'breakaway': 80.0}):
        position, velocity, _ = move_piston(
            balanced(), piston(**fields), motion(), math.nan, 0.0)
        assert math.isnan(position)
        assert math.isnan(velocity)
