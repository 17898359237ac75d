# SPDX-License-Identifier: Apache-2.0
"""Lengths, cells, period and friction that one mesh cannot carry: all of them are named."""

from hydra_actuator import Actuator, load_parameters
from hydra_actuator.parameters import ParameterError
from hydra_actuator.parameters.streamline import step_time
import pytest

COARSE = {'solver.cells': 20}


@pytest.mark.parametrize('changes, named', [
    ({'line_1.length': 1e-3}, ['line_1.length = 0.001', 'solver.cells = 200']),
    ({'return_line.length': 0.05, **COARSE}, ['return_line.length = 0.05', 'solver.cells = 20']),
    ({'cylinder.dead_length_2': 1e-3}, ['cylinder.dead_length_2 = 0.001', 'solver.cells = 200']),
    ({'timing.period': 1e-4, 'fluid.bulk_modulus': 1e8, 'tank.pressure': 0.0,
      'supply_line.length': 5e3}, ['timing.period = 0.0001', 'solver.cells = 200', 'nodes']),
    ({'timing.period': 1.0, 'solver.cells': 2000},
     ['timing.period = 1.0', 'solver.cells = 2000', 'node updates']),
    ({'line_2.loss_coefficient': 1e5, 'solver.max_mach': 0.1},
     ['line_2.loss_coefficient = 100000.0', 'solver.max_mach = 0.1', 'solver.cells = 200']),
    ({'line_2.friction': 'steady', 'line_2.diameter': 1e-4},
     ['fluid.kinematic_viscosity = 4.6e-05', 'line_2.diameter = 0.0001', 'solver.cells = 200']),
    ({'supply_line.friction': 'unsteady', 'supply_line.diameter': 2e-4, 'solver.max_mach': 0.5,
      'fluid.kinematic_viscosity': 1e-7},
     ['supply_line.diameter = 0.0002', 'solver.max_mach = 0.5', 'solver.cells = 200']),
    ({'supply.pressure': 4e8, 'fluid.bulk_modulus': 6e8},
     ['supply.pressure = 400000000.0', 'fluid.bulk_modulus = 600000000.0']),
    ({'line_1.youngs_modulus': 5e-324, 'supply.pressure': 0.0, 'initial.pressure_1': 0.0},
     ['timing.period = 0.001', 'solver.cells = 200', 'elastic wall']),
    ({'line_1.youngs_modulus': 5e7},
     ['supply.pressure = 21000000.0', 'line_1.youngs_modulus = 50000000.0']),
])
def test_contradiction_names_all_that_make_it(changes, named):
    with pytest.raises(ParameterError) as caught:
        load_parameters(overrides=changes)
    for text in named:
        assert text in str(caught.value)
    assert '\n' not in str(caught.value)


def test_a_line_and_a_chamber_of_one_cell_are_accepted_and_meshed():
    cell = 1300.0 * 1.025 * step_time(load_parameters(overrides=COARSE))
    changes = {**COARSE, 'line_1.length': 1.06 * cell, 'line_2.length': 1.06 * cell,
               'cylinder.dead_length_1': 1.06 * cell, 'initial.position': -0.1,
               'timing.period': 1e-2}
    actuator = Actuator(load_parameters(overrides=changes))
    actuator.advance(2e-3, spool=-0.1)
    assert actuator.state.position == pytest.approx(-0.1, abs=5e-3)


def test_elasticity_slows_the_wave_as_korteweg_says():
    p = load_parameters(overrides={'line_1.youngs_modulus': 2e11})
    actuator = Actuator(p)
    softness = 1.0 + 1.4534e9 * 0.016 / (2e11 * 0.002)
    speeds = actuator._model.wave_speed
    assert speeds[1] == pytest.approx(speeds[0] / softness ** 0.5, rel=1e-12)
