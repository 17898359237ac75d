# SPDX-License-Identifier: Apache-2.0
"""Short runs on few cells: a period and a half of a fast sine, with and without cavitation."""

import dataclasses

from hydra_actuator.paper.case import Case
import pytest

FREQUENCY, PERIODS, CELLS = 100.0, 1.5, 60


def small_case(cavitation: bool = False) -> Case:
    """Return a case whose runs take a moment."""
    name = 'cavitation' if cavitation else 'plain'
    return Case(name, f'small, {name}', cavitation, FREQUENCY, 0.5, PERIODS / FREQUENCY, CELLS)


@pytest.fixture(scope='session')
def case() -> Case:
    """Return the small case of the plain model."""
    return small_case()


@pytest.fixture(scope='session')
def gassy_case() -> Case:
    """Return the small case with cavitation."""
    return small_case(cavitation=True)


@pytest.fixture
def small_cases(monkeypatch, case, gassy_case):
    """Put the small cases in the place of the real ones."""
    fast = dataclasses.replace(case, name='200hz', title='small, fast', fast=True)
    cases = {one.name: one for one in (case, gassy_case, fast)}
    monkeypatch.setattr('hydra_actuator.paper.choice.CASES', cases)
    return cases
