# SPDX-License-Identifier: Apache-2.0
"""What is read from a state, and which limits are found in it."""

import math

from hydra_actuator.channels import Channels
from hydra_actuator.core.model import Domain, Junction, Mesh, set_domain
from hydra_actuator.core.observe import (
    find_limits,
    NOT_A_NUMBER,
    observe,
    read_field,
    runs_away,
    SECTION,
    SOUND,
    TOO_FAST,
    TOO_SHORT,
    within_partial_cell,
)
from hydra_actuator.core.records import CLOSED, PISTON, PISTON_PARAMETERS
from hydra_actuator.verification.chains import LoneChain, pressure_of, riemann_variable
import numpy as np
import pytest

SPEED, AREA = 1300.0, 1e-3
STEP, MACH = 1e-5, 0.025
CELL = SPEED * (1.0 + MACH) * STEP
LENGTHS = (10.4 * CELL, 7.7 * CELL)
ORIGINS = (0.3, 0.3 + sum(LENGTHS))
AMBIENT = 101325.0


@pytest.fixture
def cylinder() -> LoneChain:
    """Return two chambers with a piston between, the second seen from its far end."""
    piston = np.zeros(1, PISTON_PARAMETERS)
    piston['mass'], piston['limit'] = 10.0, 5.0 * CELL
    piston['length_1'], piston['length_2'] = LENGTHS
    chambers = [
        Domain(f'chamber_{k + 1}', LENGTHS[k], AREA, SPEED, longest=LENGTHS[k] + 5.0 * CELL,
               origin=ORIGINS[k], direction=1.0 - 2.0 * k) for k in range(2)]
    return LoneChain(
        chambers, [Junction(CLOSED, (0,)), Junction(CLOSED, (2,)), Junction(PISTON, (1, 3))],
        Mesh(STEP, MACH), piston=piston)


def fill(chain: LoneChain, pressure, velocity) -> None:
    """Give every node and face the values of functions of the streamline coordinate."""
    for d in range(2):
        side = chain.model.direction[d]
        x = ORIGINS[d] + side * chain.positions(d)
        mu, u = riemann_variable(pressure(x)), side * velocity(x)
        set_domain(chain.model, chain.state, d, (mu + u)[:-1], (mu - u)[:-1])
        chain.state.face_p[d], chain.state.face_q[d, :] = (mu + u)[-1], (mu - u)[-1]


def row_of(chain: LoneChain, sections: np.ndarray) -> tuple[np.ndarray, Channels]:
    names = tuple(f's{k}' for k in range(len(sections)))
    channels = Channels(names, domains=('chamber_1', 'chamber_2'))
    row = channels.empty_row()
    assert observe(chain.model, chain.state, sections, AMBIENT, chain.inputs, row) == SOUND
    return row, channels


def own_sections(positions) -> np.ndarray:
    sections = np.zeros(len(positions), SECTION)
    sections['end'], sections['cylinder'], sections['position'] = -1, 1, positions
    return sections


def linear(x):
    return 1e7 + 1e6 * (x - 0.4)


def gentle(x):
    return 0.5 + 0.2 * (x - 0.4)


def test_sections_across_the_stroke_read_either_chamber(cylinder):
    fill(cylinder, linear, gentle)
    x = np.linspace(ORIGINS[0], ORIGINS[1], 173)
    row, channels = row_of(cylinder, own_sections(x))
    # mu is not quite linear where p is
    np.testing.assert_allclose(row[channels.pressure], linear(x) + AMBIENT, rtol=1e-7)
    np.testing.assert_allclose(row[channels.flow_velocity], gentle(x), rtol=1e-9)


def test_each_side_of_the_face_reads_its_own_chamber(cylinder):
    face = ORIGINS[0] + LENGTHS[0]
    fill(cylinder, lambda x: np.where(x - face < 1e-12, 5e6, 15e6), lambda x: 0.0 * x)
    for d, pressure in enumerate((5e6, 15e6)):
        mu = float(riemann_variable(pressure))
        set_domain(cylinder.model, cylinder.state, d, mu, mu)
    row, channels = row_of(cylinder, own_sections([face - 1e-9, face + 1e-9]))
    assert row[channels.pressure] == pytest.approx([5e6 + AMBIENT, 15e6 + AMBIENT], rel=1e-12)


def test_ends_read_node_or_face_with_the_streamlines_sign(cylinder):
    fill(cylinder, linear, gentle)
    sections = np.zeros(4, SECTION)
    sections['end'] = range(4)
    row, channels = row_of(cylinder, sections)
    x = np.array([ORIGINS[0], ORIGINS[0] + LENGTHS[0], ORIGINS[1], ORIGINS[1] - LENGTHS[1]])
    np.testing.assert_allclose(row[channels.pressure], linear(x) + AMBIENT, rtol=1e-12)
    np.testing.assert_allclose(row[channels.flow_velocity], gentle(x), rtol=1e-12)


