# SPDX-License-Identifier: Apache-2.0
"""
What the parameters make of the streamline: lengths, wave speeds, and the step that follows.

    O ---- supply_line ---- A | B - line_1 - C | D - chamber_1 - E ]piston[ F - chamber_2 - G | ...

Everything here takes complete values by name, before or after they have been checked.
"""

from collections.abc import Mapping
import math
import sys

from hydra_actuator.parameters.definition import Value
from hydra_actuator.parameters.table_hydraulics import LINES


def wave_speed(values: Mapping[str, Value], line: str = '') -> float:
    """
    Return the wave speed [m/s] at gauge zero in a line, by default in the oil alone.

    c^2 = chi / rho0 / (1 + chi D / (E e)) with the elasticity of a thin wall (Korteweg).
    """
    softness = 1.0
    if line and values[f'{line}.youngs_modulus'] > 0.0:
        wall = values[f'{line}.youngs_modulus'] * values[f'{line}.wall_thickness']
        softness += (values['fluid.bulk_modulus'] * values[f'{line}.diameter']
                     / max(wall, sys.float_info.min))
    return math.sqrt(values['fluid.bulk_modulus'] / values['fluid.density'] / softness)


def domain_lengths(values: Mapping[str, Value]) -> tuple[float, ...]:
    """Return the six lengths [m] at the initial position."""
    half = 0.5 * values['cylinder.stroke']
    position = values['initial.position']
    return (
        values['supply_line.length'], values['line_1.length'],
        values['cylinder.dead_length_1'] + half + position,
        values['cylinder.dead_length_2'] + half - position,
        values['line_2.length'], values['return_line.length'])


def streamline_length(values: Mapping[str, Value]) -> float:
    """Return the length of the streamline from pump to tank [m], piston at mid-stroke."""
    lines = sum(values[f'{line}.length'] for line in LINES)
    dead = values['cylinder.dead_length_1'] + values['cylinder.dead_length_2']
    return lines + dead + values['cylinder.stroke']


def step_time(values: Mapping[str, Value]) -> float:
    """Return the step time [s] that solver.cells and solver.max_mach give; see `fit_step`."""
    return fit_step(
        values['timing.period'], sum(domain_lengths(values)), values['solver.cells'],
        wave_speed(values), values['solver.max_mach'])


def fit_step(period: float, length: float, cells: int, speed: float, max_mach: float) -> float:
    """
    Return the step time [s]: a whole fraction of `period` [s], at most L/(cells c (1 + max_mach)).

    length: of the whole streamline [m]; speed: the largest wave speed [m/s].
    """
    longest = length / (cells * speed * (1.0 + max_mach))
    return period / math.ceil(period / longest * (1.0 - 1e-12))
