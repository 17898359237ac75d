# SPDX-License-Identifier: Apache-2.0
"""The linear plant of the whole streamline: against formulas, laws and the lumped limit."""

import math

from hydra_actuator.response.distributed import linear_plant, respond, spool_dynamics
from hydra_actuator.response.line_matrix import line_matrix, memory
from hydra_actuator.response.lumped import (
    lumped_modes,
    lumped_plant,
    respond_lumped,
    textbook_mode,
)
from hydra_actuator.response.modes import find_modes
from hydra_actuator.response.operating_point import find_operating_point
from hydra_actuator.response.position_loop import largest_gain
from hydra_actuator.verification import friction_laplace, spool_response
import numpy as np
import pytest

SIDES = {'cylinder.stiffness': 0.0, 'cylinder.viscous_friction': 0.0}


def test_about_null_it_is_the_closed_formula_to_all_digits(plant_of):
    frequencies = np.array(list(spool_response.EXPECTED), float)
    formula = [spool_response.exact_response(spool_response.paper_parameters(), f)
               for f in frequencies]
    assert respond(plant_of(), frequencies).velocity == pytest.approx(formula, rel=1e-11)


def test_lumped_plant_is_the_lumped_formula(plant_of):
    lumped = respond_lumped(lumped_plant(plant_of()), np.array([10.0, 700.0])).velocity
    formula = [spool_response.exact_response(spool_response.paper_parameters(), f, lumped=True)
               for f in (10.0, 700.0)]
    assert lumped == pytest.approx(formula, rel=1e-12)


@pytest.mark.parametrize('law', ['constant', 'steady', 'unsteady'])
def test_a_line_of_oil_at_rest_keeps_determinant_one(plant_of, law):
    plant = plant_of({'line_1.friction': law, 'fluid.cavitation': True})
    matrix = line_matrix(plant.lines[1], 2j * math.pi * np.array([1.0, 100.0, 3000.0]))
    assert np.linalg.det(matrix) == pytest.approx(np.ones(3), rel=1e-10)


def test_memory_and_laminar_friction_make_zielkes_propagation(plant_of):
    # s (s + 8 nu/r^2 + memory) = (s g)^2, g from an independent continued fraction
    rate = 4.6e-5 / 0.008 ** 2
    s = 2j * math.pi * np.array([5.0, 100.0, 1000.0])
    g = friction_laplace.propagation(s, rate)
    assert np.sqrt(s * (s + 8.0 * rate + memory(rate, s))) == pytest.approx(s * g, rel=1e-9)


def test_a_quasi_steady_line_flows_as_its_own_law_says(plant_of):
    plant = plant_of({**SIDES, 'return_line.friction': 'steady', 'supply_line.friction': 'steady'},
                     spool=0.5)
    line = plant.lines[0]
    (matrix,) = line_matrix(line, np.array([1e-6j]))
    point = plant.point
    p = point.parameters
    more = find_operating_point(p, spool=0.501)
    drop = (more.pump - more.at_a) - (point.pump - point.at_a)
    flow = float(more.network[0] - point.network[0])
    assert -(matrix[0, 1] / matrix[1, 1]).real == pytest.approx(drop / flow, rel=2e-3)


def test_slow_response_is_the_slope_of_the_steady_states(plant_of):
    plant = plant_of(SIDES, spool=0.3, load=2000.0)
    p = plant.point.parameters
    step = 1e-4
    ahead, behind = (find_operating_point(p, spool=0.3 + h, load=2000.0) for h in (step, -step))
    slow = respond(plant, np.array([1e-3]))
    travel = 2.0 * step * p['valve.stroke']
    assert slow.velocity[0].real == pytest.approx(
        (ahead.velocity - behind.velocity) / travel, rel=1e-5)
    assert slow.pressure_1[0].real == pytest.approx(
        (ahead.face_1 - behind.face_1) / travel, rel=1e-3)


def test_an_accumulator_holds_the_pressure_of_a_limited_pump(plant_of):
    limited = {**SIDES, 'supply.max_flow': 5e-4}
    stored = {**limited, 'supply.accumulator_volume': 1e-2,
              'supply.accumulator_precharge': 1e6}
    fast = np.array([40.0])
    bare, soft = (respond(plant_of(changes, spool=1.0), fast).velocity[0]
                  for changes in (limited, stored))
    assert abs(bare) < 0.5 * abs(soft)


