# SPDX-License-Identifier: Apache-2.0
"""
How much a second pass over slope and friction changes the solution (the paper's figures 2e to 3b).

Two actuators run the paper's reference, one with one pass per step and one with two; their whole
fields are compared every 72 steps, as the paper draws them, in its units: V_max = max_flow over
the area of the supply line, p_max = supply pressure. (Jankovic et al. give 1e-4 of both units for
the sine of 40 units of L/c, 16.25 Hz.) Nodes that only one of the two chamber meshes has are left
out: they exist for a step or two.
"""

from functools import cache
import math

from hydra_actuator.actuator import Actuator, SolverError
from hydra_actuator.parameters import Parameters
from hydra_actuator.verification.case import Case, Row
from hydra_actuator.verification.drawing import bar, MILLI, SERIES
from hydra_actuator.verification.spool_response import paper_parameters
import numpy as np

STEPS_BETWEEN = 72
# Frequency [Hz], amplitude of the spool's stroke, periods.
SINES = ((16.25, 1.0, 2), (50.0, 1.0, 5), (200.0, 0.3, 10))
LIMIT, SHARE_LIMIT = 1e-4, 3e-3


def velocity_unit(parameters: Parameters) -> float:
    """Return the paper's unit of velocity, V_max [m/s]: the pump's flow in the supply line."""
    area = 0.25 * math.pi * parameters['supply_line.diameter'] ** 2
    return parameters['supply.max_flow'] / area


def whole_field(actuator: Actuator) -> np.ndarray:
    """Return pressure [Pa] and velocity [m/s] of all nodes; float32 resolves 1e-7 of the units."""
    out = np.empty((len(actuator.field_labels), 2), np.float32)
    actuator.read_field(out)
    return out.astype(float)


def pass_difference(frequency: float, amplitude: float, periods: int) -> tuple[float, ...]:
    """Return largest differences: velocity over V_max, over its largest, pressure over p_max."""
    _, pressure, velocity, largest = difference_history(frequency, amplitude, periods)
    return float(velocity.max()), float(velocity.max() / largest.max()), float(pressure.max())


@cache
def difference_history(frequency: float, amplitude: float,
                       periods: int) -> tuple[np.ndarray, ...]:
    """
    Return the largest differences anywhere, by frame.

    Time [s], pressure over p_max, velocity over V_max, the largest velocity itself over V_max.
    """
    p = paper_parameters()
    unit = velocity_unit(p)
    one, two = Actuator(p.replace({'solver.iterations': 1})), Actuator(p)
    history = []
    frames = math.ceil(periods / (frequency * one.step_time * STEPS_BETWEEN))
    for frame in range(frames):
        first = frame * STEPS_BETWEEN
        times = np.arange(first + 1, first + STEPS_BETWEEN + 1) * one.step_time
        sine = amplitude * np.sin(2.0 * math.pi * frequency * times)
        commands = np.column_stack((sine, sine, np.zeros_like(sine)))
        for actuator in (one, two):
            code = actuator.follow((times, commands, True), STEPS_BETWEEN)
            if code:
                raise SolverError(actuator.status_message(code))
        field = whole_field(two)
        worst = np.nanmax(np.abs(field - whole_field(one)), axis=0)
        history.append((times[-1], worst[0] / p['supply.pressure'], worst[1] / unit,
                        np.nanmax(np.abs(field[:, 1])) / unit))
    return tuple(np.array(history).T)


def passes() -> list[Row]:
    """Compare runs with one and two passes at three frequencies."""
    rows, reason = [], "the paper's statement for 16.25 Hz, asked of all three"
    for frequency, amplitude, periods in SINES:
        velocity, share, pressure = pass_difference(frequency, amplitude, periods)
        drive = f'{frequency:g} Hz, {amplitude:g} of the stroke'
        rows += [
            Row('passes', f'{drive}: velocity over V_max', '-', 0.0, velocity, LIMIT, False,
                reason),
            Row('passes', f'{drive}: velocity over the largest there is', '-', 0.0, share,
                SHARE_LIMIT, False, "the paper's 3e-3 of the velocities present"),
            Row('passes', f'{drive}: pressure over p_max', '-', 0.0, pressure, LIMIT, False,
                reason),
        ]
    return rows


def draw_passes(figure) -> None:
    """Draw the differences anywhere in the field over time."""
    panels = figure.subplots(2, len(SINES), sharex='col', sharey='row')
    for (above, below), sine in zip(panels.T, SINES):
        time, pressure, velocity, largest = difference_history(*sine)
        above.plot(MILLI * time, pressure, color=SERIES[0], linewidth=1.0,
                   label='pressure over p_max')
        above.plot(MILLI * time, velocity, color=SERIES[1], linewidth=1.0,
                   label='velocity over V_max')
        bar(above, LIMIT)
        below.plot(MILLI * time, velocity / largest.max(), color=SERIES[2], linewidth=1.0,
                   label='velocity over the largest there is')
        bar(below, SHARE_LIMIT)
        above.set_title(f'{sine[0]:g} Hz, {sine[1]:g} of the stroke', loc='left')
        below.set_xlabel('time [ms]')
        for axes in (above, below):
            axes.set_yscale('log')
            axes.grid(True)
    panels[0, 0].set_ylabel('largest difference in the field')
    panels[1, 0].set_ylabel('largest difference in the field')
    panels[0, 0].set_ylim(1e-8, 1e-2)
    panels[1, 0].set_ylim(1e-8, 2e-1)
    panels[0, -1].legend()
    panels[1, -1].legend()


CASES = {
    'passes': Case(passes, 'one pass over slope and friction against two', figure=draw_passes),
}
