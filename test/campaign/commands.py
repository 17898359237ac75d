# SPDX-License-Identifier: Apache-2.0
"""
Commands that are hard on the valve: slams, reversals, dither, from 1 Hz to 10 kHz.

Each is a schedule as `Actuator.follow` takes it, held between its rows.
"""

import math

import numpy as np

SEED = 17_041_955
FREQUENCIES = (1.0, 1e4)
KINDS = ('slam', 'reverse', 'dither')

# What the sequences drive: shipped values with these changes, cavitation in all of them, and room
# for fronts of collapsing cavities: one sequence in twenty passes the default |u|/c of 0.025, one
# in fifty 0.1; the fastest of 200 reaches 0.163.
MACH = 0.2
PLANTS = (
    {},
    {'tank.pressure': 0.0},
    {'tank.pressure': 0.0, 'cylinder.stiffness': 0.0, 'cylinder.mass': 1.0,
     'cylinder.coulomb_friction': 200.0, 'cylinder.static_friction': 400.0},
    {'valve.natural_frequency': 150.0, 'valve.slew_rate': 0.5, 'valve.leakage': 1e-13,
     'cylinder.leakage': 1e-12, 'supply.accumulator_volume': 1e-3},
    {'valve.overlap_pa': -2e-5, 'valve.overlap_pb': -2e-5, 'valve.overlap_at': -2e-5,
     'valve.overlap_bt': -2e-5, 'tank.pressure': 0.0, 'valve.spools': 2},
    {'supply_line.friction': 'unsteady', 'return_line.friction': 'steady',
     'line_1.youngs_modulus': 2e11, 'line_2.youngs_modulus': 2e11, 'tank.pressure': 1e5},
)


def draw_sequence(number: int, cells: int) -> tuple[dict[str, object], np.random.Generator]:
    """Return the plant of a sequence and the source of its command."""
    plant = PLANTS[number % len(PLANTS)]
    values = {'fluid.cavitation': True, 'solver.cells': cells, 'solver.max_mach': MACH, **plant}
    return values, np.random.default_rng((SEED, number))


def draw_command(duration: float, step_time: float, load: float,
                 random: np.random.Generator) -> tuple[np.ndarray, np.ndarray, bool]:
    """
    Return a schedule over a duration [s]: rows (T, 3) of two spools -1..1 and a force [N].

    load: largest force [N].
    """
    low, high = np.log(FREQUENCIES)
    frequency = math.exp(random.uniform(low, high))
    # eight rows a period, but no more than there are steps
    step = max(1.0 / (8.0 * frequency), step_time)
    count = max(2, min(math.ceil(duration / step) + 1, 20_000))
    times = np.arange(count) * max(step, duration / count)
    spool = shape(str(random.choice(KINDS)), times, frequency, random)
    second = spool
    if random.random() < 0.3:
        second = shape(str(random.choice(KINDS)), times, frequency, random)
    force = load * random.uniform(-1.0, 1.0) * (random.random() < 0.5)
    return times, np.column_stack([spool, second, np.full(count, force)]), True


def shape(kind: str, times: np.ndarray, frequency: float,
          random: np.random.Generator) -> np.ndarray:
    """Return a spool command (T,) of a kind."""
    phase = frequency * times
    size = random.choice([1.0, random.uniform(0.01, 1.0)])
    if kind == 'slam':
        return size * np.where(phase % 1.0 < 0.5, 1.0, random.choice([0.0, -1.0]))
    if kind == 'reverse':
        flips = random.choice([-1.0, 0.0, 1.0], size=math.ceil(phase[-1]) + 2)
        return size * flips[phase.astype(int)]
    slow = math.sin(random.uniform(0.0, 6.3)) + np.sin(
        2.0 * math.pi * 10.0 ** random.uniform(0.0, 2.0) * times)
    dither = random.uniform(0.01, 0.3) * np.sin(2.0 * math.pi * (phase + random.random()))
    return np.clip(size * slow + dither, -1.0, 1.0)
