# SPDX-License-Identifier: Apache-2.0
"""
A uniform stream that carries its wall or piston along: the moving mesh must not be seen.

Oil, wall and piston have one speed, pressure is uniform, and twenty cells appear or vanish.
"""

from functools import cache

from hydra_actuator.core.model import Domain, Junction
from hydra_actuator.core.records import PISTON, PISTON_PARAMETERS, PRESSURE, WALL
from hydra_actuator.verification.case import Case, Row
from hydra_actuator.verification.chains import LoneChain, mesh_of, WAVE_SPEED
from hydra_actuator.verification.drawing import bar, EXACT_LINE, SERIES
import numpy as np

LENGTH = 1.0
AREA = 1e-3
PRESSURE_EVERYWHERE = 10e6
SPEED = 5.0
# the face begins half-way along its partial cell, so twenty cells either way are exactly twenty
CELLS = 100
MESH = mesh_of(LENGTH * CELLS / (CELLS + 0.5), CELLS)
CHANGES = 20
BAR = 1e-12
LEAST = 1e-17           # drawn for no change at all


def moving_chamber(name: str, velocity: float, **place: float) -> Domain:
    """Return a chamber whose oil moves at a velocity [m/s] towards its face."""
    return Domain(name, LENGTH, AREA, WAVE_SPEED, pressure=PRESSURE_EVERYWHERE, velocity=velocity,
                  longest=2.0 * LENGTH, **place)


def wall_in_stream(speed: float) -> LoneChain:
    """Return a chamber whose wall and oil move at a speed [m/s]."""
    chain = LoneChain(
        [moving_chamber('chamber', speed)],
        [Junction(PRESSURE, (0,), 0), Junction(WALL, (1,), 1)], MESH)
    chain.hold(PRESSURE_EVERYWHERE, speed)
    return chain


def piston_in_stream(speed: float) -> LoneChain:
    """Return two chambers whose free piston and oil move at a speed [m/s]."""
    piston = np.zeros(1, PISTON_PARAMETERS)
    piston['mass'], piston['limit'] = 10.0, LENGTH
    piston['length_1'] = piston['length_2'] = LENGTH
    chain = LoneChain(
        [moving_chamber('chamber_1', speed),
         moving_chamber('chamber_2', -speed, origin=2.0 * LENGTH, direction=-1.0)],
        [Junction(PRESSURE, (0,), 0), Junction(PISTON, (1, 3), 1), Junction(PRESSURE, (2,), 0)],
        MESH, piston=piston)
    chain.state.piston['velocity'] = chain.state.piston['new_velocity'] = speed
    chain.hold(PRESSURE_EVERYWHERE)
    return chain


STREAMS = {'wall': wall_in_stream, 'piston': piston_in_stream}


@cache
def disturbance(what: str, speed: float) -> tuple[np.ndarray, np.ndarray]:
    """Return (largest relative change of pressure or velocity, cells gained), by step."""
    chain = STREAMS[what](speed)
    travel = CHANGES * float(chain.model.spacing[0])
    first, changes, gained = int(chain.state.last[0]), [], []
    for _ in range(round(travel / (abs(speed) * chain.model.step_time))):
        chain.advance()
        worst = 0.0
        for d in range(len(chain.names)):
            own = speed if d == 0 else -speed
            worst = max(worst, float(np.abs(chain.pressure(d) / PRESSURE_EVERYWHERE - 1.0).max()),
                        float(np.abs(chain.velocity(d) / own - 1.0).max()))
        changes.append(worst)
        gained.append(int(chain.state.last[0]) - first)
    return np.array(changes), np.array(gained)


def free_stream() -> list[Row]:
    """Let streams of both directions carry a wall, then a piston."""
    rows = []
    for what in STREAMS:
        for speed in (SPEED, -SPEED):
            changes, gained = disturbance(what, speed)
            worst = float(changes.max())
            rows += [
                Row('free_stream', f'{what} at {speed:+g} m/s, largest change of p or u', '-', 0.0,
                    worst, BAR, False, 'rounding only'),
                Row('free_stream', f'{what} at {speed:+g} m/s, cells gained', '-',
                    CHANGES * np.sign(speed), int(gained[-1]), 0.0, False, 'a count'),
            ]
    return rows


def draw_free_stream(figure) -> None:
    """Draw cells gained and the largest change there is, over the way of the face."""
    above, below = figure.subplots(2, sharex=True)
    streams = [(what, speed) for what in STREAMS for speed in (SPEED, -SPEED)]
    for speed in (1.0, -1.0):
        way = np.array((0.0, CHANGES))
        above.plot(way, speed * way, **{**EXACT_LINE, 'label': 'exact' if speed > 0.0 else '_'})
    for k, ((what, speed), colour) in enumerate(zip(streams, SERIES)):
        changes, gained = disturbance(what, speed)
        way = np.arange(1, len(changes) + 1) / len(changes) * CHANGES
        style = {'color': colour, 'linewidth': 4.0 - k, 'label': f'{what} at {speed:+g} m/s'}
        above.plot(way, gained, **style)
        below.plot(way, np.maximum(changes, LEAST), **style)
    bar(below, BAR)
    above.set_ylabel('cells gained by the chamber')
    below.set_yscale('log')
    below.set_ylim(0.5 * LEAST, 10.0 * BAR)
    below.set_yticks((LEAST, 1e-16, 1e-15, 1e-14, 1e-13, 1e-12),
                     ('none', *(f'$10^{{-{k}}}$' for k in range(16, 11, -1))))
    below.set_xlabel('way of the face [cells]')
    below.set_ylabel('largest relative change\nof pressure or velocity, anywhere')
    above.legend(loc='lower left')
    below.legend(ncols=5, loc='center')
    for axes in (above, below):
        axes.grid(True)


CASES = {
    'free_stream': Case(free_stream, 'a uniform stream through a moving mesh',
                        figure=draw_free_stream),
}
