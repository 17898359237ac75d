# SPDX-License-Identifier: Apache-2.0
"""A start from equilibrium: nothing moves, whatever leaks, holds or pushes."""

from hydra_actuator.actuator import Actuator
from hydra_actuator.parameters import Parameters
from hypothesis import given, settings, strategies
import numpy as np
import pytest

# Pressures in Pa, positions in m, over 50 ms: what the profiles' integration leaves.
MOST_PRESSURE, MOST_POSITION = 10.0, 1e-9
PERIODS = 50
UNDERLAP = {f'valve.overlap_{edge}': -2e-5 for edge in ('pa', 'pb', 'at', 'bt')}
LAWS = {law: {f'{line}.friction': law for line in
              ('supply_line', 'line_1', 'line_2', 'return_line')}
        for law in ('none', 'steady', 'unsteady')}
LEAKY = {'valve.leakage': 2e-12, 'cylinder.leakage': 1e-12}
SETS = {
    'closed': {},
    'closed, unequal areas, no spring': {'cylinder.area_2': 6e-4, 'cylinder.stiffness': 0.0},
    'closed, leaking piston': {'cylinder.leakage': 1e-11, 'cylinder.area_2': 9e-4},
    'leaking valve': {'valve.leakage': 1e-12},
    'leaking piston and valve, unequal areas': {**LEAKY, 'cylinder.area_2': 7e-4},
    'underlap': UNDERLAP,
    'underlap and leaks': {**UNDERLAP, **LEAKY, 'cylinder.area_2': 8e-4},
    'uneven underlap': {**UNDERLAP, **LEAKY, 'valve.overlap_pa': -3e-5, 'valve.gain_bt': 0.5},
    'one edge open': {'valve.overlap_pa': -2e-5},
    'one edge open, no spring': {'valve.overlap_pa': -2e-5, 'cylinder.stiffness': 0.0},
    'at the stop': {**UNDERLAP, 'cylinder.area_2': 5e-4, 'cylinder.stiffness': 0.0},
    'held by seals': {
        'valve.leakage': 1e-12, 'cylinder.area_2': 9.5e-4, 'cylinder.stiffness': 0.0,
        'cylinder.static_friction': 1000.0, 'cylinder.coulomb_friction': 500.0},
    'no friction': {**UNDERLAP, **LEAKY, **LAWS['none']},
    'steady friction': {**UNDERLAP, **LEAKY, **LAWS['steady']},
    'unsteady friction and gas': {
        **UNDERLAP, **LEAKY, **LAWS['unsteady'], 'fluid.cavitation': True},
    'pump at its limit': {**UNDERLAP, **LEAKY, 'supply.max_flow': 5e-5},
    'pump at its limit, accumulator': {
        **UNDERLAP, 'supply.max_flow': 5e-5, 'supply.accumulator_volume': 1e-3,
        'supply.accumulator_precharge': 3e6},
    'elastic walls': {**UNDERLAP, **LEAKY, 'line_1.youngs_modulus': 2e9},
}


def start(changes: dict) -> Actuator:
    return Actuator(Parameters().replace({'initial.equilibrium': True, **changes}))


def assert_nothing_moves(actuator: Actuator) -> None:
    channels, first = actuator.channels, actuator.row.copy()
    worst = np.zeros(channels.width)
    for _ in range(PERIODS):
        assert actuator.tick_once(0.0, 0.0, 0.0) == 0
        worst = np.maximum(worst, np.abs(actuator.row - first))
    assert worst[channels.POSITION] < MOST_POSITION
    assert worst[channels.pressure].max() < MOST_PRESSURE


@pytest.mark.parametrize('changes', SETS.values(), ids=SETS)
def test_nothing_rings_at_the_start(changes):
    assert_nothing_moves(start(changes))


@settings(max_examples=15, deadline=None, derandomize=True)
@given(
    overlaps=strategies.lists(strategies.sampled_from([-4e-5, -1e-5, 0.0, 2e-5]),
                              min_size=4, max_size=4),
    area=strategies.floats(4e-4, 2e-3), stiffness=strategies.sampled_from([0.0, 2e5, 1e7]),
    leaks=strategies.tuples(*[strategies.sampled_from([0.0, 1e-13, 3e-12])] * 2),
    law=strategies.sampled_from(['none', 'steady']))
def test_nothing_rings_whatever_the_leaks_areas_and_spring(overlaps, area, stiffness, leaks, law):
    names = [f'valve.overlap_{edge}' for edge in ('pa', 'pb', 'at', 'bt')]
    assert_nothing_moves(start({
        **dict(zip(names, overlaps)), **LAWS[law], 'cylinder.area_2': area,
        'cylinder.stiffness': stiffness, 'valve.leakage': leaks[0],
        'cylinder.leakage': leaks[1]}))


def test_symmetric_underlap_halves_the_pressure():
    actuator = start({**UNDERLAP, **LAWS['none']})
    pressure = dict(zip(actuator.channels.section_names, actuator.row[actuator.channels.pressure]))
    middle = 0.5 * (2.1e7 + 2.5e6) + 101325.0
    assert [pressure[station] for station in 'BI'] == pytest.approx([middle] * 2, abs=1e-3)


def test_spring_takes_the_difference_of_the_forces():
    actuator = start({'initial.pressure_1': 12e6, 'initial.pressure_2': 11e6})
    assert actuator.row[actuator.channels.POSITION] == pytest.approx(0.005, abs=1e-15)
