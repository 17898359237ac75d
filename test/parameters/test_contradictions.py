# SPDX-License-Identifier: Apache-2.0
"""Parameters that cannot be together: both are named, with their values."""

from hydra_actuator import load_parameters
from hydra_actuator.parameters import ParameterError
import pytest


@pytest.mark.parametrize('changes, named', [
    ({'cylinder.coulomb_friction': 5.0},
     ['cylinder.static_friction = 0.0', 'cylinder.coulomb_friction = 5.0']),
    ({'supply.accumulator_volume': 1e-3, 'supply.accumulator_precharge': 22e6},
     ['supply.accumulator_precharge = 22000000.0', 'supply.pressure = 21000000.0']),
    ({'valve.overlap_pa': 5e-4}, ['valve.overlap_pa = 0.0005', 'valve.stroke = 0.0005']),
    ({'valve.overlap_bt': -6e-4}, ['valve.overlap_bt = -0.0006', 'valve.stroke = 0.0005']),
    ({'initial.position': -0.11}, ['initial.position = -0.11', 'cylinder.stroke = 0.2']),
    ({'initial.pressure_2': -101320.0},
     ['initial.pressure_2 = -101320.0', 'fluid.vapour_pressure = 10.0']),
    ({'fluid.vapour_pressure': 2e5},
     ['fluid.vapour_pressure = 200000.0', 'ambient_pressure = 101325.0']),
    ({'line_1.roughness': 1e-3}, ['line_1.roughness = 0.001', 'line_1.diameter = 0.016']),
    ({'sections.names': ['A', 'rod']}, ['sections.names', 'sections.positions', 'rod']),
    ({'sections.positions': [1.0]}, ['sections.names', 'sections.positions']),
    ({'sections.names': ['rod'], 'sections.positions': [2.5]}, ['sections.positions', '2.5 m']),
    ({'sections.names': ['A', 'B', 'A']}, ['sections.names', "'A'", '2 times']),
    ({'command.piston_joint': 'valve'},
     ['command.piston_joint = valve', 'command.valve_joint = valve']),
    ({'command.valve_joint': ' '}, ['command.valve_joint']),
    ({'timing.mode': 'lockstep', 'timing.lockstep_period': 5e-4},
     ['timing.lockstep_period = 0.0005', 'timing.period = 0.001']),
    ({'timing.mode': 'lockstep', 'timing.lockstep_period': 1.5e-3},
     ['timing.lockstep_period = 0.0015', 'timing.period = 0.001']),
    ({'timing.mode': 'follow_clock', 'publish.clock': True},
     ['publish.clock = true', 'timing.mode = follow_clock']),
])
def test_contradiction_names_both_sides(changes, named):
    with pytest.raises(ParameterError) as caught:
        load_parameters(overrides=changes)
    for text in named:
        assert text in str(caught.value)
    assert '\n' not in str(caught.value)


@pytest.mark.parametrize('name', ['1st', 'a b', 'a/b', 'a__b', '', 'ä', '_a', 'a-b', 'x' * 200])
def test_section_name_that_no_topic_can_bear_is_refused(name):
    with pytest.raises(ParameterError, match=r'sections\.names'):
        load_parameters(overrides={'sections.names': [name], 'sections.positions': [1.0]})


@pytest.mark.parametrize('changes', [
    {'cylinder.coulomb_friction': 5.0, 'cylinder.static_friction': 5.0},
    {'supply.accumulator_precharge': 22e6},
    {'initial.position': 0.1},
    {'valve.overlap_pa': -5e-4},
    {'sections.names': [], 'publish.sections_rate': 0.0},
    {'sections.names': ['rod_1', 'K'], 'sections.positions': [2.0]},
    {'supply.pressure': 0.0},
])
def test_edge_of_what_goes_together_is_accepted(changes):
    parameters = load_parameters(overrides=changes)
    for name, value in changes.items():
        assert parameters[name] == (tuple(value) if isinstance(value, list) else value)
