# SPDX-License-Identifier: Apache-2.0
"""The runs are the solver's own, kept whole and made once, in the paper's units."""

import math

from hydra_actuator.channels import STATIONS
from hydra_actuator.errors import Failure
from hydra_actuator.paper import runs
from hydra_actuator.paper.case import CASES
from hydra_actuator.paper.runs import FREQUENCY, make_run, reference
from hydra_actuator.signals import Sine
from hydra_actuator.simulate import simulate
from hydra_actuator.verification.passes import STEPS_BETWEEN
from hydra_actuator.verification.spool_response import paper_parameters
import numpy as np
import pytest


def test_units_are_those_of_the_papers_equation_17(case):
    run = case.run()
    assert run.length_unit == pytest.approx(2.0)
    assert 1.0 / run.time_unit == pytest.approx(650.0, rel=1e-4)
    assert run.velocity_unit == pytest.approx(2e-3 / (math.pi * 0.008**2))
    assert run.pressure_unit == 21e6


def test_the_papers_case_is_forty_units_a_period_and_the_other_as_fast_as_its_waves():
    unit = reference(duration=1e-4, cells=60).time_unit
    assert 1.0 / (CASES['plain'].frequency * unit) == pytest.approx(40.0, rel=1e-4)
    assert 1.0 / (CASES['200hz'].frequency * unit) == pytest.approx(3.25, rel=1e-4)
    assert CASES['200hz'].amplitude == 0.3


def test_the_same_wish_is_the_same_run(case):
    assert case.run() is case.run()
    assert case.run() is not case.run(passes=1)


def test_every_step_is_kept_and_the_field_as_often_a_period_as_the_papers(case):
    run = case.run()
    steps = math.ceil(case.duration / run.step_time - 1e-6)
    between = round(STEPS_BETWEEN * FREQUENCY / case.frequency)
    assert len(run.times) == len(run.rows) == steps + 1
    assert np.array_equal(run.rows[:, run.channels.TIME], run.times)
    assert run.field_times[:-1] == pytest.approx(
        np.arange(len(run.field_times) - 1) * between * run.step_time)
    assert run.field_times[-1] == run.times[-1]


def test_rows_are_those_of_an_ordinary_simulation(case):
    run = case.run()
    parameters = paper_parameters().replace({'solver.cells': case.cells})
    rows = simulate(parameters, Sine(case.frequency, case.amplitude), 0.003).rows
    same = np.searchsorted(run.times, rows[:, 0] - 1e-9)
    assert np.array_equal(rows, run.rows[same])


def test_field_and_stations_agree_at_the_faces_and_ends(case):
    run = case.run()
    frames = np.searchsorted(run.times, run.field_times)
    nodes = {'O': 0, 'E': run.field.faces[0], 'F': run.field.faces[1], 'K': -1}
    for letter, node in nodes.items():
        pressure = run.to_units_of_pressure(run.pressure[:, node])
        # The field is kept in 32 bits.
        assert pressure == pytest.approx(
            run.station_pressure[frames, STATIONS.index(letter)], abs=1e-6)
    assert run.positions[:, nodes['E']] == pytest.approx(1.0 + run.position[frames])
    assert np.all(np.diff(run.positions, axis=1) >= -1e-12)


def test_the_end_and_a_quarter_of_a_period_before_are_kept(case):
    run = case.run()
    quarter = 0.25 / case.frequency
    assert run.moments.time[[-2, -1]] == pytest.approx(
        [run.times[-1] - quarter, run.times[-1]], abs=run.step_time)


def test_cavitation_keeps_pressures_above_vacuum(gassy_case):
    run = gassy_case.run()
    assert run.parameters['fluid.cavitation'] is True
    assert run.rows[:, run.channels.pressure].min() > 0.0


def test_a_run_that_breaks_is_a_failure_in_one_line():
    slow = paper_parameters().replace({'solver.cells': 60, 'solver.max_mach': 1e-3})
    with pytest.raises(Failure, match=r'solver\.max_mach'):
        make_run(slow, Sine(100.0), 0.005)


def test_ctrl_c_ends_a_run(monkeypatch):
    def interrupt(share):
        raise KeyboardInterrupt
    with pytest.raises(KeyboardInterrupt):
        reference(frequency=123.0, cells=60, progress=interrupt)
    assert all(key[2] != 123.0 for key in runs._RUNS)
