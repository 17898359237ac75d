# SPDX-License-Identifier: Apache-2.0
"""Every figure is valid for plotly and holds the numbers of the run, in the units it names."""

from dataclasses import replace

from hydra_actuator.analysis import (
    facts,
    figure_fields,
    figure_lines,
    figure_spectrum,
    figure_timing,
    report,
)
from hydra_actuator.analysis.window import window_of
import numpy as np
import plotly.graph_objects as go
import pytest

KEYS = [
    'surface_pressure', 'surface_velocity', 'map_pressure', 'map_velocity', 'streamline',
    'net', 'whole_pressure', 'whole_velocity', 'ranges', 'sections', 'piston', 'command',
    'spectrum', 'faults', 'real_time', 'sending', 'stamps',
]


def test_all_figures_are_there_in_order_and_plotly_takes_them(run):
    figures = report.figures(run)
    assert [figure.key for figure in figures] == KEYS
    for figure in figures:
        assert not figure.missing
        # plotly's own check of every property's name and value.
        go.Figure(data=figure.traces, layout=figure.layout)


def test_the_map_of_the_whole_run_keeps_its_peak_in_megapascals(run):
    pressure = run.field.pressure.copy()
    pressure[345, 10] = 33e6
    spiked = replace(run.field, pressure=pressure)
    highest = figure_fields.whole_run_map(spiked, 'pressure').traces[0]
    # The peak of one node is linear to its neighbours on the even grid.
    assert 0.9 * 33 < np.nanmax(highest['z']) <= 33


def test_station_lines_hold_the_pressures_in_megapascals(run):
    figure = figure_lines.sections(run, window_of(run))
    line = next(t for t in figure.traces if t['name'] == 'C' and t['yaxis'] == 'y')
    np.testing.assert_allclose(line['y'], run.pressure[:, 3] * 1e-6, rtol=1e-6)
    np.testing.assert_array_equal(line['x'], run.time)


def test_a_panel_whose_part_shown_is_quiet_has_the_range_of_that_part(run):
    moved = np.where(run.time < 0.2, run.position + 1.0, run.position)
    layout = figure_lines.piston(replace(run, position=moved), window_of(run)).layout
    assert layout['yaxis']['range'] == pytest.approx([-12 * 1.12, 12 * 1.12], rel=1e-2)
    assert 'range' not in layout['yaxis2']
    assert 'range' not in figure_lines.piston(run, window_of(run)).layout['yaxis']


def test_a_long_run_is_decimated_and_keeps_its_extremes(make_run):
    run = make_run(40.0, 200)
    pressure = run.pressure.copy()
    pressure[12_345, 3] = 40e6
    figure = figure_lines.sections(replace(run, pressure=pressure), window_of(run))
    line = next(t for t in figure.traces if t['name'] == 'C' and t['yaxis'] == 'y')
    assert len(line['x']) < 13_000
    assert line['x'][line['y'].argmax()] == run.time[12_345]
    assert line['y'].max() == pytest.approx(40)


def test_the_piston_figure_shows_millimetres_and_the_pressures_on_its_faces(run):
    lines = {t['name']: t for t in figure_lines.piston(run, window_of(run)).traces}
    assert lines['position']['y'].max() == pytest.approx(12, rel=1e-4)
    assert lines['face E']['y'].max() == pytest.approx(16, rel=1e-4)
    assert lines['face F']['yaxis'] == lines['face E']['yaxis'] != lines['position']['yaxis']


def test_the_spool_stands_beside_the_command(run):
    lines = {t['name']: t for t in figure_lines.command(run, window_of(run)).traces}
    assert lines['spool']['y'].max() == pytest.approx(1, rel=1e-4)
    assert lines['command']['yaxis'] == lines['spool']['yaxis']
    assert 'load' not in lines


def test_a_load_has_its_own_panel(run):
    loaded = replace(run, load_force=np.full(len(run.time), 1500.0))
    lines = {t['name']: t for t in figure_lines.command(loaded, window_of(run)).traces}
    assert lines['load']['y'][0] == pytest.approx(1.5)


def test_real_time_statistics_are_those_of_the_diagnostics(run):
    traces = figure_timing.real_time(run).traces
    overruns = next(t for t in traces if t['name'] == 'overruns')
    np.testing.assert_array_equal(overruns['y'], [1, 2, 3])
    np.testing.assert_array_equal(overruns['x'], [1, 2, 3])


def test_an_event_of_the_same_name_is_no_report(run):
    event = replace(run.diagnostics[0], values={'late': '5'}, time=2.5)
    figure = figure_timing.real_time(replace(run, diagnostics=(*run.diagnostics, event)))
    assert all(np.isfinite(trace['y']).all() for trace in figure.traces)


