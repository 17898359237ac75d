# SPDX-License-Identifier: Apache-2.0
"""Single figures: what the report shows, on paper, in chosen parts, instants and units."""

from dataclasses import replace
import math

from hydra_actuator.analysis import (
    figure_events,
    figure_lines,
    figure_net,
    figure_profiles,
    figure_spectrum,
    printing,
)
from hydra_actuator.analysis.plot import plot, PLOTS, view_of, write_plot
from hydra_actuator.analysis.series import Cavities, Report
from hydra_actuator.analysis.units import complete, nondimensional, units_named
from hydra_actuator.analysis.window import Window, window_of
from hydra_actuator.channels import DOMAINS
from hydra_actuator.errors import InputError
import numpy as np
import pytest


def full(run):
    """Return a run with cavities, a fault and all parameters at their defaults but a few."""
    count = len(run.time)
    cavities = Cavities(run.time, np.linspace(0, 1e-6, count), np.ones(count), np.ones(count),
                        np.zeros(count), DOMAINS, np.full((count, 6), 1e-7))
    faults = tuple(Report(t, '/actuator: Faults', level, text, {'fault.valve_stuck': value})
                   for t, level, text, value in (
                       (0.2, 1, 'fault.valve_stuck = 0.1', '0.1'),
                       (0.5, 0, 'fault.valve_stuck ended', '0')))
    return replace(run, cavities=cavities, diagnostics=run.diagnostics + faults,
                   parameters={**run.parameters, 'fluid.cavitation': True,
                               'fluid.air_fraction': 1e-3})


def data_axes(sheet):
    return [axes for axes in sheet.findobj(lambda one: hasattr(one, 'get_xlabel'))
            if axes.get_label() != '<colorbar>']


@pytest.mark.parametrize('name', PLOTS)
def test_every_figure_draws_its_data_on_axes_with_units(run, name):
    axes = data_axes(plot(name, view_of(full(run))))
    assert axes
    assert all(one.lines or one.collections for one in axes)
    labels = [label for one in axes for label in (one.get_xlabel(), one.get_ylabel()) if label]
    assert sum('[' in label for label in labels) >= 1


@pytest.mark.parametrize('name', ['surface-velocity', 'xt', 'net', 'streamline'])
def test_velocities_recorded_more_slowly_than_pressures_are_drawn(run, name):
    velocity = run.flow_velocity.copy()
    velocity[np.arange(len(velocity)) % 10 > 0] = np.nan
    for figure in PLOTS[name].build(view_of(replace(run, flow_velocity=velocity, field=None))):
        for trace in figure.traces:
            values = trace.get('z', trace['x' if name == 'net' else 'y'])
            # Lines of the net lie between gaps.
            assert np.isfinite(values).mean() > (0.2 if name == 'net' else 0.99)


@pytest.mark.parametrize('suffix, start', [
    ('png', b'\x89PNG'), ('svg', b'<?xml'), ('pdf', b'%PDF')])
def test_the_suffix_names_the_format(run, tmp_path, suffix, start):
    path = write_plot('piston', view_of(run), tmp_path / f'piston.{suffix}')
    assert path.read_bytes().startswith(start)
    assert [one.name for one in tmp_path.iterdir()] == [path.name]


def test_the_drawn_line_is_the_reports(run):
    shown = window_of(run)
    trace = figure_lines.piston(run, shown).traces[0]
    line = plot('piston', view_of(run)).axes[0].lines[0]
    assert np.array_equal(line.get_xdata(), trace['x'])
    assert np.array_equal(line.get_ydata(), trace['y'].astype(float))


@pytest.mark.parametrize('name, factor', [('Pa', 1.0), ('bar', 1e-5), ('MPa', 1e-6)])
def test_pressures_are_shown_in_the_unit_asked_for(run, name, factor):
    view = view_of(run, units=units_named(name))
    axes = plot('stations', view).axes[0]
    assert axes.get_ylabel() == f'pressure [{name} abs]'
    assert np.max(axes.lines[0].get_ydata()) == pytest.approx(21e6 * factor)


def test_the_papers_units_are_those_of_equation_17(run):
    units, values = nondimensional(run), complete(run)
    length = sum(values[f'{line}.length'] for line in
                 ('supply_line', 'line_1', 'line_2', 'return_line'))
    length += sum(values[f'cylinder.{part}'] for part in
                  ('dead_length_1', 'stroke', 'dead_length_2'))
    speed = math.sqrt(values['fluid.bulk_modulus'] / values['fluid.density'])
    area = math.pi / 4 * values['supply_line.diameter']**2
    assert float(units.place(length)) == pytest.approx(1.0)
    assert float(units.time(length / speed)) == pytest.approx(1.0)
    assert float(units.velocity(values['supply.max_flow'] / area)) == pytest.approx(1.0)
    gauge = values['supply.pressure'] + values['ambient_pressure']
    assert float(units.pressure(gauge)) == pytest.approx(1.0)
    assert float(units.pressure(values['ambient_pressure'])) == 0.0
    assert units.pressure.label('pressure') == 'pressure p/p_max [-]'


