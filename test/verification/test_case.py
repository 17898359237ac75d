# SPDX-License-Identifier: Apache-2.0
"""A row passes within its tolerance, and only then."""

from dataclasses import replace
import math

from hydra_actuator.verification.case import failures, Row, worst
import pytest

ROW = Row('case', 'rise', 'Pa', 200.0, 201.0, 0.01, True, 'made up')


def test_relative_tolerance_is_a_part_of_what_is_expected():
    assert ROW.error == pytest.approx(0.005)
    assert ROW.passed
    assert not replace(ROW, got=202.1).passed


def test_absolute_tolerance_has_the_unit_of_the_quantity():
    assert not replace(ROW, relative=False).passed
    assert replace(ROW, relative=False, tolerance=1.0).passed


def test_a_nan_does_not_pass():
    assert not replace(ROW, got=math.nan).passed


def test_failures_show_the_row_with_its_figures():
    (line,) = failures([ROW, replace(ROW, got=300.0)])
    assert 'rise' in line and '300' in line and 'made up' in line


def test_nothing_verified_is_an_error():
    with pytest.raises(ValueError, match='no rows'):
        failures([])


def test_the_worst_row_is_nearest_to_its_own_tolerance():
    wide = replace(ROW, got=210.0, tolerance=0.5)
    assert worst([wide, ROW]) is ROW
    assert worst([ROW, replace(ROW, got=300.0, tolerance=10.0)]) is ROW


@pytest.mark.parametrize('got', [math.nan, 2.0])
def test_nan_and_a_count_that_is_off_are_worse_than_all(got):
    off = replace(ROW, expected=1.0, got=got, relative=False, tolerance=0.0)
    assert worst([replace(ROW, got=300.0), off, ROW]) is off


def test_a_count_that_is_right_uses_nothing_of_its_tolerance():
    assert replace(ROW, got=200.0, relative=False, tolerance=0.0).used == 0.0
