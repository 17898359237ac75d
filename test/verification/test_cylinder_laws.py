# SPDX-License-Identifier: Apache-2.0
"""The cylinder by formula: compression, forces, speeds of unequal areas, leakage."""

from hydra_actuator.verification import cylinder_laws
from hydra_actuator.verification.case import failures
import pytest


@pytest.mark.parametrize('name', cylinder_laws.CASES)
def test_the_cylinder_obeys(name):
    assert not failures(cylinder_laws.CASES[name].rows())


def test_speed_of_hardly_compressible_oil_is_the_closed_form():
    parameters = cylinder_laws.Parameters().replace({
        'fluid.bulk_modulus': 1e11, 'cylinder.area_2': 6e-4, 'tank.pressure': 0.0,
        'cylinder.viscous_friction': 0.0})
    gain = 0.62 * 0.03 * 1e-4 * (2.0 / 860.0) ** 0.5
    closed = gain * (21e6 / (1e-6 + 0.6 ** 3 * 1e-6)) ** 0.5
    assert cylinder_laws.exact_speed(parameters, 0.2) == pytest.approx(closed, rel=1e-3)
