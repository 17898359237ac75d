# SPDX-License-Identifier: Apache-2.0
"""Two runs compared: the difference is the first less the second, at the instants of the first."""

from dataclasses import replace

from hydra_actuator.analysis import report
from hydra_actuator.analysis.figure_comparison import beside, comparison, difference_map
from hydra_actuator.analysis.units import nondimensional, units_named
from hydra_actuator.analysis.window import common_window, window_of
import numpy as np
import plotly.graph_objects as go
import pytest


def test_the_difference_is_the_first_less_the_second(run):
    other = replace(run, position=run.position - 1e-3, pressure=run.pressure + 2e5)
    traces = [t for t in beside(run, other, window_of(run)).traces if t['name'] == 'difference']
    assert [float(np.mean(t['y'])) for t in traces] == pytest.approx([1.0, -0.2, -0.2], rel=1e-4)


def test_a_run_does_not_differ_from_itself(run):
    for quantity in ('pressure', 'velocity'):
        (trace,) = difference_map(run, run, window_of(run), quantity).traces
        assert not trace['z'].any()


def test_other_instants_are_met_by_interpolation(run, make_run):
    coarse = make_run(field_rate=500.0)
    (trace,) = difference_map(run, coarse, window_of(run), 'pressure').traces
    # A 50 Hz swing of 5 MPa is within A (omega dt)^2 / 8 of straight lines of 2 ms, but where
    # the piston, and with it the jump, passes between two frames.
    still = np.abs(trace['x'] - 1.0) > 0.025
    assert 0 < np.abs(trace['z'][:, still]).max() < 5 * (2 * np.pi * 50 * 2e-3)**2 / 8 * 1.05


def test_differing_parameters_are_listed(run):
    other = replace(run, name='other', parameters={**run.parameters, 'valve.stroke': 1e-3})
    text = report.report_page(run, other=other)
    assert '0.0005 / 0.001' in text
    assert 'id="difference_pressure"' in text


def test_where_the_other_run_has_ended_there_is_no_difference(run, make_run):
    short = make_run(0.5)
    figures = comparison(run, short, window_of(run))
    apart = [t for t in figures[0].traces if t['name'] == 'difference']
    assert apart[0]['x'].max() == pytest.approx(0.5)
    assert figures[1].missing


def test_what_is_shown_first_lies_within_both_runs(run, make_run):
    for other in (make_run(0.5), run):
        shown = common_window(run, other)
        assert shown.end == other.time[-1]
        assert shown.end - shown.start == pytest.approx(3 / 50, rel=1e-2)
        lines, *maps = comparison(run, other, shown)
        assert not any(one.missing for one in maps)
        for trace in lines.traces:
            within = (trace['x'] >= shown.start) & (trace['x'] <= shown.end)
            assert np.isfinite(trace['y'][within]).sum() > 50


@pytest.mark.parametrize('units', [units_named('bar'), 'nondimensional'])
def test_the_report_is_drawn_in_other_units(run, units):
    units = nondimensional(run) if units == 'nondimensional' else units
    for figure in report.figures(run, units):
        go.Figure(data=figure.traces, layout=figure.layout)
        if figure.key == 'sections':
            assert figure.layout['yaxis']['title']['text'] == units.pressure.label('pressure')
