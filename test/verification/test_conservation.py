# SPDX-License-Identifier: Apache-2.0
"""Mass and energy in lone lines and through an orifice."""

from hydra_actuator.verification import budget, conservation
from hydra_actuator.verification.case import failures
import numpy as np
import pytest


def test_integral_of_a_smooth_curve_is_of_sixth_order():
    def error(cells):
        x = np.linspace(0.0, 1.0, cells + 1)
        return abs(conservation.integral(np.exp(x), 1.0 / cells) - np.expm1(1.0))

    assert error(20) < 1e-9
    assert error(40) < error(20) / 40.0


def test_closed_line_keeps_its_mass_but_for_what_fronts_add():
    assert not failures(conservation.closed_line(2.0))


@pytest.mark.soak
def test_closed_line_keeps_its_mass_for_ten_seconds():
    assert not failures(conservation.closed_line())


def test_what_comes_in_goes_out_or_stays():
    assert not failures(budget.mass_balance())


def test_orifice_keeps_mass_and_law_at_every_step():
    assert not failures(budget.orifice_law())


def test_missing_energy_is_that_of_the_named_losses():
    assert not failures(budget.energy_budget())
