# SPDX-License-Identifier: Apache-2.0
"""
A uniform stream that carries its wall or piston along: the moving mesh must not be seen.

Oil, wall and piston have one speed, pressure is uniform, and twenty cells appear or vanish.
"""

from hydra_actuator.core.model import Domain, Junction
from hydra_actuator.core.records import PISTON, PISTON_PARAMETERS, PRESSURE, WALL
from hydra_actuator.verification.case import Case, Row
from hydra_actuator.verification.chains import LoneChain, mesh_of, WAVE_SPEED
import numpy as np

LENGTH = 1.0
AREA = 1e-3
PRESSURE_EVERYWHERE = 10e6
SPEED = 5.0
# the face begins half-way along its partial cell, so twenty cells either way are exactly twenty
CELLS = 100
MESH = mesh_of(LENGTH * CELLS / (CELLS + 0.5), CELLS)
CHANGES = 20
TOLERANCE = 1e-12


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


def worst_disturbance(chain: LoneChain, speed: float) -> tuple[float, int]:
    """Return (largest relative change of pressure or velocity, cells gained by the first)."""
    travel = CHANGES * float(chain.model.spacing[0])
    first, worst = int(chain.state.last[0]), 0.0
    for _ in range(round(travel / (abs(speed) * chain.model.step_time))):
        chain.advance()
        for d in range(len(chain.names)):
            own = speed if d == 0 else -speed
            worst = max(worst, float(np.abs(chain.pressure(d) / PRESSURE_EVERYWHERE - 1.0).max()),
                        float(np.abs(chain.velocity(d) / own - 1.0).max()))
    return worst, int(chain.state.last[0]) - first


def free_stream() -> list[Row]:
    """Let streams of both directions carry a wall, then a piston."""
    rows = []
    for what, build in (('wall', wall_in_stream), ('piston', piston_in_stream)):
        for speed in (SPEED, -SPEED):
            worst, gained = worst_disturbance(build(speed), speed)
            rows += [
                Row('free_stream', f'{what} at {speed:+g} m/s, largest change of p or u', '-', 0.0,
                    worst, TOLERANCE, False, 'rounding only'),
                Row('free_stream', f'{what} at {speed:+g} m/s, cells gained', '-',
                    CHANGES * np.sign(speed), gained, 0.0, False, 'a count'),
            ]
    return rows


CASES = {'free_stream': Case(free_stream, 'a uniform stream through a moving mesh')}
