# SPDX-License-Identifier: Apache-2.0
"""Mass and energy of a whole actuator with every option on."""

from hydra_actuator.actuator import Actuator
from hydra_actuator.parameters import Parameters
from hydra_actuator.parameters.options import EVERYTHING
from hydra_actuator.verification import whole_budget
from hydra_actuator.verification.case import failures
from hydra_actuator.verification.weighing import Weigher
import pytest


def test_nothing_is_missing_with_every_option_on():
    assert not failures(whole_budget.whole_budget())


def test_oil_at_rest_weighs_what_its_pressure_says():
    parameters = Parameters().replace({**EVERYTHING, 'solver.cells': 60})
    weigher = Weigher(Actuator(parameters))
    mass, energy = weigher.stored()
    model, state = weigher.model, weigher.state
    pressure = state.end_star[::2] - model.floor
    volume = model.area * state.length
    full = 860.0 * volume * (1.0 + pressure / model.bulk_modulus)
    gas = full * parameters['fluid.air_fraction'] * model.floor / (pressure + model.floor)
    assert mass == pytest.approx(float((full - gas).sum()), rel=1e-7)
    elastic = 0.5 * volume * pressure ** 2 / model.bulk_modulus
    assert energy == pytest.approx(float(elastic.sum()), rel=0.03)


def test_a_leak_nobody_named_is_missed():
    ledger = whole_budget.keep_ledger('smooth', 100)
    flow = ledger.mass_flow[:, whole_budget.TANK_END]
    flow *= 1.0 + 1e-5
    try:
        assert abs(ledger.mass_missing()) > whole_budget.DRIVES['smooth'].mass_bar
    finally:
        flow /= 1.0 + 1e-5
