# SPDX-License-Identifier: Apache-2.0
"""The solver, driven by small sines and a knock, answers as the linear plant does."""

from hydra_actuator.errors import InputError
from hydra_actuator.response.distributed import respond
from hydra_actuator.response.lumped import lumped_plant, textbook_mode
from hydra_actuator.response.modes import find_modes
from hydra_actuator.response.solver import fit_sine, linearity, solver_mode, solver_responses
import numpy as np
import pytest

FREQUENCIES = np.array([40.0, 400.0])
# Second order in the cell: at 400 Hz a wave has 160 cells.
CLOSE = 1e-4
CASES = {
    'closed': {}, 'underlap, unequal areas': {'cylinder.area_2': 7e-4},
    'leaks and spool dynamics': {
        'valve.leakage': 2e-12, 'cylinder.leakage': 1e-12, 'valve.natural_frequency': 150.0}}


@pytest.mark.parametrize('case', CASES)
def test_small_sines_give_the_linear_plant(plant_of, underlap, case):
    changes = {**(underlap if 'underlap' in case else {}), **CASES[case]}
    plant = plant_of(changes)
    exact, got = respond(plant, FREQUENCIES), solver_responses(plant.point, FREQUENCIES)
    for name in ('velocity', 'load_pressure', 'stiffness'):
        assert getattr(got, name) == pytest.approx(getattr(exact, name), rel=CLOSE), name


def test_amplitude_is_so_small_that_it_does_not_matter(plant_of, underlap):
    assert linearity(plant_of(underlap).point, 100.0) < 1e-6


def test_ringing_after_a_knock_has_the_plants_mode(plant_of, underlap):
    plant = plant_of(underlap)
    near = textbook_mode(lumped_plant(plant)).frequency
    mode, exact = solver_mode(plant.point, near), find_modes(plant, 300.0)[0]
    assert mode.frequency == pytest.approx(exact.frequency, rel=1e-4)
    assert mode.damping == pytest.approx(exact.damping, rel=1e-3)


def test_a_piston_in_motion_is_refused(plant_of):
    point = plant_of({'cylinder.stiffness': 0.0}, spool=0.2).point
    with pytest.raises(InputError, match='at rest only'):
        solver_responses(point, FREQUENCIES)


def test_sine_is_found_beside_drift_and_harmonics():
    times = np.linspace(0.0, 0.2, 200)
    values = 3.0 + 5.0 * times + 0.2 * np.sin(20.0 * np.pi * times + 0.5) + 0.1 * np.cos(
        40.0 * np.pi * times)
    (found,) = fit_sine(times, values[:, None], 20.0 * np.pi)
    assert found == pytest.approx(0.2 * np.exp(0.5j), rel=1e-9)
