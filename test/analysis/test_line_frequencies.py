# SPDX-License-Identifier: Apache-2.0
"""Natural frequencies: quarter waves, and the limits of a mass between columns of oil."""

import math

from hydra_actuator.analysis.line_frequencies import line_frequencies, piston_frequencies
from hydra_actuator.parameters import Parameters
import pytest

RIGID = {'cylinder.stiffness': 0.0, 'cylinder.viscous_friction': 0.0}


def wave_speed(values):
    return math.sqrt(values['fluid.bulk_modulus'] / values['fluid.density'])


def test_supply_and_return_line_ring_at_odd_quarter_waves():
    values = Parameters({'supply_line.length': 1.0, 'return_line.length': 3.0})
    found = line_frequencies(values, 0.0, 1000.0)
    quarter = wave_speed(values) / 4.0
    supply = [one.value for one in found if one.name == 'supply_line']
    assert supply == pytest.approx([n * quarter for n in (1, 3) if n * quarter <= 1000.0])
    back = [one.value for one in found if one.name == 'return_line']
    assert back == pytest.approx([n * quarter / 3 for n in (1, 3, 5, 7, 9)
                                  if n * quarter / 3 <= 1000.0])


def test_a_heavy_piston_swings_on_the_stiffness_of_its_oil():
    values = Parameters({**RIGID, 'cylinder.mass': 1e4})
    volume = sum(0.25 * math.pi * values[f'line_{k}.diameter']**2 * values[f'line_{k}.length']
                 + values[f'cylinder.area_{k}'] * (values[f'cylinder.dead_length_{k}']
                                                   + 0.5 * values['cylinder.stroke'])
                 for k in (1, 2)) / 2
    stiffness = 2 * values['fluid.bulk_modulus'] * values['cylinder.area_1']**2 / volume
    first = piston_frequencies(values, 0.0, 100.0)[0]
    assert first == pytest.approx(math.sqrt(stiffness / 1e4) / (2 * math.pi), rel=1e-3)


def test_without_steps_in_the_tube_the_roots_are_those_of_one_column():
    area = 1e-3
    diameter = math.sqrt(4 * area / math.pi)
    values = Parameters({**RIGID, 'line_1.diameter': diameter, 'line_2.diameter': diameter,
                         'cylinder.area_1': area, 'cylinder.area_2': area})
    speed, density = wave_speed(values), values['fluid.density']
    length = (values['line_1.length'] + values['cylinder.dead_length_1']
              + 0.5 * values['cylinder.stroke'])
    for root in piston_frequencies(values, 0.0, 3000.0)[::2]:
        omega = 2 * math.pi * root
        held = 2 * density * speed * area / math.tan(omega * length / speed)
        assert omega * values['cylinder.mass'] == pytest.approx(held, rel=1e-6)