def test_a_run_in_simulated_time_has_no_real_time_statistics(run):
    said = replace(run.diagnostics[0], values={'mode': 'lockstep', 'ticks': '5', 'waiting': '0.1'})
    stepped = replace(run, diagnostics=(said,), send_delay=np.full(len(run.time), 1.7e9))
    missing = [figure.key for figure in report.figures(stepped) if figure.missing]
    assert {'real_time', 'sending'} <= set(missing)
    told = dict(facts.real_time_facts(stepped))
    assert told['ticks'] == '5'
    assert not any(name.startswith('sending') for name in told)


def test_real_time_facts_carry_their_units(run):
    assert dict(facts.real_time_facts(run))['lateness p99'] == '140 us'


def test_a_missing_tick_is_seen_in_the_stamps(run):
    kept = np.arange(len(run.time)) != 500
    gap = replace(run, **{
        name: getattr(run, name)[kept]
        for name in ('time', 'stamps', 'position', 'velocity', 'pressure', 'send_delay')
    })
    assert 'slipped by: 1.' in figure_timing.stamps(gap).caption
    assert 'No tick is missing' in figure_timing.stamps(run).caption
    line = figure_timing.stamps(gap).traces[0]
    assert line['y'].max() == pytest.approx(1000)
    assert dict(facts.real_time_facts(gap))['missing ticks between stamps'] == '1'


@pytest.mark.parametrize('slipped, said', [(0, False), (1, False), (2, True)])
def test_spectra_of_a_run_that_slipped_say_so(run, slipped, said):
    slip = 1_000_000 * (np.arange(len(run.time)) >= 500)
    figure = figure_spectrum.spectrum(replace(run, stamps=run.stamps + slipped * slip),
                                      window_of(run))
    assert ('not to be trusted' in figure.caption) == said


def test_what_was_not_recorded_is_said(run):
    poor = replace(run, field=None, diagnostics=(), send_delay=np.empty(0),
                   section_positions=np.empty(0))
    missing = [figure.key for figure in report.figures(poor) if figure.missing]
    assert missing == ['field', 'faults', 'real_time', 'sending']


def test_without_the_field_the_stations_give_the_surface(run):
    poor = replace(run, field=None)
    figures = {figure.key: figure for figure in report.figures(poor)}
    assert '12 stations' in figures['surface_pressure'].caption
    assert figures['whole'].missing


def test_the_facts_name_the_extremes_and_where_they_were(run):
    rows = dict(facts.run_facts(run))
    assert rows['highest pressure'].startswith('21.0000 MPa abs at O')
    assert rows['dominant frequency'] == '50 Hz'
    assert rows['piston travel'] == '24 mm, from -12 to +12 mm'


def test_only_changed_parameters_are_listed_with_unit_and_default(run):
    ((name, text),) = facts.changed_parameters(run)
    assert name == 'tank.pressure'
    assert text == '2400000.0 Pa (default 2500000.0)'


def test_the_difference_from_the_mean_has_no_mean(run):
    figure = figure_fields.wave_map(run, run.field, window_of(run), 'pressure', waves=True)
    itself, difference = figure.traces[:2]
    assert (itself['visible'], difference['visible']) == (False, True)
    np.testing.assert_allclose(difference['z'].mean(axis=0), 0, atol=1e-12)
    np.testing.assert_allclose(np.ptp(difference['z'], axis=0), np.ptp(itself['z'], axis=0))


def test_a_row_of_the_whole_run_holds_whole_periods(run):
    figures = {figure.key: figure for figure in report.figures(run)}
    # One period of 20 ms each: every row of a steady motion looks the same.
    assert len(figures['whole_pressure'].traces[0]['y']) == 50


def test_an_offline_run_has_one_sentence_about_real_time(run):
    figures = report.timing_figures(replace(run, source='simulate'))
    assert [figure.missing for figure in figures] == ['an offline run keeps no real time']


def test_velocities_recorded_less_often_than_pressures_leave_no_holes(run):
    velocity = run.flow_velocity.copy()
    velocity[np.arange(len(velocity)) % 10 > 0] = np.nan
    drawn = {one.key: one for one in
             report.figures(replace(run, flow_velocity=velocity, field=None))}
    for key in ('surface_velocity', 'map_velocity', 'surface_pressure', 'map_pressure'):
        assert np.isfinite(drawn[key].traces[0]['z']).all()
    assert '100 Hz' in drawn['map_velocity'].caption
    assert '1000 Hz' in drawn['map_pressure'].caption
    never = replace(run, flow_velocity=np.full_like(velocity, np.nan), field=None)
    drawn = {one.key: one for one in report.figures(never)}
    assert 'fewer than two instants' in drawn['surface_velocity'].missing
    assert 'fewer than two instants' in drawn['net'].missing
    assert not drawn['map_pressure'].missing


def test_the_rate_of_frames_is_the_mean_one_gaps_left_out(run):
    steps = np.tile([96e-6, 104e-6], 500)
    steps[300] = 1.0
    field = replace(run.field, time=np.concatenate(([0.0], np.cumsum(steps))))
    assert figure_fields.origin(field) == 'the field at 10000 Hz'
