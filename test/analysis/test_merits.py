# SPDX-License-Identifier: Apache-2.0
"""Two runs in numbers."""

from dataclasses import replace

from hydra_actuator.analysis import report
from hydra_actuator.analysis.merits import merits, step_of
import numpy as np
import pytest


def stepped(run, constant):
    """Return the run with a position of a first-order step of 10 mm."""
    return replace(run, position=0.01 * (1.0 - np.exp(-run.time / constant)))


def test_a_step_has_its_rise_and_settling_beside_each_other(run):
    rows = dict(merits(stepped(run, 0.05), stepped(run, 0.1)))
    rise = [float(part) for part in
            rows['rise time of the position, 10 to 90 %'].removesuffix(' ms').split(' / ')]
    assert rise == pytest.approx([50.0 * np.log(9.0), 100.0 * np.log(9.0)], rel=1e-3)
    settled = [float(part) for part in
               rows['settling time, to 2 %'].removesuffix(' ms').split(' / ')]
    assert settled == pytest.approx([50.0 * np.log(50.0), 100.0 * np.log(50.0)], rel=5e-3)
    # The position it ends at is the mean of the last tenth, hardly below the last value.
    assert all(float(part) < 0.01 for part in rows['overshoot'].removesuffix(' %').split(' / '))


def test_differences_are_root_mean_square_and_greatest(run):
    other = replace(run, position=run.position - 1e-3, pressure=run.pressure + 2e5)
    rows = dict(merits(run, other))
    assert rows['difference of the position'] == 'RMS 1 mm, at most 1 mm'
    assert rows['difference of the pressure E'] == 'RMS 0.2 MPa, at most 0.2 MPa'
    assert rows['highest pressure'] == '21 / 21.2 MPa'
    assert 'overshoot' not in rows


def test_a_motion_that_does_not_end_at_rest_is_no_step(run):
    assert step_of(run) is None
    assert step_of(replace(run, position=np.zeros_like(run.position))) is None
    assert step_of(stepped(run, 1.0)) is None


def test_runs_without_common_time_have_no_difference(run):
    late = replace(run, time=run.time + 10.0)
    assert dict(merits(run, late))['difference of the position'] == 'none: no time in common'


def test_the_page_of_two_runs_holds_the_numbers(run):
    text = report.report_page(run, other=replace(run, name='other'))
    assert 'made_run / other in numbers' in text
    assert 'RMS 0 mm, at most 0 mm' in text
