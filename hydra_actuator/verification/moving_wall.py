# SPDX-License-Identifier: Apache-2.0
"""
A wall driven into oil at rest, against the exact nonlinear wave it sends.

          x = 0                              face
    outlet |----------------------------------]  <-- v(t)     xi counts from the face's first
                                    xi <------|               place into the oil

    u = v(tau), mu = mu0 + u   on   xi = xi_p(tau) + (c + u)(t - tau),   xi_p = integral of v

The outlet is held at this wave's own pressure there: the wave passes out, and the run may be long
enough for cells to vanish and come back.
"""

from dataclasses import dataclass
from functools import cache

from hydra_actuator.core.model import Domain, Junction
from hydra_actuator.core.records import PRESSURE, WALL
from hydra_actuator.verification.case import Case, Row
from hydra_actuator.verification.chains import (
    BULK_MODULUS,
    LoneChain,
    mesh_of,
    pressure_of,
    riemann_variable,
    WAVE_SPEED,
)
import numpy as np

NAME = 'driven_piston'
LENGTH = 2.0
AREA = 1e-3
REST = 10e6
MU_REST = float(riemann_variable(REST))
SPEED = 5.0
FREQUENCY = 25.0
OUTLET, FACE = 0, 1
CELLS = (100, 200, 400)
BAR = 0.06              # [Pa], of the smooth drive


def chamber(cells: int) -> LoneChain:
    """Return oil at rest; input 0 is the pressure of the outlet, 1 the speed of the wall."""
    # a face exactly on a node might begin on either side of it
    return LoneChain(
        [Domain('chamber', LENGTH, AREA, WAVE_SPEED, pressure=REST, longest=2.0 * LENGTH)],
        [Junction(PRESSURE, (OUTLET,), 0), Junction(WALL, (FACE,), 1)],
        mesh_of(LENGTH - 1e-6, cells))


START_CELLS = 200


def start_rise() -> float:
    """Return the exact rise [Pa] at a wall that starts at once."""
    return float((BULK_MODULUS + REST) * np.expm1(SPEED / WAVE_SPEED))


@cache
def started() -> tuple[np.ndarray, np.ndarray]:
    """Return time [s] and rise [Pa] at a wall that starts at once; no echo for 2 L/c."""
    chain, trace = chamber(START_CELLS), []
    for _ in range(START_CELLS):
        chain.step(REST, -SPEED)
        trace.append((chain.time, chain.end_pressure(FACE) - REST))
    time, rise = np.array(trace).T
    return time, rise


def sudden_start() -> list[Row]:
    """Start the wall at once."""
    exact, (_, rises) = start_rise(), started()
    worst = float(rises[np.argmax(np.abs(rises - exact))])
    return [
        Row(NAME, 'rise at the face, sudden, worst of all steps', 'Pa', exact, worst, 1e-9,
            True, 'mu - u arrives unchanged: rounding'),
        Row(NAME, 'rise at the face, sudden', 'MPa', 5.639, float(rises[-1]) / 1e6, 5e-4, False,
            'digits of the expected value; linear theory has 5.590'),
    ]


def wall_speed(time):
    """Return v [m/s] of the driven wall: smooth from rest, to and fro."""
    return SPEED * np.sin(2.0 * np.pi * FREQUENCY * np.maximum(time, 0.0)) ** 3


def wall_place(time):
    """Return xi_p [m], the integral of wall_speed."""
    omega = 2.0 * np.pi * FREQUENCY
    cosine = np.cos(omega * np.maximum(time, 0.0))
    return SPEED / omega * (2.0 / 3.0 - cosine + cosine ** 3 / 3.0)


def exact_velocity(xi, time: float):
    """Return u [m/s] of the driven wall's wave at distances xi [m], before a front forms."""
    tau = time - xi / WAVE_SPEED
    for _ in range(12):
        # contracts by v/c + v'(t - tau)/c, 0.5 % here
        tau = time - (xi - wall_place(tau)) / (WAVE_SPEED + wall_speed(tau))
    return wall_speed(tau)


@dataclass(frozen=True)
class Drive:
    """
    A smooth drive: by step time [s], pressure at the face [Pa] and its error; cells changed.

    fields: (time [s], place from the outlet [m], pressure and its error [Pa]) of some steps.
    """

    time: np.ndarray
    face: np.ndarray
    face_error: np.ndarray
    fields: tuple[tuple[float, np.ndarray, np.ndarray, np.ndarray], ...]
    changes: int

    @property
    def field_error(self) -> float:
        """Largest error in the field [Pa]."""
        return max(float(np.abs(error).max()) for *_, error in self.fields)


@cache
def smooth_drive(cells: int) -> Drive:
    """Drive the wall to and fro, with the exact wave's own pressure at the outlet."""
    chain = chamber(cells)
    step_time = chain.model.step_time
    trace, fields, changes = [], [], 0
    for k in range(1, round(1.0 / FREQUENCY / step_time) + 1):
        time, before = k * step_time, int(chain.state.last[0])
        outlet = MU_REST + float(exact_velocity(LENGTH, time))
        chain.step(float(pressure_of(outlet)), -float(wall_speed(time)))
        changes += abs(int(chain.state.last[0]) - before)
        face = chain.end_pressure(FACE)
        trace.append((time, face, face - pressure_of(MU_REST + wall_speed(time))))
        if k % 50 == 0:
            place, pressure = chain.positions(0), chain.pressure(0)
            velocity = exact_velocity(LENGTH - place, time)
            fields.append((time, place, pressure, pressure - pressure_of(MU_REST + velocity)))
    return Drive(*np.array(trace).T, tuple(fields), changes)


def driven_piston() -> list[Row]:
    """Drive the wall at once, then smoothly to and fro."""
    runs = {cells: smooth_drive(cells) for cells in CELLS}
    # the face sweeps 4/3 of SPEED/omega twice: whole cells left behind, then taken back
    spacing = (LENGTH - 1e-6) / 200
    crossings = 2 * int(2 * wall_place(0.25 / FREQUENCY) / spacing + 1e-6 / spacing + 1.0)
    reason = 'second order in time; 1e-8 of the rise'
    order = float(np.log2(runs[100].field_error / runs[400].field_error)) / 2.0
    return [
        *sudden_start(),
        Row(NAME, 'pressure at the face, smooth, worst', 'Pa', 0.0,
            float(np.abs(runs[200].face_error).max()), BAR, False, reason),
        Row(NAME, 'pressure in the field, smooth, worst', 'Pa', 0.0, runs[200].field_error, BAR,
            False, reason),
        Row(NAME, 'cells lost and gained', '-', crossings, runs[200].changes, 0.0, False,
            'counted from the exact path'),
        Row(NAME, 'order of the field, 100 to 400 cells', '-', 2.0, order, 0.3, False,
            'the cell that changes is not the same on each mesh'),
    ]


CASES = {NAME: Case(driven_piston, 'a wall driven into oil at rest, exact and nonlinear')}
