# SPDX-License-Identifier: Apache-2.0
"""
The ends of the stroke: a piston that bounces, and chambers as short as one cell.

A constant load drives a piston from a height h onto its stop, oil all but absent: each rebound
takes e of the speed, so it rises to e^2n h, and the energy m v^2/2 + F h never grows.
"""

from functools import cache
import math

from hydra_actuator.actuator import Actuator, SolverError
from hydra_actuator.errors import Failure
from hydra_actuator.parameters import Parameters
from hydra_actuator.verification.case import Case, Row
from hydra_actuator.verification.drawing import EXACT_POINT, MILLI, SERIES
from hydra_actuator.verification.seals import lone_piston
import numpy as np

MASS, LOAD, HEIGHT, STEP = 5.0, 500.0, 0.05, 1e-5
BOUNCES = 5
LONGEST = 0.5           # s; with e = 1 they take 0.35
IMPACT = math.sqrt(2.0 * LOAD * HEIGHT / MASS)


@cache
def bounce(restitution: float) -> tuple[np.ndarray, np.ndarray]:
    """
    Return the heights [m] of the rebounds and the energy [J] at every step.

    Raises Failure for a piston that does not rise often enough.
    """
    chain = lone_piston(STEP, HEIGHT, mass=MASS, restitution=restitution)
    piston = chain.state.piston[0]
    heights, energy, top, hits = [], [LOAD * HEIGHT], 0.0, 0
    # the piston falls from the middle of its travel to +HEIGHT
    piston['force'] = LOAD
    while len(heights) < BOUNCES:
        chain.step(0.0, -LOAD)
        if chain.time > LONGEST:
            raise Failure(f'{len(heights)} rebounds in {LONGEST:g} s')
        height = HEIGHT - float(piston['position'])
        energy.append(0.5 * MASS * float(piston['velocity']) ** 2 + LOAD * height)
        if int(piston['stop_hits']) > hits:
            if hits:
                heights.append(top)
            hits, top = int(piston['stop_hits']), 0.0
        top = max(top, height)
    return np.array(heights), np.array(energy)


def end_stop() -> list[Row]:
    """Let a piston bounce with three restitutions."""
    name, rows = 'end_stop', []
    for restitution in (0.5, 0.8, 1.0):
        heights, energy = bounce(restitution)
        for n in (1, BOUNCES):
            speed = IMPACT * restitution ** (n - 1)
            late = 2.0 * sum(LOAD / MASS * STEP / (IMPACT * restitution ** k) for k in range(n))
            rows.append(Row(
                name, f'height of rebound {n}, e = {restitution:g}', 'm',
                restitution ** (2 * n) * HEIGHT, float(heights[n - 1]), late, True,
                f'each impact falls within a step: twice g dt of {speed:.3g} m/s at the last'))
        rows.append(Row(
            name, f'largest gain of energy in a step, e = {restitution:g}', 'of it all', 0.0,
            max(0.0, float(np.diff(energy).max())) / energy[0], 1e-9, False,
            'waves of the little oil, 1e-6 N s/m; the stop gives nothing'))
    return rows


# The dead lengths are a cell and a fifth: L/200 = 0.01 m, and nothing but the stop holds.
SHORT = {'cylinder.dead_length_1': 0.012, 'cylinder.dead_length_2': 0.012,
         'cylinder.stiffness': 0.0, 'cylinder.stop_restitution': 0.3, 'supply.max_flow': 0.0}
SWINGING, PRESSED, AFTER = 2000, 3000, 4000     # ends of three phases [ticks of 1 ms]


def at_the_stops() -> tuple[np.ndarray, Actuator]:
    """Swing from stop to stop, press against one, shut the valve; return rows and the actuator."""
    actuator, rows = Actuator(Parameters().replace(SHORT)), []
    for k in range(AFTER):
        command = math.sin(0.02 * math.pi * k) if k < SWINGING else -float(k < PRESSED)
        code = actuator.tick_once(command, command, 0.0)
        if code:
            raise SolverError(actuator.status_message(code))
        rows.append(actuator.row.copy())
    return np.array(rows), actuator


def short_chambers() -> list[Row]:
    """Look at chambers of one cell while pressed flat, and at what rings when the valve shuts."""
    name, (rows, actuator) = 'short_chambers', at_the_stops()
    p, channels = actuator.parameters, actuator.channels
    stations = dict(zip(channels.section_names, rows[:, channels.pressure].T))
    pressed = slice(PRESSED - 100, PRESSED)
    d, g = stations['D'], stations['G']
    return [
        Row(name, 'position when pressed', 'm', -0.5 * p['cylinder.stroke'],
            float(rows[PRESSED - 1, channels.POSITION]), 0.0, False, 'a stop is where it is'),
        Row(name, 'the short chamber when pressed', 'Pa',
            p['tank.pressure'] + p['ambient_pressure'], float(d[pressed].mean()), 1e-3, True,
            'open to the tank; what rings is seen below'),
        Row(name, 'the long chamber when pressed', 'Pa',
            p['supply.pressure'] + p['ambient_pressure'], float(g[pressed].mean()), 1e-3, True,
            'open to the pump'),
        Row(name, 'ringing of the short chamber 0.9 s after the valve shut', 'of the first 0.1 s',
            0.0, float(np.ptp(d[AFTER - 100:]) / np.ptp(d[PRESSED:PRESSED + 100])), 1e-3, False,
            'line and port take energy at each pass and nothing gives any'),
    ]


def draw_end_stop(figure) -> None:
    """Draw the heights of the rebounds beside e^2n h, and the energy that is left."""
    left, right = figure.subplots(1, 2)
    count = np.arange(1, BOUNCES + 1)
    for colour, restitution in zip(SERIES, (0.5, 0.8, 1.0)):
        heights, energy = bounce(restitution)
        left.semilogy(count, MILLI * restitution ** (2 * count) * HEIGHT,
                      **{**EXACT_POINT, 'label': '_' if left.lines else 'exact'})
        left.semilogy(count, MILLI * heights, color=colour, marker='+', markersize=9,
                      label=f'solver, e = {restitution:g}')
        right.plot(MILLI * STEP * np.arange(len(energy)), energy, color=colour,
                   label=f'e = {restitution:g}')
    left.set_xticks(count)
    left.set_xlabel('rebound')
    left.set_ylabel('height [mm]')
    right.set_xlabel('time [ms]')
    right.set_ylabel('kinetic and potential energy [J]')
    for axes in (left, right):
        axes.grid(True)
        axes.legend()


CASES = {
    'end_stop': Case(end_stop, 'a piston bounces on its stop', figure=draw_end_stop),
    'short_chambers': Case(short_chambers, 'chambers of one cell at the stops'),
}
