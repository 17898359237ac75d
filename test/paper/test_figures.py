# SPDX-License-Identifier: Apache-2.0
"""Every figure of the paper is there, its axes have units, and it draws the run's numbers."""

import math
import re

from hydra_actuator.channels import STATIONS
from hydra_actuator.paper import figures_net, figures_surfaces
from hydra_actuator.paper.canvas import png, PRESSURE, VELOCITY
from hydra_actuator.paper.figures import FIGURES
from hydra_actuator.paper.runs import reference
import numpy as np
import pytest

PAPERS = [f'{number}{letter}' for number, letters in
          (('2', 'abcdef'), ('3', 'abcdef'), ('4', 'abcdef'), ('5', 'abcdef'))
          for letter in letters]


@pytest.fixture(scope='module')
def drawn(case):
    """Return a function that draws a figure of the small case once: (figure, caption)."""
    kept = {}
    return lambda name: kept.setdefault(name, FIGURES[name].drawn(case))


def data_axes(figure):
    """Return the axes that hold data, colour bars left out."""
    return [axes for axes in figure.axes if axes.get_label() != '<colorbar>']


def lines_of(axes):
    """Return the lines over the data, by label."""
    return {line.get_label(): line.get_xydata() for line in axes.lines}


def test_the_figures_are_those_of_the_paper():
    assert list(FIGURES) == PAPERS


# 3d shows the end of the paper's run, which the small one does not reach: below.
@pytest.mark.parametrize('name', [name for name in PAPERS if name != '3d'])
def test_figure_draws_data_on_axes_with_units(drawn, name):
    figure, caption = drawn(name)
    assert data_axes(figure)
    for axes in data_axes(figure):
        assert axes.lines or axes.collections
        for line in axes.lines:
            assert len(line.get_xdata())
    labels = [axes.get_xlabel() for axes in data_axes(figure)]
    labels += [axes.get_ylabel() for axes in figure.axes]
    assert all('[' in label or 'O is 0' in label for label in labels if label)
    assert any('c/L [-]' in label or 'x/L [-]' in label for label in labels)
    assert re.search(r'\d', caption)
    assert len(png(figure)) > 10_000


@pytest.mark.parametrize('name', ['2b', '2d', '3c', '3f', '4f', '5c'])
def test_figure_is_drawn_with_cavitation_too(gassy_case, name):
    figure, _ = FIGURES[name].drawn(gassy_case)
    assert all(axes.lines or axes.collections for axes in data_axes(figure))


@pytest.mark.parametrize('name, quantity', [('2c', VELOCITY), ('2d', PRESSURE)])
def test_each_station_has_a_panel_with_its_own_extremes(case, drawn, name, quantity):
    run, panels = case.run(), drawn(name)[0].axes
    values = quantity.stations(run)
    for k, letter in enumerate(STATIONS):
        assert panels[k].get_title(loc='left') == letter
        y = panels[k].lines[0].get_ydata()
        assert (y.min(), y.max()) == (values[:, k].min(), values[:, k].max())


@pytest.mark.parametrize('name, quantity', [('5b', VELOCITY), ('5c', PRESSURE)])
def test_all_stations_are_drawn_into_one_panel(case, drawn, name, quantity):
    run = case.run()
    lines = lines_of(drawn(name)[0].axes[0])
    for k, letter in enumerate(STATIONS):
        assert lines[letter][-1] == pytest.approx([run.tau[-1], quantity.stations(run)[-1, k]])


def test_second_axis_is_si(case, drawn):
    run, figure = case.run(), drawn('5c')[0]
    (axis,) = [child for child in figure.axes[0].child_axes if 'MPa' in child.get_ylabel()]
    figure.canvas.draw()
    low, high = figure.axes[0].get_ylim()
    assert axis.get_ylim() == pytest.approx((low * 21.0, high * 21.0))
    assert run.pressure_unit == 21e6


