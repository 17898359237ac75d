# SPDX-License-Identifier: Apache-2.0
"""One run: its figures are those of the actuator itself, its failures have a reason."""

import math

from hydra_actuator.actuator import Actuator
from hydra_actuator.channels import Channels
from hydra_actuator.parameters import Parameters
from hydra_actuator.signals import Sine, Step
from hydra_actuator.simulate import simulate
from hydra_actuator.sweep.merit import NAMES
from hydra_actuator.sweep.run import DONE, Drive, NOT_A_NUMBER, REFUSED, run_one, STOPPED
import numpy as np
import pytest

BASE = {'solver.cells': 40}
DRIVE = Drive(Sine(200.0), 0.005, 0.0, 1e9)


@pytest.fixture(scope='module')
def outcome():
    return run_one(3, BASE, {'cylinder.mass': 5.0}, DRIVE)


def test_a_run_yields_every_figure(outcome):
    assert (outcome.run, outcome.status, outcome.reason) == (3, DONE, '')
    assert set(outcome.figures) == set(NAMES)


def test_its_figures_are_those_of_simulate(outcome):
    parameters = Parameters({**BASE, 'cylinder.mass': 5.0})
    ran = simulate(parameters, Sine(200.0), 0.005, rate=1e9)
    rows, channels = ran.rows[1:], ran.channels
    position, velocity = rows[:, Channels.POSITION], rows[:, Channels.VELOCITY]
    figures = outcome.figures
    assert figures['travel'] == np.ptp(position)
    assert figures['final_position'] == position[-1]
    assert figures['peak_velocity'] == np.abs(velocity).max()
    assert figures['rms_velocity'] == pytest.approx(np.sqrt(np.mean(velocity**2)))
    assert figures['lowest_pressure'] == rows[:, channels.lowest_pressure].min()
    # Anywhere is nowhere less than at the stations, but for single precision.
    assert figures['peak_pressure'] >= rows[:, channels.pressure].max() - 2.0


def test_figures_count_from_the_start_asked_for():
    whole, late = (run_one(0, BASE, {}, Drive(Step(1.0), 0.02, start, 1e4)).figures
                   for start in (0.0, 0.015))
    assert late['travel'] < 0.5 * whole['travel']
    assert late['final_position'] == whole['final_position']


def test_refused_parameters_say_why():
    outcome = run_one(0, BASE, {'cylinder.static_friction': 1.0, 'cylinder.coulomb_friction': 2.0},
                      DRIVE)
    assert outcome.status == REFUSED
    assert 'cylinder.static_friction = 1.0 must not be below' in outcome.reason


def test_a_run_that_breaks_the_method_says_where():
    outcome = run_one(0, BASE, {'solver.max_mach': 0.001}, DRIVE)
    assert outcome.status == STOPPED
    assert 'exceeds solver.max_mach' in outcome.reason


def test_a_run_whose_field_is_no_number_is_kept_apart(monkeypatch):
    reset = Actuator.reset

    def spoiled(self):
        reset(self)
        self._state.wave_p[:] = math.nan
    monkeypatch.setattr(Actuator, 'reset', spoiled)
    outcome = run_one(0, BASE, {}, DRIVE)
    assert outcome.status == NOT_A_NUMBER
    assert outcome.reason.startswith('NaN in ')


def test_without_station_o_nothing_is_said_of_the_pump():
    outcome = run_one(0, BASE, {'sections.names': ('A', 'E')}, DRIVE)
    assert outcome.status == DONE
    assert math.isnan(outcome.figures['supply_power'])
