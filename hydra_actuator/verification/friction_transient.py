# SPDX-License-Identifier: Apache-2.0
"""
Laminar flow stopped at once: the friction's memory against the exact transient.

    pressure held at x = 0 |--- Q0, Poiseuille --->| stopped at t = 0;  p'(L, t)/(Zc Q0)

The flow is so small (1 um/s) that nothing nonlinear is left of it. The steady flow is set, not
run up: a linear fall of pressure, 8 nu u/r^2 of drag at each node, no memory.
"""

from functools import cache
import math

from hydra_actuator.core.model import Domain, Junction, set_domain
from hydra_actuator.core.oil import Oil
from hydra_actuator.core.records import CLOSED, FLOW, PRESSURE
from hydra_actuator.verification.case import Case, Row
from hydra_actuator.verification.chains import LoneChain, mesh_of
from hydra_actuator.verification.drawing import (
    band,
    EXACT_LINE,
    EXACT_POINT,
    SIMPLER,
    SOLVER,
    SOLVER_POINT,
)
from hydra_actuator.verification.friction_laplace import stopped_flow
import numpy as np

DENSITY, BULK_MODULUS = 870.0, 1.5e9
SPEED = math.sqrt(BULK_MODULUS / DENSITY)
LENGTH, RADIUS = 2.0, 0.005
AREA = math.pi * RADIUS ** 2
VELOCITY = 1e-6
CELLS = 200
UNIT = 'Zc Q0'
LAST = 20.0             # [L/c], of a run

# t c/L: p'/(Zc Q0) at Dn = nu L/(c r^2) = 0.0028, 0.0067, 0.05
EXACT = {
    0.5: (1.043655, 1.068790, 1.206154),
    1.0: (1.062608, 1.099434, 1.310185),
    1.5: (1.077511, 1.123857, 1.398576),
    2.5: (-0.794727, -0.660570, 0.191877),
    3.0: (-0.870334, -0.776006, -0.058199),
    3.5: (-0.911514, -0.839330, -0.197055),
    4.5: (0.747750, 0.611690, 0.297261),
    5.0: (0.861303, 0.780173, 0.573634),
    6.5: (-0.552768, -0.302639, 0.618211),
    7.0: (-0.707096, -0.522123, 0.392507),
    9.0: (0.687867, 0.525265, 0.331743),
    11.0: (-0.550075, -0.302037, 0.486094),
    13.0: (0.531663, 0.321766, 0.325963),
    15.0: (-0.406908, -0.128581, 0.451842),
    17.0: (0.393589, 0.170042, 0.369372),
    19.0: (-0.280964, -0.003753, 0.414868),
}
DISSIPATION = {0.0028: 0.004, 0.0067: 0.006, 0.05: 0.010}
REASON = 'the six fitted terms alone are up to 0.0024 off, 200 cells add up to 0.003'
# A line between the tabled ones, at every quarter of L/c that is not a front
ANOTHER, ANOTHER_TOLERANCE = 0.015, 0.006
FINE_TIMES = tuple(k / 4 for k in range(1, 80) if k % 8)


def references() -> dict[float, tuple[dict[float, float], float]]:
    """Return by dissipation number: the exact pressure by time [L/c], and its tolerance."""
    found = {dissipation: ({time: values[k] for time, values in EXACT.items()}, tolerance)
             for k, (dissipation, tolerance) in enumerate(DISSIPATION.items())}
    exact = {time: stopped_flow(time, ANOTHER) for time in FINE_TIMES}
    return {**found, ANOTHER: (exact, ANOTHER_TOLERANCE)}


def transient() -> list[Row]:
    """Stop the flow at each dissipation number; one row each, its worst time."""
    return [worst_row(dissipation, *reference)
            for dissipation, reference in references().items()]


def worst_row(dissipation: float, exact: dict[float, float], tolerance: float) -> Row:
    """Return the row of the time whose pressure is farthest from the exact one."""
    times, expected = np.array(list(exact)), np.array(list(exact.values()))
    got = stopped_pressure(times, dissipation)
    worst = int(np.argmax(np.abs(got - expected)))
    return Row(
        'friction_transient',
        f'Dn {dissipation:g}, worst of {len(times)} times, t c/L = {times[worst]:g}', UNIT,
        float(expected[worst]), float(got[worst]), tolerance, False, REASON)


