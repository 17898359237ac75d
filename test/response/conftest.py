# SPDX-License-Identifier: Apache-2.0
"""Operating points that several tests look at."""

from hydra_actuator.parameters import Parameters
from hydra_actuator.response.distributed import linear_plant
from hydra_actuator.response.operating_point import find_operating_point
import pytest

EDGES = ('pa', 'pb', 'at', 'bt')
LINES = ('supply_line', 'line_1', 'line_2', 'return_line')


@pytest.fixture(scope='session')
def plant_of():
    """Return a function that makes the linear plant of changed parameters at a point."""
    def make(changes: dict | None = None, **point):
        return linear_plant(find_operating_point(
            Parameters().replace({'tank.pressure': 0.0, **(changes or {})}), **point))
    return make


@pytest.fixture(scope='session')
def underlap():
    """Return the changes that make all edges underlapped."""
    return {f'valve.overlap_{edge}': -2e-5 for edge in EDGES}


@pytest.fixture(scope='session')
def frictionless():
    """Return the changes that take friction from all lines."""
    return {f'{line}.friction': 'none' for line in LINES}