def test_row_holds_piston_force_spools_load_and_mach(cylinder):
    fill(cylinder, linear, gentle)
    state = cylinder.state
    state.piston[0]['position'], state.piston[0]['velocity'] = 0.012, 0.7
    state.spool[:] = 1e-4, 5.0, -2e-4, 6.0
    state.step[0] = 300
    cylinder.inputs[2] = 250.0
    row, channels = row_of(cylinder, own_sections([0.35]))
    face = ORIGINS[0] + LENGTHS[0]
    force = AREA * (linear(face) - linear(ORIGINS[1] - LENGTHS[1]))
    assert row[:channels.MACH] == pytest.approx(
        [300 * STEP, 0.012, 0.7, force, 1e-4, -2e-4, 250.0], abs=1e-5)
    assert row[channels.MACH] == pytest.approx(gentle(ORIGINS[1]) / SPEED, rel=1e-9)


def test_field_lists_chamber_face_face_chamber_along_the_streamline(cylinder):
    fill(cylinder, linear, gentle)
    model, last = cylinder.model, cylinder.state.last
    count = int(sum(model.capacity + 2))
    out = np.full((count, 2), -1.0, np.float32)
    assert read_field(model, cylinder.state, AMBIENT, out) == count
    first = model.capacity[0] + 2
    x_1 = np.append(ORIGINS[0] + CELL * np.arange(last[0] + 1), ORIGINS[0] + LENGTHS[0])
    x_2 = np.append(ORIGINS[1] - LENGTHS[1], ORIGINS[1] - CELL * np.arange(last[1], -1, -1))
    covered = ~np.isnan(out[:, 0])
    np.testing.assert_allclose(out[:first][covered[:first], 0], linear(x_1) + AMBIENT, rtol=1e-6)
    np.testing.assert_allclose(out[first:][covered[first:], 1], gentle(x_2), rtol=1e-6)
    assert covered.sum() == last[0] + last[1] + 4
    assert covered[first - 1]
    assert covered[first]


@pytest.mark.parametrize('distance', [0.0, 0.1, 0.37, 0.6])
def test_partial_cell_is_read_along_a_parabola_to_the_face(distance):
    values = np.array([9.0, 2.0, 5.0])
    curve = np.polynomial.Polynomial.fit([-1.0, 0.0, 0.6], [2.0, 5.0, 4.0], 2)
    assert within_partial_cell(values, 2, 2, (4.0, 0.6, distance)) == pytest.approx(
        curve(distance), rel=1e-12)


def test_beyond_the_face_the_face_is_read_even_without_a_partial_cell():
    values = np.array([2.0, 5.0])
    assert within_partial_cell(values, 1, 1, (4.0, 0.6, 0.6000001)) == 4.0
    assert within_partial_cell(values, 1, 1, (4.0, 0.0, 0.0)) == 4.0


@pytest.mark.parametrize('place', ['node', 'last node', 'face'])
@pytest.mark.parametrize('d', [0, 1])
def test_a_nan_anywhere_is_found_in_its_domain(cylinder, d, place):
    fill(cylinder, linear, gentle)
    state, first = cylinder.state, cylinder.model.start[d]
    if place == 'face':
        state.face_p[d] = math.nan
    else:
        state.wave_q[first + (3 if place == 'node' else state.last[d])] = math.nan
    code, mach = find_limits(cylinder.model, state)
    assert code == NOT_A_NUMBER
    assert state.fault[1] == d
    assert math.isnan(mach)


@pytest.mark.parametrize('velocity', [1.001, -1.001, math.nan, math.inf])
def test_oil_that_runs_away_is_found_at_every_end(cylinder, velocity):
    model, state = cylinder.model, cylinder.state
    for end in range(4):
        state.end_velocity[:] = 0.999 * MACH * SPEED
        assert not runs_away(model, state)
        state.end_velocity[end] = velocity * MACH * SPEED
        assert runs_away(model, state)


@pytest.mark.parametrize('d', [0, 1])
def test_fast_oil_is_found_with_its_mach_number(cylinder, d):
    fill(cylinder, linear, gentle)
    state, node = cylinder.state, cylinder.model.start[d] + 4
    state.wave_p[node] = state.wave_q[node] + 2.0 * 1.01 * MACH * SPEED
    code, mach = find_limits(cylinder.model, state)
    assert code == TOO_FAST
    assert state.fault[1] == d
    assert mach == pytest.approx(1.01 * MACH, rel=1e-12)
    assert state.fault[2] == mach


def test_a_chamber_below_one_cell_is_found_with_its_length(cylinder):
    fill(cylinder, linear, gentle)
    cylinder.state.length[1] = 0.99 * CELL
    assert find_limits(cylinder.model, cylinder.state)[0] == TOO_SHORT
    assert cylinder.state.fault[1:].tolist() == [1.0, 0.99 * CELL]


def test_a_sound_state_has_no_fault(cylinder):
    fill(cylinder, linear, gentle)
    code, mach = find_limits(cylinder.model, cylinder.state)
    assert code == SOUND
    assert mach == pytest.approx(gentle(ORIGINS[1]) / SPEED, rel=1e-9)
    assert float(pressure_of(riemann_variable(1e7))) == pytest.approx(1e7, rel=1e-14)
