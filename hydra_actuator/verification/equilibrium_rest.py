# SPDX-License-Identifier: Apache-2.0
"""
A start in equilibrium stays there: every pressure and the piston, for a tenth of a second.

Leakage, underlap, unequal areas, a pump at its limit and cavities each make the state at rest
one of steady flow; what is not in balance at first rings at once and is seen at the stations.
"""

from hydra_actuator.actuator import Actuator, SolverError
from hydra_actuator.parameters import Parameters
from hydra_actuator.verification.case import Case, Row
import numpy as np

TICKS = 100
UNDERLAP = {f'valve.overlap_{edge}': -2e-5 for edge in ('pa', 'pb', 'at', 'bt')}
LEAKS = {'valve.leakage': 2e-12, 'cylinder.leakage': 1e-12}
LINES = ('supply_line', 'line_1', 'line_2', 'return_line')
SETS = {
    'leaks, areas 10:7': {**LEAKS, 'cylinder.area_2': 7e-4},
    'underlap and leaks, areas 10:8': {**UNDERLAP, **LEAKS, 'cylinder.area_2': 8e-4},
    'shut, areas 10:6, no spring': {'cylinder.area_2': 6e-4, 'cylinder.stiffness': 0.0},
    'pushed against the stop': {**UNDERLAP, 'cylinder.area_2': 5e-4, 'cylinder.stiffness': 0.0},
    'held by the seals': {
        'valve.leakage': 1e-12, 'cylinder.area_2': 9.5e-4, 'cylinder.stiffness': 0.0,
        'cylinder.static_friction': 1000.0, 'cylinder.coulomb_friction': 500.0},
    'accumulator beside a pump at its limit': {
        **UNDERLAP, 'supply.max_flow': 5e-5, 'supply.accumulator_volume': 1e-3,
        'supply.accumulator_precharge': 3e6},
    'gas in the oil, unsteady friction, tank 0': {
        **UNDERLAP, **LEAKS, 'fluid.cavitation': True, 'tank.pressure': 0.0,
        **{f'{line}.friction': 'unsteady' for line in LINES}},
    'elastic walls, uneven edges': {
        **UNDERLAP, **LEAKS, 'valve.overlap_pa': -3e-5, 'valve.gain_bt': 0.5,
        'line_1.youngs_modulus': 2e9, 'return_line.youngs_modulus': 5e9},
}


def unrest(changes: dict) -> tuple[float, float]:
    """Return the largest changes of any station's pressure [Pa] and of position [m]."""
    actuator = Actuator(Parameters().replace({'initial.equilibrium': True, **changes}))
    channels, first = actuator.channels, actuator.row.copy()
    worst = np.zeros(channels.width)
    for _ in range(TICKS):
        code = actuator.tick_once(0.0, 0.0, 0.0)
        if code:
            raise SolverError(actuator.status_message(code))
        worst = np.maximum(worst, np.abs(actuator.row - first))
    return float(worst[channels.pressure].max()), float(worst[channels.POSITION])


def equilibrium_rest() -> list[Row]:
    """Start each set in equilibrium and look how far it strays."""
    name, rows = 'equilibrium_rest', []
    for words, changes in SETS.items():
        pressure, position = unrest(changes)
        rows += [
            Row(name, f'{words}: pressure', 'Pa', 0.0, pressure, 1e-3, False,
                'the search ends at 1e-7 Pa, a profile is of fourth order, the pump of 1e-9'),
            Row(name, f'{words}: position', 'm', 0.0, position, 1e-12, False,
                'what 1e-3 Pa do to the oil as a spring'),
        ]
    return rows


CASES = {'equilibrium_rest': Case(equilibrium_rest, 'starts in equilibrium stay there')}
