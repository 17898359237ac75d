# SPDX-License-Identifier: Apache-2.0
"""Pump, relief valve, accumulator and elastic wall, each beside its formula."""

from hydra_actuator.verification import supply_laws
from hydra_actuator.verification.case import failures
import pytest


@pytest.mark.parametrize('name', supply_laws.CASES)
def test_the_supply_obeys(name):
    assert not failures(supply_laws.CASES[name].rows())


def test_the_gas_law_is_met_the_closer_the_shorter_the_step(monkeypatch):
    errors = []
    for cells in (100, 200):
        monkeypatch.setattr(supply_laws, 'CELLS', cells)
        errors.append(supply_laws.gas_law()[0].error)
    assert errors[0] / errors[1] == pytest.approx(2.0, rel=0.1)
