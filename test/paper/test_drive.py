# SPDX-License-Identifier: Apache-2.0
"""A trace holds what the actuator showed, whatever the intervals at which it was looked at."""

import math

from hydra_actuator.actuator import SolverError
from hydra_actuator.channels import STATIONS
from hydra_actuator.paper.drive import drive, field_at, opening, sine, unit_time
from hydra_actuator.verification.spool_response import paper_parameters
import numpy as np
import pytest

P = paper_parameters()


def test_the_unit_of_time_is_the_papers():
    assert unit_time(P) == pytest.approx(1.0 / 650.0, rel=1e-12)


def test_looking_more_often_changes_no_bit():
    often, rarely = (drive(P, sine(50.0), 3e-3, every) for every in (1, 6))
    assert np.array_equal(often.rows[::6], rarely.rows)


def test_a_trace_starts_at_rest_with_gauge_pressures():
    trace = drive(P, sine(50.0), 1e-4)
    assert trace.time[0] == trace.position[0] == 0.0
    assert [round(trace.pressure(station)[0]) for station in STATIONS] == (
        [21_000_000] * 2 + [10_500_000] * 8 + [0] * 2)


def test_the_command_is_evaluated_at_the_instant_of_each_step():
    trace = drive(P, sine(50.0), 2e-3)
    assert trace.opening == pytest.approx(np.sin(2.0 * math.pi * 50.0 * trace.time), abs=1e-12)


def test_an_opening_rises_evenly_and_holds():
    assert opening(0.3, 1e-3)(np.array([0.0, 0.5e-3, 1e-3, 2e-3])) == pytest.approx(
        [0.0, 0.15, 0.3, 0.3])


def test_the_field_holds_what_the_stations_show():
    x, pressure, velocity = field_at(sine(50.0), 2.0)
    trace = drive(P, sine(50.0), 2.0 * unit_time(P))
    k = round(2.0 * unit_time(P) / trace.time[1])
    assert np.all(np.diff(x) >= -1e-9) and x[-1] == pytest.approx(2.0)
    # single precision
    assert pressure[0] == pytest.approx(trace.pressure('O')[k], abs=4.0)
    assert velocity[-1] == pytest.approx(trace.velocity('K')[k], rel=1e-6)


def test_a_run_that_breaks_says_where():
    with pytest.raises(SolverError, match='max_mach'):
        drive(P.replace({'solver.max_mach': 1e-3}), sine(16.25), 0.02, 10)
