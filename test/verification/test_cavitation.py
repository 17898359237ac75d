# SPDX-License-Identifier: Apache-2.0
"""Free gas and vapour in a lone line, and column separation on the Adelaide rig."""

from hydra_actuator.verification import adelaide, cavitation
from hydra_actuator.verification.case import failures
import numpy as np
import pytest


def test_gas_lowers_the_wave_speed_as_the_mixture_formula_says():
    assert not failures(cavitation.gas_wave_speed())


def test_a_slammed_line_boils_and_goes_no_lower():
    assert not failures(cavitation.vapour_pressure())


def test_oil_displaced_by_cavities_is_neither_lost_nor_made():
    assert not failures(cavitation.cavity_mass())


def test_beside_a_cavity_odd_and_even_nodes_agree():
    assert not failures(cavitation.alternate_nodes())


def test_a_pattern_of_alternate_nodes_is_seen():
    pattern = 1.0 + 0.1 * (-1.0) ** np.arange(30)
    assert cavitation.alternation(pattern) == pytest.approx(0.1, rel=0.1)
    assert cavitation.alternation(np.linspace(1.0, 2.0, 30)) < 1e-12


def test_the_first_plateau_of_the_adelaide_rig_comes_out():
    assert not failures(adelaide.first_plateau())


def test_the_column_separates_and_rejoins_when_and_as_much_as_it_must_on_any_mesh():
    assert not failures(adelaide.column_separation())


def test_without_its_line_friction_the_rig_misses_the_cavity():
    frictionless = adelaide.Run(1.4, 0.0, 0.36, 0.062, 0.350, 35.1e-6)
    assert failures(adelaide.separation(frictionless, 200, 0.975))
