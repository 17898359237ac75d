# SPDX-License-Identifier: Apache-2.0
"""Four orifices in one vector: the bits of each alone, or nothing at all."""

from hydra_actuator.assembly import assemble
from hydra_actuator.core.compilation import kernel
from hydra_actuator.core.junctions import end_of, solve_valve_junction
from hydra_actuator.core.model import build_chain, Domain, Junction, Mesh
from hydra_actuator.core.oil import Oil
from hydra_actuator.core.orifice import solve_orifice
from hydra_actuator.core.orifices import EDGES, solve_open_orifices
from hydra_actuator.core.records import CLOSED, ORIFICE, VALVE
from hydra_actuator.parameters import Parameters
import numpy as np
import pytest

DIRECT, REVERSE = (0, 3), (1, 2)


@kernel
def at_once(model, state):
    return solve_open_orifices(model, state)


@kernel
def one_by_one(model, state):
    for j in range(model.junctions.size):
        junction = model.junctions[j]
        if junction.kind == VALVE:
            solve_valve_junction(model, state, junction)
        elif junction.kind == ORIFICE:
            end, other = junction.end[0], junction.end[1]
            state.end_velocity[end], state.end_velocity[other] = solve_orifice(
                end_of(model, state, end), end_of(model, state, other), junction.coefficient,
                junction.leakage)


def chain(edges, chance, fastest=8.0, **changes):
    """Return a model and a state with random waves, these edges open."""
    model, state = assemble(Parameters().replace(changes))
    state.edge_coefficient[:EDGES] = 0.0
    for edge in edges:
        state.edge_coefficient[edge] = chance.choice([1e-9, 1e-7, 3e-7]) * chance.uniform(0.1, 1.0)
    ends = state.end_wave.size
    state.end_wave[:] = chance.uniform(0.0, 24.0, ends) + chance.uniform(-fastest, fastest, ends)
    state.end_velocity[:] = chance.uniform(-fastest, fastest, ends)
    return model, state


@pytest.mark.parametrize('edges', [DIRECT, REVERSE, (0,), (2,), ()])
@pytest.mark.parametrize('friction', ['constant', 'steady'])
def test_four_orifices_at_once_have_the_bits_of_each_alone(edges, friction):
    chance = np.random.default_rng(len(edges))
    for _ in range(50):
        model, state = chain(edges, chance, **{'line_1.friction': friction})
        before = state.end_velocity.copy()
        one_by_one(model, state)
        alone = state.end_velocity.copy()
        state.end_velocity[:] = before
        assert at_once(model, state)
        assert state.end_velocity.tolist() == alone.tolist()


def left_alone(model, state) -> bool:
    """Return whether the orifices are not solved at once, and nothing is changed."""
    before = state.end_velocity.copy()
    return not at_once(model, state) and np.array_equal(
        state.end_velocity, before, equal_nan=True)


@pytest.mark.parametrize(('edges', 'changes'), [
    ((0, 1, 2, 3), {}), ((0, 1), {}), (DIRECT, {'valve.leakage': 1e-13}),
    (REVERSE, {'fluid.cavitation': True})])
def test_a_ring_a_valve_that_leaks_and_gas_are_left_alone(edges, changes):
    assert left_alone(*chain(edges, np.random.default_rng(1), **changes))


@pytest.mark.parametrize('wave', [60.0, -60.0, np.nan, np.inf])
def test_what_no_series_reaches_is_left_alone(wave):
    chance = np.random.default_rng(2)
    for end in (1, 2, 3, 4, 6, 8, 9, 10):
        model, state = chain(DIRECT, chance)
        state.end_wave[end] = wave
        assert left_alone(model, state)


def test_a_chain_without_a_valve_has_nothing_to_solve_at_once():
    model, state = build_chain(
        Oil(860.0), [Domain('line', 2.0, 2e-4, 1300.0)],
        [Junction(CLOSED, (0,)), Junction(CLOSED, (1,))], Mesh(1e-5))
    assert left_alone(model, state)