def test_the_papers_units_need_the_parameters(run):
    with pytest.raises(InputError, match='holds no parameters'):
        nondimensional(replace(run, parameters={}))
    with pytest.raises(InputError, match='max_flow'):
        nondimensional(replace(run, parameters={'supply.max_flow': 0.0}))


def test_the_distribution_is_that_of_the_frame_at_the_instant(run):
    figure = figure_profiles.at_instants(run, run.field, window_of(run), [0.305])
    pressure, velocity = figure.traces
    assert pressure['name'] == '305.00 ms'
    # The face E stands where the piston is: 12 mm at a quarter of a period.
    assert np.isclose(pressure['x'], 1.012, atol=1e-6).any()
    assert np.nanmin(pressure['y']) == pytest.approx(2.5)
    assert np.unique(velocity['y']) == pytest.approx(0.1)


def test_the_net_travels_at_the_speed_of_waves(run):
    window = Window(0.3, 0.301)
    figure = figure_net.net(run, run.field, window)
    values = complete(run)
    speed = math.sqrt(values['fluid.bulk_modulus'] / values['fluid.density'])
    forth = next(t for t in figure.traces if t['name'] == 'u + c')
    x, time = forth['x'][:20], forth['y'][:20] * 1e-3
    assert np.polyfit(time, x, 1)[0] == pytest.approx(speed + 0.1, rel=1e-3)


def test_a_lone_sine_has_its_amplitude_in_the_spectrum():
    time = np.arange(2000) / 1000
    frequency, height = figure_spectrum.amplitudes(time, 3.0 + 2.0 * np.sin(100 * np.pi * time))
    assert frequency[height.argmax()] == pytest.approx(50.0, abs=0.01)
    assert height.max() == pytest.approx(2.0, rel=1e-3)


def test_marks_of_the_spectrum_are_the_quarter_waves(run):
    figure = figure_spectrum.spectrum(replace(run, parameters={'supply_line.length': 2.0}),
                                      Window(0.0, 1.0))
    values = complete(run)
    speed = math.sqrt(values['fluid.bulk_modulus'] / values['fluid.density'])
    marked = np.concatenate([t['x'] for t in figure.traces if 'valve closed' in t['name']])
    assert np.isclose(marked, speed / 8, rtol=1e-9).any()
    assert np.isclose(marked, 3 * speed / 8, rtol=1e-9).any()
    assert max(marked) <= 500.0


def test_a_fault_is_shaded_from_its_beginning_to_its_end(run):
    spans = figure_events.fault_spans(full(run))
    assert spans == [('fault.valve_stuck', 0.2, 0.5)]
    assert figure_events.events(full(run), Window(0.0, 1.0)).layout['shapes'][0]['x1'] == 0.5


def test_the_same_status_again_is_no_news(run):
    assert [report.time for report in figure_events.news_of(run)] == [1.0]


def test_of_several_views_the_visible_one_is_printed(run):
    from hydra_actuator.analysis import figure_fields
    from matplotlib.figure import Figure
    sheet = Figure()
    figure = figure_fields.wave_map(run, run.field, window_of(run), 'pressure', waves=True)
    printing.draw(sheet, figure)
    (mesh,) = sheet.axes[0].collections
    assert np.allclose(mesh.get_array(), figure.traces[1]['z'])


@pytest.mark.parametrize('name, change, words', [
    ('timing', {'source': 'simulate'}, 'offline run'),
    ('cavities', {}, 'without fluid.cavitation'),
    ('net', {'parameters': {}}, 'no parameters'),
    ('xt', {'field': None, 'section_names': (), 'section_positions': np.empty(0),
            'pressure': np.empty((1001, 0))}, 'neither the field nor enough stations'),
])
def test_what_a_recording_cannot_give_is_said(run, name, change, words):
    with pytest.raises(InputError, match=words):
        plot(name, view_of(replace(run, **change)))


@pytest.mark.parametrize('choice, words', [
    ({'start': 0.5, 'end': 0.4}, 'no part of the run'), ({'end': 3.0}, '0 to 1 s'),
    ({'instants': (2.0,)}, 'not in the run')])
def test_a_part_that_is_not_in_the_run_is_refused(run, choice, words):
    with pytest.raises(InputError, match=words):
        view_of(run, **choice)


def test_a_long_record_is_cut_to_a_length_that_is_quickly_transformed():
    assert [figure_spectrum.fast_length(n) for n in (1, 1024, 1025, 600_001)] == [
        1, 1024, 1024, 600_000]
    assert figure_spectrum.fast_length(103) == 103


def test_the_spectrum_of_a_long_run_keeps_its_peaks(make_run):
    run = make_run(40.0, field_rate=1.0)
    kept = figure_spectrum.spectrum(run, Window(0.0, 40.0))
    frequency, height = figure_spectrum.amplitudes(run.time, run.velocity)
    line = next(t for t in kept.traces if t['name'] == 'piston velocity')
    assert len(frequency) > 2 * figure_spectrum.POINTS
    assert len(line['x']) <= figure_spectrum.POINTS + 2
    assert np.nanmax(line['y']) == np.float32(height[1:].max())
    assert line['x'][np.nanargmax(line['y'])] == frequency[1 + height[1:].argmax()]
