# SPDX-License-Identifier: Apache-2.0
"""
Random sets of parameters, every physical one inside the range its definition declares.

A set is drawn from its number alone. Numbers over wide ranges are log-uniform; `spread`, drawn
for each set, says how far from the default they go: 1 is the whole range, where nearly all sets
contradict themselves, less keeps them nearer to plants that exist. Three sets in four are freed
of the contradictions that independent draws nearly always have.
"""

import math

from hydra_actuator.parameters.definition import Parameter
from hydra_actuator.parameters.streamline import streamline_length, wave_speed
from hydra_actuator.parameters.table import PARAMETERS
from hydra_actuator.parameters.table_actuator import EDGES
from hydra_actuator.parameters.table_hydraulics import LINES
import numpy as np

SEED = 20_240_607
GROUPS = ('fluid.', 'supply.', 'tank.', 'supply_line.', 'line_1.', 'line_2.', 'return_line.',
          'valve.', 'cylinder.', 'initial.', 'solver.')
SINGLE = ('ambient_pressure', 'timing.period')
# Where sets gather, if not at the default: few cells, so that 0.2 s are within reach; room for
# violent flow; what the default leaves out.
CENTRE = {'solver.cells': 40, 'solver.max_mach': 0.1, 'valve.natural_frequency': 100.0,
          **{f'{line}.youngs_modulus': 2e11 for line in LINES}}
# Passes for which the other tests compile the step; each number is a step of its own.
PASSES = 2
# The smallest of numbers that may be 0, as a share of the largest.
LEAST = 1e-12


def physical() -> list[Parameter]:
    """Return the parameters that a set draws."""
    return [one for name, one in PARAMETERS.items() if name.startswith(GROUPS) or name in SINGLE]


def draw_set(number: int, any_passes: bool) -> dict[str, object]:
    """Return the values of a set by name; any_passes: draw `solver.iterations` too."""
    random = np.random.default_rng((SEED, number))
    spread = random.choice([0.03, 0.1, 0.3, 1.0], p=[0.3, 0.35, 0.25, 0.1])
    values = {one.name: draw(one, spread, random) for one in physical()}
    if not any_passes:
        values['solver.iterations'] = PASSES
    if random.random() < 0.75:
        reconcile(values, random)
    return values


def draw(one: Parameter, spread: float, random: np.random.Generator) -> object:
    """Return a value of a parameter, within its range."""
    if one.type == 'bool':
        return bool(random.random() < 0.5)
    if one.type == 'string':
        return str(random.choice(one.choices))
    centre = CENTRE.get(one.name, one.default)
    value = draw_number(one, centre, spread, random)
    value = min(max(value, one.minimum), one.maximum)
    return round(value) if one.type == 'integer' else float(value)


def draw_number(one: Parameter, centre: float, spread: float,
                random: np.random.Generator) -> float:
    """Return a number on the way from the centre to a draw from the whole range."""
    if random.random() < 0.05:
        return random.choice([one.minimum, one.maximum])
    if one.minimum > 0.0:
        return centre * (log_uniform(one.minimum, one.maximum, random) / centre) ** spread
    if random.random() < 0.3:
        return 0.0 if one.minimum == 0.0 else centre
    if one.minimum < 0.0:
        bound = one.maximum if random.random() < 0.5 else one.minimum
        far = math.copysign(log_uniform(LEAST * abs(bound), abs(bound), random), bound)
        return centre + spread ** 2 * (far - centre)
    far = log_uniform(LEAST * one.maximum, one.maximum, random)
    if centre == 0.0:
        # no scale of its own: the middle of the range in decades
        centre = math.sqrt(LEAST) * one.maximum
    return centre * (far / centre) ** spread


def log_uniform(low: float, high: float, random: np.random.Generator) -> float:
    """Return a positive number, each decade as likely as another."""
    return math.exp(random.uniform(math.log(low), math.log(high)))


def reconcile(values: dict[str, object], random: np.random.Generator) -> None:
    """Take out the contradictions that independent draws have as often as not."""
    coulomb = values['cylinder.coulomb_friction']
    values['cylinder.static_friction'] = min(coulomb * random.uniform(1.0, 3.0), 1e9)
    for edge in EDGES:
        values[f'valve.overlap_{edge}'] = values['valve.stroke'] * random.choice(
            [0.0, random.uniform(-1.0, 0.9)])
    for line in LINES:
        values[f'{line}.roughness'] = min(
            values[f'{line}.roughness'], 0.04 * values[f'{line}.diameter'])
    stroke = values['cylinder.stroke']
    values['initial.position'] = stroke * random.choice([-0.5, 0.5, random.uniform(-0.5, 0.5)])
    reconcile_pressures(values, random)
    reconcile_lengths(values)


def reconcile_pressures(values: dict[str, object], random: np.random.Generator) -> None:
    """Bring pressures below what oil and walls bear, above vapour pressure, and in order."""
    softest = values['fluid.density'] * min(wave_speed(values, line) for line in LINES) ** 2
    supply = values['supply.pressure'] = min(values['supply.pressure'], 0.4 * softest)
    values['tank.pressure'] = min(values['tank.pressure'], 0.4 * softest)
    values['supply.accumulator_precharge'] = supply * random.uniform(0.0, 1.0)
    ambient = values['ambient_pressure'] = max(values['ambient_pressure'], 1.0)
    vapour = values['fluid.vapour_pressure'] = min(
        values['fluid.vapour_pressure'], 0.5 * ambient)
    for side in '12':
        values[f'initial.pressure_{side}'] = max(
            supply * random.uniform(0.0, 1.0), 0.5 * (vapour - ambient))


def reconcile_lengths(values: dict[str, object]) -> None:
    """Make every domain long enough for a cell, more or less."""
    for name in (*(f'{line}.length' for line in LINES), 'cylinder.dead_length_1',
                 'cylinder.dead_length_2'):
        values[name] = max(
            values[name], 1.2 * streamline_length(values) / values['solver.cells'])
