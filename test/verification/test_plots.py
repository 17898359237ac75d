# SPDX-License-Identifier: Apache-2.0
"""Each case can be drawn; a figure shows what its rows say."""

from dataclasses import replace
import math

from hydra_actuator.verification.case import Case, illustrated, Row
from hydra_actuator.verification.drawing import band, tolerance_used
from hydra_actuator.verification.plots import draw_case, MOST_ROWS, verdict
from hydra_actuator.verification.registry import CASES
from matplotlib.figure import Figure
import pytest

ROW = Row('made_up', 'rise', 'Pa', 200.0, 201.0, 0.01, True, 'made up')


@pytest.mark.parametrize('name', [
    pytest.param(name, marks=[pytest.mark.soak] if case.speed == 'slow' else [])
    for name, case in CASES.items()])
def test_case_draws_labelled_axes_with_curves_into_its_figure(name):
    case = CASES[name]
    figure = draw_case(name, case, case.rows())
    assert figure.axes
    figure.draw_without_rendering()
    for axes in figure.axes:
        assert axes.get_lines() or axes.patches or axes.collections
        assert axes.get_xlabel() or axes.get_ylabel() or axes.get_title(loc='left')
    assert any(text.get_text().startswith(f'{name}: ') for text in figure.texts)


def test_figure_without_one_of_its_own_shows_each_row_against_the_bar_at_one():
    rows = [ROW, replace(ROW, got=300.0), replace(ROW, got=math.nan), replace(ROW, got=200.0)]
    figure = draw_case('made_up', Case(lambda: rows, 'a case'), rows)
    (axes,) = figure.axes
    assert axes.get_xscale() == 'log'
    shown = {line.get_label(): list(line.get_xdata()) for line in axes.get_lines()}
    assert shown['within'] == pytest.approx([0.5, 1e-6])
    assert shown['missed'] == pytest.approx([50.0, 1e6])
    assert shown['tolerance'][0] == 1.0


def test_of_very_many_rows_those_nearest_to_their_tolerance_are_drawn():
    rows = [replace(ROW, quantity=str(k), got=200.0 + 1e-4 * k) for k in range(MOST_ROWS + 9)]
    (axes,) = draw_case('made_up', Case(lambda: rows, 'a case'), rows).axes
    shown = [text.get_text().partition(':')[0] for text in axes.get_yticklabels()]
    assert shown == [str(k) for k in range(9, MOST_ROWS + 9)]


def test_a_count_that_is_off_is_drawn_as_missed():
    axes = Figure().subplots()
    tolerance_used(axes, [replace(ROW, relative=False, tolerance=0.0)])
    assert 'missed' in [line.get_label() for line in axes.get_lines()]


def test_band_leaves_room_for_lines_and_tolerance():
    axes = Figure().subplots()
    axes.plot([0.0, 1.0], [0.0, -3.0])
    band(axes, 1.0)
    low, high = axes.get_ylim()
    assert low < -3.0
    assert high > 1.0


def test_verdict_names_the_quantity_nearest_to_its_tolerance():
    text = verdict([ROW, replace(ROW, quantity='fall', got=203.0)])
    assert text.startswith('1 of 2 quantities within tolerance')
    assert 'FAILED, worst: fall, at 1.5 of its tolerance' in text
    assert 'nearest to it: rise, at 0.5 of its tolerance' in verdict([ROW])


def test_figures_of_another_module_are_given_to_cases_by_name():
    cases = {'one': Case(list, 'one'), 'two': Case(list, 'two')}
    found = illustrated(cases, two=print)
    assert found['one'].figure is None
    assert found['two'].figure is print
    with pytest.raises(KeyError):
        illustrated(cases, three=print)
