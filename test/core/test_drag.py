# SPDX-License-Identifier: Apache-2.0
"""The sweep with drag: against the plain sweep and against steady and decaying flow."""

import math

from hydra_actuator.core.compilation import kernel
from hydra_actuator.core.drag import drag_at, drag_on_arrival, remember, wall_of
from hydra_actuator.core.lanes import load, store, WIDTH
from hydra_actuator.core.model import Domain, Junction, Mesh
from hydra_actuator.core.oil import Oil
from hydra_actuator.core.records import CLOSED, PRESSURE
from hydra_actuator.verification.chains import DENSITY, LoneChain, WAVE_SPEED
import numpy as np
import pytest

VISCOSITY = 46e-6
OIL = Oil(DENSITY, VISCOSITY)
LENGTH, RADIUS = 2.0, 0.005
AREA = math.pi * RADIUS ** 2
STEP = LENGTH / (100 * 1.025 * WAVE_SPEED)


def line(friction: str, loss: float = 0.0, pressure: float = 0.0) -> Domain:
    return Domain('line', LENGTH, AREA, WAVE_SPEED, loss, pressure, friction=friction)


def ends(first: int, input_column: int) -> list[Junction]:
    return [Junction(PRESSURE, (first,), input_column), Junction(CLOSED, (first + 1,))]


def test_constant_friction_is_the_same_with_and_without_the_machinery_of_drag():
    plain = LoneChain([line('constant', 5.0)], ends(0, 0), Mesh(STEP))
    beside = LoneChain([line('constant', 5.0), line('steady')], ends(0, 0) + ends(2, 1),
                       Mesh(STEP), OIL)
    assert not plain.model.extras
    assert beside.model.extras
    differences, sizes = [], []
    for k in range(1200):
        drive = 1e6 * math.sin(2.0 * math.pi * 200.0 * k * STEP)
        plain.step(drive)
        beside.step(drive)
        differences.append(np.abs(plain.pressure(0) - beside.pressure(0)).max())
        sizes.append(np.abs(plain.pressure(0)).max())
    # u|u| at the foot interpolated, or u: a difference of second order in the cell
    assert max(differences) < 2e-5 * max(sizes)
    assert max(differences) > 0.0


@pytest.mark.parametrize('friction', ['steady', 'unsteady'])
def test_laminar_flow_settles_at_hagen_poiseuille(friction):
    chain = LoneChain([line(friction)], [Junction(PRESSURE, (0,), 0), Junction(PRESSURE, (1,), 1)],
                      Mesh(STEP), OIL)
    drop = 2e4
    chain.hold(drop, 0.0)
    chain.advance(60_000)
    exact = drop * RADIUS ** 2 / (8.0 * DENSITY * VISCOSITY * LENGTH)
    assert exact * 2.0 * RADIUS / VISCOSITY < 1500.0
    assert chain.velocity(0) == pytest.approx(np.full(101, exact), rel=1e-3)


def test_memory_of_the_friction_damps_ringing_faster():
    left = {}
    for friction in ('steady', 'unsteady'):
        chain = LoneChain([line(friction)], ends(0, 0), Mesh(STEP), OIL)
        chain.hold(1e4)
        chain.advance(8000)
        trace = []
        for _ in range(800):
            chain.advance()
            trace.append(chain.end_pressure(1) - 1e4)
        left[friction] = np.abs(trace).max()
    assert left['unsteady'] < 0.7 * left['steady']


@kernel
def drag_of_all(model, state, velocity, drag):
    for d in range(model.start.size):
        first = model.start[d]
        wall = wall_of(model, first)
        for i in range(first, first + state.last[d] + 1, WIDTH):
            store(drag, i, drag_on_arrival(model, state, i, wall, load(velocity, i)))


@kernel
def remember_domain(model, state, first, end):
    remember(model, state, first, end)


def test_memory_and_drag_are_renewed_as_the_recursion_says():
    chain = LoneChain([line('unsteady')], ends(0, 0), Mesh(STEP), OIL)
    chain.hold(5e5)
    chain.advance(150)
    model, state = chain.model, chain.state
    first, end = model.start[0], model.start[0] + state.last[0] + 1
    nodes = slice(first, end)
    state.new_p[nodes] += np.random.default_rng(2).normal(0.0, 0.1, end - first)
    old, new = (0.5 * (p[nodes] - q[nodes]) for p, q in (
        (state.wave_p, state.wave_q), (state.new_p, state.new_q)))
    decay, gain = model.decay[:, nodes], model.gain[:, nodes]
    kept = decay * state.memory[:, nodes] + gain * (new - old)
    drag = new * state.damping[nodes] + model.inertia[nodes] * (new - old) + kept.sum(axis=0)
    remember_domain(model, state, first, end)
    assert state.memory[:, nodes] == pytest.approx(kept, rel=1e-12, abs=1e-15)
    assert state.fading[nodes] == pytest.approx((decay * kept).sum(axis=0), rel=1e-11, abs=1e-13)
    assert state.drag[nodes] == pytest.approx(drag, rel=1e-11, abs=1e-13)
    assert np.ptp(drag) > 0.1


def test_the_drag_of_one_node_is_that_of_the_loop_over_all():
    chain = LoneChain(
        [line('steady'), line('unsteady', pressure=1e4), line('constant', 5.0)],
        ends(0, 0) + ends(2, 1) + ends(4, 2), Mesh(STEP), OIL)
    chain.hold(5e5, -3e5, 2e5)
    chain.advance(150)
    model, state = chain.model, chain.state
    velocity = 0.5 * (state.wave_p - state.wave_q) + np.random.default_rng(1).normal(
        0.0, 0.15, state.wave_p.size)
    in_lanes = np.zeros(state.wave_p.size)
    drag_of_all(model, state, velocity, in_lanes)
    nodes = [i for d in range(3) for i in range(model.start[d], model.start[d] + 101)]
    alone = np.array([drag_at(model, state, i, velocity[i]) for i in nodes])
    assert alone == pytest.approx(in_lanes[nodes], rel=1e-12, abs=1e-15)
    assert all(np.ptp(part) > 0.1 for part in alone.reshape(3, -1))
