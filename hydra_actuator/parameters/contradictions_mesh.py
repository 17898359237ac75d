# SPDX-License-Identifier: Apache-2.0
"""
What lengths, wave speeds, cells and period cannot be together on one mesh.

All domains share one step, so each line has cells of its own wave speed; the method is stable
only if a wave crosses at most one cell a step, which asks for a whole cell in every domain, in a
chamber with the piston at its end too. And a period must be one that a program can still be
stopped in: nothing interrupts the solver within it.
"""

from collections.abc import Iterator, Mapping
import sys

from hydra_actuator.parameters.definition import Value
from hydra_actuator.parameters.streamline import step_time, streamline_length, wave_speed
from hydra_actuator.parameters.table_hydraulics import LINES

# Nodes of a mesh: a few hundred bytes each. Node updates in a period: about a second of a core.
MOST_NODES = 100_000
MOST_UPDATES = 2e8
# Darcy factor of turbulent flow in the roughest tube that is accepted.
_ROUGHEST_FACTOR = 0.08


def mesh(values: Mapping[str, Value]) -> Iterator[str]:
    """Yield what is wrong with the mesh that the values ask for."""
    step = step_time(values)
    margin = 1.0 + values['solver.max_mach']
    nodes = 0.0
    for line in LINES:
        cell = max(wave_speed(values, line) * margin * step, sys.float_info.min)
        nodes += values[f'{line}.length'] / cell
        if values[f'{line}.length'] < cell * (1.0 - 1e-9):
            yield _too_short(values, f'{line}.length', cell)
    cell = wave_speed(values) * margin * step
    for side in '12':
        dead = values[f'cylinder.dead_length_{side}']
        nodes += (dead + values['cylinder.stroke']) / cell
        if dead < cell * (1.0 + 1e-9):
            yield _too_short(values, f'cylinder.dead_length_{side}', cell)
    if nodes > MOST_NODES:
        yield (
            f'timing.period = {values["timing.period"]} and solver.cells = '
            f'{values["solver.cells"]} make steps of {step:.4g} s and {nodes:.3g} nodes, more '
            f'than {MOST_NODES}: a wave slower by an elastic wall has more cells, and no step '
            'exceeds the period'
        )
    updates = nodes * values['timing.period'] / step
    if updates > MOST_UPDATES:
        yield (
            f'timing.period = {values["timing.period"]} and solver.cells = '
            f'{values["solver.cells"]} make {values["timing.period"] / step:.3g} steps of '
            f'{nodes:.3g} nodes a period, more than {MOST_UPDATES:.0e} node updates: shorten the '
            'period or lower the cells'
        )


def friction(values: Mapping[str, Value]) -> Iterator[str]:
    """
    Yield friction that would more than stop the oil within a step, which makes it grow instead.

    The drag of a step is found from velocities, so lambda |u| dt (turbulent, at the largest
    velocity) and 8 nu dt/r^2 (laminar) must stay below 1.
    """
    step = step_time(values)
    fastest = values['solver.max_mach'] * wave_speed(values)
    for line in LINES:
        law, diameter = values[f'{line}.friction'], values[f'{line}.diameter']
        mesh = f'solver.cells = {values["solver.cells"]}'
        speed = f'solver.max_mach = {values["solver.max_mach"]}'
        stopped = 'would more than stop the oil within a step of'
        if law == 'constant' and values[f'{line}.loss_coefficient'] * fastest * step > 1.0:
            yield (
                f'{line}.loss_coefficient = {values[f"{line}.loss_coefficient"]} {stopped} '
                f'{step:.4g} s at {speed}; lower that or raise {mesh}'
            )
        if law in ('steady', 'unsteady'):
            if 32.0 * values['fluid.kinematic_viscosity'] / diameter ** 2 * step > 1.0:
                yield (
                    f'fluid.kinematic_viscosity = {values["fluid.kinematic_viscosity"]} with '
                    f'{line}.diameter = {diameter} {stopped} {step:.4g} s; raise {mesh}'
                )
            if _ROUGHEST_FACTOR / diameter * fastest * step > 1.0:
                yield (
                    f'{line}.diameter = {diameter} with {line}.friction = {law} {stopped} '
                    f'{step:.4g} s at {speed}; lower that or raise {mesh}'
                )


def _too_short(values: Mapping[str, Value], name: str, cell: float) -> str:
    return (
        f'{name} = {values[name]} is shorter than one cell of {cell:.4g} m, which solver.cells = '
        f'{values["solver.cells"]} gives on a streamline of {streamline_length(values):.6g} m; '
        'lengthen it or raise solver.cells'
    )
