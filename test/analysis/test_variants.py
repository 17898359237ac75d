# SPDX-License-Identifier: Apache-2.0
"""Figures in several units as one: each array travels once, whatever else differs is a choice."""

from hydra_actuator.analysis import report
from hydra_actuator.analysis.figure import Figure
from hydra_actuator.analysis.units import choices
from hydra_actuator.analysis.variants import Choice, merged, Rescaled, scale_between
import numpy as np
import pytest


def figure(values, title):
    return Figure('one', 'One', '', [{'y': values, 'name': 'same'}], {'title': title})


def test_what_is_scaled_travels_once_and_words_are_a_choice():
    values = np.array([1.0, np.nan, 3.0], np.float32)
    one, = merged([[figure(values, 'MPa')], [figure(10 * values, 'bar')]])
    assert isinstance(one.traces[0]['y'], Rescaled)
    assert one.traces[0]['y'].array is values
    assert one.traces[0]['y'].scales == ((1.0, 0.0), (pytest.approx(10.0), pytest.approx(0.0)))
    assert one.traces[0]['name'] == 'same'
    assert one.layout['title'] == Choice(('MPa', 'bar'))


def test_what_is_no_scale_of_the_first_travels_too():
    values = np.array([1.0, 2.0, 3.0])
    one, = merged([[figure(values, '')], [figure(values**2, '')]])
    assert isinstance(one.traces[0]['y'], Choice)


@pytest.mark.parametrize('array, other, scale', [
    ([1, 2, 3], [1, 2, 3], (1.0, 0.0)), ([1, 2, 3], [5, 7, 9], (2.0, 3.0)),
    ([2, 2], [7, 7], (1.0, 5.0)), ([1, 2], [1, 2, 3], None), ([1, np.nan], [1, 2], None),
    ([0, 1, 2], [0, 1.1, 2], None), ([np.nan], [np.nan], (1.0, 0.0))])
def test_the_scale_between_two_arrays(array, other, scale):
    found = scale_between(np.array(array, float), np.array(other, float))
    assert found == (None if scale is None else pytest.approx(scale))


def test_no_array_of_the_report_travels_twice_for_its_units(run):
    ways = choices(run)
    assert tuple(ways) == ('MPa', 'bar', 'Pa', 'non-dimensional')

    def leaves(value):
        if isinstance(value, dict):
            value = list(value.values())
        if isinstance(value, list):
            for part in value:
                yield from leaves(part)
        else:
            yield value
    found = [leaf for one in merged([report.figures(run, units) for units in ways.values()])
             for leaf in leaves([one.traces, one.layout, one.frames])]
    assert sum(isinstance(leaf, Rescaled) for leaf in found) > 20
    several = [leaf for leaf in found if isinstance(leaf, Choice)]
    assert several
    assert not any(isinstance(value, np.ndarray) for leaf in several for value in leaf.values)
