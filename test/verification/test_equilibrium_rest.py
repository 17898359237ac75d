# SPDX-License-Identifier: Apache-2.0
"""A start in equilibrium stays there, and one beside it does not."""

from hydra_actuator.verification import equilibrium_rest
from hydra_actuator.verification.case import failures


def test_starts_in_equilibrium_stay_there():
    assert not failures(equilibrium_rest.equilibrium_rest())


def test_a_start_beside_equilibrium_is_seen():
    pressure, position = equilibrium_rest.unrest({
        'cylinder.area_2': 8e-4, 'initial.equilibrium': False})
    assert pressure > 1e5
    assert position > 1e-12
