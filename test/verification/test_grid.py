# SPDX-License-Identifier: Apache-2.0
"""The full actuator converges to its own solution on finer grids."""

from hydra_actuator.verification import grid
from hydra_actuator.verification.case import failures


def test_without_valve_reversal_everything_is_second_order():
    assert not failures(grid.grid_without_reversal())


def test_with_valve_reversal_the_position_is_second_order():
    assert not failures(grid.grid_with_reversal())


def test_a_valve_that_closes_in_half_a_millisecond_is_resolved():
    assert not failures(grid.grid_closing_valve())
