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


def chamber(cells: int) -> LoneChain:
    """Return oil at rest; input 0 is the pressure of the outlet, 1 the speed of the wall."""
    # a face exactly on a node might begin on either side of it
    return LoneChain(
        [Domain('chamber', LENGTH, AREA, WAVE_SPEED, pressure=REST, longest=2.0 * LENGTH)],
        [Junction(PRESSURE, (OUTLET,), 0), Junction(WALL, (FACE,), 1)],
        mesh_of(LENGTH - 1e-6, cells))


def sudden_start() -> list[Row]:
    """Start the wall at once; nothing comes back for 2 L/c."""
    cells = 200
    chain = chamber(cells)
    exact = (BULK_MODULUS + REST) * np.expm1(SPEED / WAVE_SPEED)
    rises = []
    for _ in range(cells):
        chain.step(REST, -SPEED)
        rises.append(chain.end_pressure(FACE) - REST)
    worst = max(rises, key=lambda rise: abs(rise - exact))
    return [
        Row(NAME, 'rise at the face, sudden, worst of all steps', 'Pa', float(exact), worst, 1e-9,
            True, 'mu - u arrives unchanged: rounding'),
        Row(NAME, 'rise at the face, sudden', 'MPa', 5.639, rises[-1] / 1e6, 5e-4, False,
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


def smooth_drive(cells: int) -> dict[str, float]:
    """Return worst errors [Pa] at the face and in the field, and cells gained or lost."""
    chain = chamber(cells)
    step_time = chain.model.step_time
    at_face, in_field, changes = 0.0, 0.0, 0
    for k in range(1, round(1.0 / FREQUENCY / step_time) + 1):
        time, before = k * step_time, int(chain.state.last[0])
        outlet = MU_REST + float(exact_velocity(LENGTH, time))
        chain.step(float(pressure_of(outlet)), -float(wall_speed(time)))
        changes += abs(int(chain.state.last[0]) - before)
        exact = pressure_of(MU_REST + wall_speed(time))
        at_face = max(at_face, abs(chain.end_pressure(FACE) - exact))
        if k % 50 == 0:
            velocity = exact_velocity(LENGTH - chain.positions(0), time)
            error = chain.pressure(0) - pressure_of(MU_REST + velocity)
            in_field = max(in_field, float(np.abs(error).max()))
    return {'face': float(at_face), 'field': in_field, 'changes': changes}


def driven_piston() -> list[Row]:
    """Drive the wall at once, then smoothly to and fro."""
    runs = {cells: smooth_drive(cells) for cells in (100, 200, 400)}
    # the face sweeps 4/3 of SPEED/omega twice: whole cells left behind, then taken back
    spacing = (LENGTH - 1e-6) / 200
    crossings = 2 * int(2 * wall_place(0.25 / FREQUENCY) / spacing + 1e-6 / spacing + 1.0)
    reason = 'second order in time; 1e-8 of the rise'
    order = float(np.log2(runs[100]['field'] / runs[400]['field'])) / 2.0
    return [
        *sudden_start(),
        Row(NAME, 'pressure at the face, smooth, worst', 'Pa', 0.0, runs[200]['face'], 0.06, False,
            reason),
        Row(NAME, 'pressure in the field, smooth, worst', 'Pa', 0.0, runs[200]['field'], 0.06,
            False, reason),
        Row(NAME, 'cells lost and gained', '-', crossings, runs[200]['changes'], 0.0, False,
            'counted from the exact path'),
        Row(NAME, 'order of the field, 100 to 400 cells', '-', 2.0, order, 0.3, False,
            'the cell that changes is not the same on each mesh'),
    ]


CASES = {NAME: Case(driven_piston, 'a wall driven into oil at rest, exact and nonlinear')}