def test_mirrored_plant_answers_with_mirrored_pressures(plant_of, underlap):
    responses = respond(plant_of(underlap), np.array([30.0, 400.0]))
    assert responses.pressure_1 == pytest.approx(-responses.pressure_2, rel=1e-6)


def test_spool_dynamics_is_second_order(plant_of):
    plant = plant_of({'valve.natural_frequency': 100.0, 'valve.damping_ratio': 0.5})
    assert spool_dynamics(plant, np.array([100.0]))[0] == pytest.approx(-1j)
    assert spool_dynamics(plant_of(), np.array([1.0, 2.0])) == pytest.approx([1.0, 1.0])


def test_main_mode_is_the_zero_of_the_closed_formula(plant_of):
    (mode,) = find_modes(plant_of(), 500.0)
    omega = 2.0 * math.pi * mode.frequency
    s = omega * complex(-mode.damping, math.sqrt(1.0 - mode.damping ** 2))
    p = spool_response.paper_parameters()
    near, far = (abs(spool_response.exact_response(p, x / (2j * math.pi)))
                 for x in (s * (1.0 + 1e-6), s * 1.01))
    assert near > 1e3 * far


def test_waves_of_the_lines_are_modes_of_their_own(plant_of, underlap):
    frequencies = [mode.frequency for mode in find_modes(plant_of({
        **underlap, 'valve.gain_bt': 0.5}), 1000.0)]
    assert frequencies[1] == pytest.approx(1300.0 / (4.0 * 0.6), rel=0.01)


def test_textbook_is_merritts_formula(plant_of, underlap):
    lumped = lumped_plant(plant_of({**underlap, 'cylinder.stiffness': 0.0}))
    mode = textbook_mode(lumped)
    beta, area, mass = 1.4534e9 + 10.5e6, 1e-3, 10.0
    volume = 2.0 * (2e-4 + 0.2 * 0.25 * math.pi * 0.016 ** 2)
    assert 2.0 * math.pi * mode.frequency == pytest.approx(
        math.sqrt(4.0 * beta * area ** 2 / (volume * mass)), rel=1e-6)
    assert mode.damping == pytest.approx(
        lumped.flow_pressure / area * math.sqrt(beta * mass / volume)
        + 500.0 / (4.0 * area) * math.sqrt(volume / (beta * mass)), rel=1e-6)
    (exact,) = lumped_modes(lumped)
    assert exact.frequency == pytest.approx(mode.frequency, rel=2e-3)


def test_a_plant_without_mass_has_no_textbook_mode(plant_of):
    lumped = lumped_plant(plant_of({'cylinder.mass': 0.0}))
    assert textbook_mode(lumped) is None
    assert lumped_modes(lumped) == []


def test_largest_gain_of_a_position_loop_is_twice_damping_times_natural_frequency(plant_of):
    plant = plant_of({'cylinder.stiffness': 0.0})
    lumped = lumped_plant(plant)
    frequencies = np.geomspace(1.0, 1000.0, 4000)
    responses = respond_lumped(lumped, frequencies)
    gain = largest_gain(responses, np.ones(len(frequencies)))
    (mode,) = lumped_modes(lumped)
    limit = 2.0 * mode.damping * 2.0 * math.pi * mode.frequency
    assert gain * abs(responses.velocity[0]) == pytest.approx(limit, rel=1e-3)


def test_overlap_lets_nothing_through(plant_of):
    plant = plant_of({f'valve.overlap_{edge}': 1e-5 for edge in ('pa', 'pb', 'at', 'bt')})
    assert not respond(plant, np.array([10.0])).velocity.any()
    assert plant.valve.overlapped.all()


def test_linear_plant_takes_any_operating_point_of_two_spools(plant_of, underlap):
    plant = plant_of({**underlap, 'valve.spools': 2}, spool=(0.01, -0.01), position=0.0)
    assert np.isfinite(respond(linear_plant(plant.point), np.array([1.0, 900.0])).velocity).all()