@pytest.mark.parametrize('name, quantity', [('2e', VELOCITY), ('2f', PRESSURE)])
def test_difference_at_the_stations_is_that_of_the_two_runs(case, drawn, name, quantity):
    one, two = case.run(passes=1), case.run(passes=2)
    change = np.abs(quantity.stations(two) - quantity.stations(one))
    largest = max(np.nanmax(line[:, 1]) for line in lines_of(drawn(name)[0].axes[0]).values())
    assert largest == pytest.approx(change.max(), rel=1e-9)
    assert 0.0 < largest < 1e-4


def test_difference_over_the_field_covers_that_at_the_stations(case):
    one, two = case.run(passes=1), case.run(passes=2)
    layer = figures_surfaces.difference_of(two, one, VELOCITY)
    frames = np.searchsorted(two.times, two.field_times)
    stations = (two.station_velocity - one.station_velocity)[frames]
    assert np.abs(layer.values).max() >= np.abs(stations).max() - 1e-7
    assert np.isfinite(layer.values).all()


@pytest.mark.parametrize('name', ['2a', '2b'])
def test_surface_has_no_gap_and_map_ends_with_the_run(case, drawn, name):
    run, figure = case.run(), drawn(name)[0]
    surface, heat_map = data_axes(figure)
    assert surface.name == '3d'
    assert heat_map.get_ylim() == pytest.approx((0.0, run.tau[-1]))
    image = heat_map.collections[0].get_array()
    assert np.isfinite(np.asarray(image)).all()


def test_faces_move_with_the_piston(case, drawn):
    run, lines = case.run(), lines_of(drawn('3c')[0].axes[0])
    for face in ('face E', 'face F'):
        assert lines[face][:, 1].max() == pytest.approx(0.5 + run.position.max() / 2.0)
    assert f'{run.position.max() * 1e3:+.2f} mm' in drawn('3c')[1]


def test_last_distribution_is_that_of_the_last_step(case, drawn):
    run, lines = case.run(), lines_of(drawn('3e')[0].axes[0])
    values = lines[f'{run.tau[-1]:.3g}'][:, 1]
    assert values[0] == pytest.approx(run.station_velocity[-1, 0], abs=1e-6)
    assert values[-1] == pytest.approx(run.station_velocity[-1, -1], abs=1e-6)


def test_before_it_arrives_a_wave_moves_nothing_beyond(case, drawn):
    lines = lines_of(drawn('4c')[0].axes[0])
    x, u = lines[min(lines, key=float)].T
    near, far = np.abs(x - 0.3) < 0.03, (x > 0.45) & (x < 0.55)
    assert u[near].max() > 1e-3
    assert np.abs(u[far]).max() < 1e-6


def test_command_is_the_sine_asked_for(case, drawn):
    time, spool = drawn('5a')[0].axes[0].lines[0].get_xydata().T
    exact = case.amplitude * np.sin(2.0 * math.pi * case.frequency * time * case.run().time_unit)
    assert spool == pytest.approx(exact, abs=1e-9)


def test_net_lines_travel_at_c_plus_or_minus_u(case):
    run = case.run()
    net = figures_net.net_of(run, 'supply_line', (0, 40))
    x, way = net.lines(0.1)
    straight = way[1:] == way[:-1]
    speed = np.abs(np.diff(x, axis=0) / np.diff(net.time)[:, None])[straight]
    assert speed == pytest.approx(1300.0, rel=0.01)
    assert x.min() >= 0.0
    assert x.max() <= 0.6
    assert not straight.all()


def test_the_papers_last_loop_holds_one_of_our_levels():
    long = reference(frequency=100.0, amplitude=0.1, duration=0.0785, cells=60)

    class Long:
        def run(self):
            return long
    figure, caption = FIGURES['3d'].drawn(Long())
    assert all(axes.lines for axes in figure.axes)
    assert re.search(r'and [012] lies in the window', caption)