def stopped_pressure(times, dissipation: float, friction: str = 'unsteady',
                     cells: int = CELLS) -> np.ndarray:
    """Return p'(L)/(Zc Q0) [-] at times [L/c] up to LAST, friction 'steady' or 'unsteady'."""
    return np.interp(times, *stopped_trace(dissipation, friction, cells))


@cache
def stopped_trace(dissipation: float, friction: str = 'unsteady',
                  cells: int = CELLS) -> tuple[np.ndarray, np.ndarray]:
    """Return time [L/c] and p'(L)/(Zc Q0) [-] at each step after the stop."""
    chain = poiseuille_flow(dissipation, CLOSED, friction, cells)
    before = chain.end_pressure(1)
    trace = [(0.0, before)]
    for _ in range(math.ceil(LAST * LENGTH / SPEED / chain.model.step_time)):
        chain.step(0.0)
        trace.append((chain.time, chain.end_pressure(1)))
    time, pressure = np.array(trace).T
    return time * SPEED / LENGTH, (pressure - before) / (DENSITY * SPEED * VELOCITY)


def poiseuille_flow(dissipation: float, far_end: int = FLOW, friction: str = 'unsteady',
                    cells: int = CELLS) -> LoneChain:
    """Return a line in steady laminar flow; input 0 its pressure at x = 0, 1 the far flow."""
    viscosity = dissipation * SPEED * RADIUS ** 2 / LENGTH
    chain = LoneChain(
        [Domain('line', LENGTH, AREA, SPEED, friction=friction)],
        [Junction(PRESSURE, (0,), 0), Junction(far_end, (1,), 1)],
        mesh_of(LENGTH, cells, wave_speed=SPEED), Oil(DENSITY, viscosity))
    drag = 8.0 * viscosity / RADIUS ** 2 * VELOCITY
    mu = -drag / SPEED * chain.positions(0)
    set_domain(chain.model, chain.state, 0, mu + VELOCITY, mu - VELOCITY)
    chain.state.drag[:] = drag
    return chain


def draw_transient(figure) -> None:
    """Draw the pressure at each dissipation number, and the error at the times compared."""
    found = sorted(references().items())
    panels = figure.subplots(len(found), 2, sharex=True, width_ratios=(2.2, 1.0))
    inside = np.array((0.02, 0.1, 0.3, 0.6, 1.0, 1.4, 1.7, 1.9, 1.98))
    for (axes, errors), (dissipation, (exact, tolerance)) in zip(panels, found):
        for front in range(0, int(LAST), 2):
            times = front + inside
            axes.plot(times, [stopped_flow(time, dissipation) for time in times], **{
                **EXACT_LINE, 'label': '_' if front else 'exact'})
        time, pressure = stopped_trace(dissipation, 'steady')
        axes.plot(time, pressure, **{**SIMPLER, 'label': 'steady friction alone'})
        time, pressure = stopped_trace(dissipation)
        axes.plot(time, pressure, **{**SOLVER, 'label': 'solver'})
        if dissipation in DISSIPATION:
            axes.plot(list(exact), list(exact.values()), **{
                **EXACT_POINT, 'markersize': 5, 'label': 'exact, as tabled'})
        axes.set_ylabel("p' / (Zc Q0)")
        axes.set_title(f'Dn = {dissipation:g}', loc='left')
        times = np.array(list(exact))
        errors.plot(times, stopped_pressure(times, dissipation) - np.array(list(exact.values())),
                    **{**SOLVER_POINT, 'markersize': 5})
        band(errors, tolerance)
        errors.set_title('error', loc='left')
        for one in (axes, errors):
            one.grid(True)
    panels[0, 0].legend(ncols=4, loc='lower right', bbox_to_anchor=(1.0, 1.0), borderpad=0,
                        columnspacing=1.0, handlelength=1.3)
    for axes in panels[-1]:
        axes.set_xlabel('time after the stop [L/c]')


CASES = {
    'friction_transient': Case(transient, 'laminar flow stopped at once, unsteady friction',
                               figure=draw_transient),
}
