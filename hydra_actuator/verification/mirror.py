# SPDX-License-Identifier: Apache-2.0
"""The whole actuator under a command and under its negative: each the other's mirror image."""

from functools import cache

from hydra_actuator.actuator import Actuator
from hydra_actuator.parameters import Parameters
from hydra_actuator.verification.case import Case, Row
from hydra_actuator.verification.drawing import (
    bar,
    EXACT_LINE,
    MEGAPASCAL,
    MILLI,
    SERIES,
    SOLVER,
)
import numpy as np

FREQUENCY = 50.0
TICKS = 200
# A and J stay, B..I change places with I..B
IMAGE = [0, 8, 7, 6, 5, 4, 3, 2, 1, 9]
POSITION_BAR, PRESSURE_BAR = 1e-16, 1e-6


@cache
def run(sign: float) -> tuple[np.ndarray, ...]:
    """
    Return times [s] (T,), positions [m] (T,) and pressures [Pa] (T, A to J) under a sine.

    Of full stroke; the chambers are at first midway between supply and tank.
    """
    parameters = Parameters()
    midway = 0.5 * (parameters['supply.pressure'] + parameters['tank.pressure'])
    actuator = Actuator(parameters.replace({
        'initial.pressure_1': midway, 'initial.pressure_2': midway,
        'sections.names': tuple('ABCDEFGHIJ')}))
    rows = []
    for _ in range(TICKS):
        time = actuator.time + actuator.period
        command = sign * float(np.sin(2.0 * np.pi * FREQUENCY * time))
        actuator.tick_once(command, command, 0.0)
        rows.append(actuator.row.copy())
    rows, channels = np.array(rows), actuator.channels
    times = actuator.period * np.arange(1, TICKS + 1)
    return times, rows[:, channels.POSITION], rows[:, channels.pressure]


def mirror() -> list[Row]:
    """Compare both."""
    _, position, pressure = run(1.0)
    _, mirrored, other = run(-1.0)
    image = other[:, IMAGE]
    stroke = float(np.ptp(position))
    return [
        Row('mirror', 'position + mirrored position, worst', 'm', 0.0,
            float(np.abs(position + mirrored).max()), POSITION_BAR, False,
            f'rounding at a stroke of {1e3 * stroke:.1f} mm'),
        Row('mirror', 'pressure - mirrored pressure, worst of A to J', 'Pa', 0.0,
            float(np.abs(pressure - image).max()), PRESSURE_BAR, False, 'rounding of mu, 3e-9 Pa'),
    ]


def draw_mirror(figure) -> None:
    """Draw position and face pressures of both runs, one mirrored, and how far they differ."""
    panels = figure.subplots(2, 2, sharex=True, height_ratios=(3, 2))
    time, position, pressure = run(1.0)
    _, mirrored, other = run(-1.0)
    time, image = MILLI * time, other[:, IMAGE]
    panels[0, 0].plot(time, -MILLI * mirrored, **{
        **EXACT_LINE, 'label': 'negative command, mirrored'})
    panels[0, 0].plot(time, MILLI * position, **{**SOLVER, 'label': 'command'})
    panels[0, 0].set_ylabel('position [mm]')
    panels[0, 1].plot(time, MEGAPASCAL * image[:, 4], **{
        **EXACT_LINE, 'label': 'F, negative command'})
    panels[0, 1].plot(time, MEGAPASCAL * pressure[:, 4], **{**SOLVER, 'label': 'E, command'})
    panels[0, 1].set_ylabel('pressure at the piston, absolute [MPa]')
    panels[1, 0].plot(time, np.abs(position + mirrored), '.', color=SERIES[0], markersize=3)
    panels[1, 0].set_ylabel('|position + mirrored| [m]')
    panels[1, 1].plot(time, np.abs(pressure - image).max(axis=1), '.', color=SERIES[0],
                      markersize=3, label='worst of A to J')
    panels[1, 1].set_ylabel('pressure difference [Pa]')
    for axes, tolerance in zip(panels[1], (POSITION_BAR, PRESSURE_BAR)):
        bar(axes, tolerance)
        axes.set_yscale('symlog', linthresh=1e-3 * tolerance)
        axes.set_ylim(-1e-4 * tolerance, 10.0 * tolerance)
        axes.set_xlabel('time [ms]')
    for axes in panels.flat:
        axes.grid(True)
        axes.legend(loc='lower left', bbox_to_anchor=(0.0, 1.0), ncols=2, borderpad=0)


CASES = {'mirror': Case(mirror, 'a command and its negative', figure=draw_mirror)}
