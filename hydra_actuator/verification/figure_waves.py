# SPDX-License-Identifier: Apache-2.0
"""Figures of the waves in lone lines: sudden stop, organ pipes, a travelling Gaussian."""

from hydra_actuator.verification import waves
from hydra_actuator.verification.case import illustrated
from hydra_actuator.verification.drawing import (
    band,
    cells_axis,
    EXACT_LINE,
    MARKERS,
    MEGAPASCAL,
    MILLI,
    SERIES,
    slope,
    SOLVER,
    tolerance_used,
)
import numpy as np

SHOWN_PERIODS = 3.0


def draw_joukowsky(figure) -> None:
    """Draw the pressure at the stopped end and at mid-line, and the error of the rise."""
    above, below = figure.subplots(2, sharex=True, height_ratios=(3, 1.4))
    time, at_end, at_middle = waves.stop()
    rise = waves.stop_rise()
    for front, label in ((0.0, 'exact'), (waves.stop_front(), '_')):
        above.plot(MILLI * np.array((-0.05 * time[-1], front, front, time[-1])),
                   MEGAPASCAL * (waves.HEAD + rise * np.array((0.0, 0.0, 1.0, 1.0))),
                   **{**EXACT_LINE, 'label': label})
    above.plot(MILLI * time, MEGAPASCAL * at_end, **{**SOLVER, 'label': 'solver, stopped end'})
    above.plot(MILLI * time, MEGAPASCAL * at_middle, **{
        **SOLVER, 'color': SERIES[1], 'label': 'solver, mid-line'})
    above.annotate('', (0.1, MEGAPASCAL * (waves.HEAD + rise)),
                   (0.1, MEGAPASCAL * waves.HEAD), arrowprops={'arrowstyle': '<->', 'lw': 0.8})
    above.text(0.12, MEGAPASCAL * (waves.HEAD + 0.5 * rise),
               f'rise {MEGAPASCAL * rise:.5f} MPa\nfor a stop of {waves.STOPPED} m/s', va='center')
    above.set_ylabel('gauge pressure [MPa]')
    above.legend(loc='center right')
    below.plot(MILLI * time, (at_end - waves.HEAD) / rise - 1.0, **{
        **SOLVER, 'label': 'stopped end'})
    band(below, 1e-9)
    below.set_ylabel('error of the rise, relative')
    below.set_xlabel('time [ms]')
    below.legend(ncols=2, loc='lower right')
    for axes in (above, below):
        axes.grid(True)


def draw_organ_pipe(figure) -> None:
    """Draw the last periods of each pipe's modes, and the errors of all periods."""
    panels = figure.subplots(3, 2, width_ratios=(2.2, 1.0))
    rows = waves.organ_pipe()
    for k, (pipe, (ends, numbers)) in enumerate(waves.PIPES.items()):
        axes = panels[k, 0]
        for mode in (1, 2, 3):
            time, pressure = waves.ringing(ends, numbers(mode) / waves.LENGTH)
            exact = waves.LENGTH / (numbers(mode) * waves.WAVE_SPEED)
            periods = time / exact
            shown = periods > 10.0 - SHOWN_PERIODS
            level = 2.6 * (3 - mode)
            wave = np.sign(pressure[0]) * np.cos(2.0 * np.pi * periods[shown])
            axes.plot(periods[shown], level + wave, **{
                **EXACT_LINE, 'label': 'exact' if mode == 1 else '_'})
            axes.plot(periods[shown], level + pressure[shown], **{
                **SOLVER, 'color': SERIES[mode - 1], 'label': f'solver, mode {mode}'})
        axes.set_title(pipe, loc='left')
        axes.set_yticks(2.6 * np.arange(3), ('mode 3', 'mode 2', 'mode 1'))
        axes.grid(True)
        used = panels[k, 1]
        own = [row for row in rows if row.quantity.startswith(pipe)]
        tolerance_used(used, own)
        used.set_yticks(range(3), [f'mode {mode}: {MILLI * row.expected:.4f} ms'
                                   for mode, row in enumerate(own, 1)])
        used.set_title('error of the period', loc='left')
        used.set_xlabel('')
    panels[0, 0].legend(ncols=4, loc='lower right', bbox_to_anchor=(1.0, 1.0), borderpad=0,
                        columnspacing=1.0, handlelength=1.3)
    panels[2, 0].set_xlabel('time [exact periods]; pressure at an antinode, 1 Pa')
    panels[2, 1].set_xlabel('error / tolerance')


def draw_gaussian(figure) -> None:
    """Draw the pulse after its crossings at two Courant numbers, and the orders."""
    panels = figure.subplots(1, 3, width_ratios=(1, 1, 1.1))
    place = np.linspace(0.0, waves.LENGTH, 201)
    for axes, courant in zip(panels, (0.99, 0.9)):
        steps = round(waves.CROSSINGS * 200 / courant)
        axes.plot(place, waves.bell(200), **{**EXACT_LINE, 'label': 'exact: as at first'})
        for interpolation, colour in (('linear', SERIES[1]), ('cubic', SERIES[0])):
            after = waves.crossed(200, steps, waves.CROSSINGS * 200 / steps, interpolation)
            axes.plot(place, after, color=colour, linewidth=1.2,
                      label=f'{interpolation}: {100 * (1 - after.max()):.2f} % of height lost')
        axes.set_title(f'after {waves.CROSSINGS} crossings, Courant {courant:g}', loc='left')
        axes.set_xlabel('place [m]')
        axes.set_ylim(-0.05, 1.25)
        axes.legend(loc='upper left')
        axes.grid(True)
    panels[0].set_ylabel('pressure [Pa]')
    axes = panels[2]
    cells_axis(axes, waves.ORDER_CELLS)
    for interpolation, order, k in (('linear', 1, 1), ('cubic', 3, 0)):
        errors = waves.crossing_errors(interpolation)
        axes.plot(waves.ORDER_CELLS, errors, color=SERIES[k], marker=MARKERS[k], linewidth=1.2,
                  label=interpolation)
        fine = np.array(waves.ORDER_CELLS[-3:])
        slope(axes, fine, 1.6 * errors[-3], order, f'order {order}')
    axes.set_title('error at Courant 0.99', loc='left')
    axes.set_ylabel('RMS error [heights]')
    axes.legend()


CASES = illustrated(waves.CASES, joukowsky=draw_joukowsky, organ_pipe=draw_organ_pipe,
                    gaussian=draw_gaussian)
