# SPDX-License-Identifier: Apache-2.0
"""A piston on columns of oil rings at the frequency of the distributed model."""

from hydra_actuator.verification import oil_column
from hydra_actuator.verification.case import failures
import pytest


def test_piston_on_equal_columns_rings_at_the_exact_frequency():
    assert not failures(oil_column.oil_column())


def test_piston_on_unequal_columns_rings_at_the_exact_frequency():
    assert not failures(oil_column.oil_column_unequal())


def test_light_piston_is_a_quarter_away_from_the_lumped_frequency():
    area, length, mass, exact = oil_column.SYMMETRIC[2]
    column = oil_column.Column((area, area), (length, length), mass)
    assert column.lumped_frequency() == pytest.approx(1732.0508, rel=1e-7)
    assert column.lumped_frequency() / exact > 1.25


def test_frequency_converges_with_the_square_of_the_step():
    area, length, mass, exact = oil_column.SYMMETRIC[2]
    column = oil_column.Column((area, area), (length, length), mass)
    errors = [abs(column.measured_frequency(cells) / column.exact_frequency() - 1.0)
              for cells in (50, 100)]
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.2)
