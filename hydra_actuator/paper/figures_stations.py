# SPDX-License-Identifier: Apache-2.0
"""
Figures 2c to 2f and 5a to 5f: the command, and the twelve stations over time at every step.

2c and 2d give each station a panel, 5b and 5c all in one; 2e and 2f show what a second pass over
slope and friction changes there; 5d to 5f are short windows at the beginning, in which a wave is
seen to arrive at one station after another.
"""

from hydra_actuator.analysis.palette import BLUE, INK
from hydra_actuator.channels import STATIONS
from hydra_actuator.paper.canvas import (
    about_cavities,
    extreme_words,
    LEGEND,
    mark_vacuum,
    plot_line,
    PRESSURE,
    Quantity,
    si_right,
    si_top,
    station_line,
    TAU_LABEL,
    VELOCITY,
)
from hydra_actuator.paper.case import Case
from hydra_actuator.paper.runs import Run
import numpy as np

DOMAINS = ('supply line', 'line 1', 'chamber 1', 'chamber 2', 'line 2', 'return line')
SHORT_WINDOWS = {'5d': 1.5, '5e': 5.0, '5f': 20.0}      # [L/c]
ARRIVALS_SHOWN = 2.0        # in windows up to this length [L/c]
PERIODS_IN_DETAIL = 1.25


def draw_lines(axes, run: Run, values: np.ndarray, label: str) -> None:
    """Draw (T, 12) values of the stations into one panel."""
    for k, letter in enumerate(STATIONS):
        plot_line(axes, run.tau[:len(values)], values[:, k], label=letter, linewidth=1.0,
                  **station_line(letter))
    axes.set(xlabel=TAU_LABEL, ylabel=label, xlim=(0.0, run.tau[len(values) - 1]))
    axes.grid(True)


def legend_of(figure, axes) -> None:
    """Put the twelve letters above all panels, the two ends of a domain below each other."""
    lines, letters = axes.get_legend_handles_labels()
    figure.legend(lines, letters, loc='outside upper center', ncols=12, **LEGEND)


def detail(run: Run) -> int:
    """Return how many steps the detail of a period and a quarter has."""
    units = PERIODS_IN_DETAIL / (run.frequency * run.time_unit)
    return min(len(run.tau), int(np.searchsorted(run.tau, units)) + 1)


def _draw_panels(figure, case: Case, quantity: Quantity) -> str:
    run = case.run()
    shown = case.shown(run)
    values, tau = quantity.stations(run)[shown], run.tau[shown]
    panels = figure.subplots(6, 2, sharex=True, sharey=True if quantity.velocity else 'row')
    for k, letter in enumerate(STATIONS):
        axes = panels[k // 2, k % 2]
        plot_line(axes, tau, values[:, k], linewidth=1.1, color=station_line(letter)['color'])
        axes.set_title(letter, loc='left', x=0.015, y=0.7, fontsize=10, fontweight='bold',
                       bbox={'facecolor': 'white', 'alpha': 0.75, 'linewidth': 0, 'pad': 1})
        axes.grid(True)
        axes.set_ylabel(f'{DOMAINS[k // 2]}\n{quantity.symbol} [-]' if k % 2 == 0 else '')
    for axes in panels[:, 1]:
        si_right(axes, quantity.si_unit(run), f'[{quantity.si_label}]')
    for axes in panels[-1]:
        axes.set(xlabel=TAU_LABEL, xlim=(0.0, tau[-1]))
    for axes in panels[0]:
        si_top(axes, run)
    alike = 'All panels' if quantity.velocity else 'The panels of a row'
    return (f'{alike} share their axes; {quantity.unit_in_words(run)}. '
            f'{extreme_words(values, tau, quantity.symbol)}.')


def _draw_all(figure, case: Case, quantity: Quantity) -> str:
    run = case.run()
    values = quantity.stations(run)
    panels = figure.subplots(2, 1)
    draw_lines(panels[0], run, values, quantity.label)
    draw_lines(panels[1], run, values[:detail(run)], quantity.label)
    for axes in panels:
        si_right(axes, quantity.si_unit(run), f'{quantity.name} [{quantity.si_label}]')
        if not quantity.velocity:
            mark_vacuum(axes, run)
    si_top(panels[0], run)
    legend_of(figure, panels[0])
    words = (f'Above the whole run, below its first {PERIODS_IN_DETAIL:g} periods; where lines '
             'coincide the later letter is seen; ')
    words += f'{quantity.unit_in_words(run)}. {extreme_words(values, run.tau, quantity.symbol)}.'
    if quantity.velocity:
        return words
    lowest = values.min() * run.pressure_unit + run.parameters['ambient_pressure']
    return words + f' Lowest absolute pressure: {lowest / 1e6:.4g} MPa.'


def _draw_change(figure, case: Case, quantity: Quantity) -> str:
    run, one = case.run(), case.run(passes=1)
    change = quantity.stations(run) - quantity.stations(one)
    panels = figure.subplots(2, 1)
    _draw_largest(panels[0], run, change, quantity)
    draw_lines(panels[1], run, change[:detail(run)], f'change of {quantity.symbol} [-]')
    worst = np.abs(change).max()
    scale, unit = quantity.small_unit(run, worst)
    for axes in panels:
        si_right(axes, scale, f'[{unit}]')
    si_top(panels[0], run)
    legend_of(figure, panels[0])
    k, station = np.unravel_index(np.abs(change).argmax(), change.shape)
    share = worst / np.abs(quantity.stations(run)).max()
    return ('Above the largest of each period, below the change at every step; '
            f'{quantity.unit_in_words(run)}. Largest change '
            f'{worst:.2g} at {STATIONS[station]}, {run.tau[k]:.4g} units, which is {share:.2g} of '
            f'the largest {quantity.name} at a station; the paper: below 1e-4 of the unit.'
            f'{about_cavities(case)}')


def _draw_largest(axes, run: Run, change: np.ndarray, quantity: Quantity) -> None:
    """Draw the largest |change| at each station in each period."""
    size = round(1.0 / (run.frequency * run.step_time))
    starts = np.arange(0, max(1, len(change) - size // 2), size)
    largest = np.maximum.reduceat(np.abs(change), starts, axis=0)
    for k, letter in enumerate(STATIONS):
        axes.semilogy(run.tau[starts] + 0.5 * size * run.step_time / run.time_unit, largest[:, k],
                      marker='.', markersize=4, linewidth=1.0, label=letter,
                      **station_line(letter))
    axes.set(xlabel=TAU_LABEL, ylabel=f'largest |change| of {quantity.symbol} [-]',
             xlim=(0.0, run.tau[-1]))
    # Where the pressure is given, at O and K, nothing changes but the last bit.
    changing = largest[:, largest.max(axis=0) > 1e-4 * largest.max()]
    if changing.size:
        axes.set_ylim(0.6 * changing.min(), 1.6 * changing.max())
    axes.grid(True)


def figure_2c(figure, case: Case) -> str:
    """Draw velocity at each of the twelve stations."""
    return _draw_panels(figure, case, VELOCITY)


def figure_2d(figure, case: Case) -> str:
    """Draw pressure at each of the twelve stations."""
    return _draw_panels(figure, case, PRESSURE)


def figure_2e(figure, case: Case) -> str:
    """Draw what a second pass changes of the velocity at the stations."""
    return _draw_change(figure, case, VELOCITY)


def figure_2f(figure, case: Case) -> str:
    """Draw what a second pass changes of the pressure at the stations."""
    return _draw_change(figure, case, PRESSURE)


def figure_5a(figure, case: Case) -> str:
    """Draw the command, which an ideal spool follows."""
    run = case.run()
    stroke = run.parameters['valve.stroke']
    spool = run.rows[:, run.channels.SPOOL_1] / stroke
    panels = figure.subplots(2, 1)
    for axes, count in zip(panels, (len(spool), detail(run))):
        plot_line(axes, run.tau[:count], spool[:count], color=BLUE, linewidth=1.2)
        axes.axhline(0.0, color=INK, linewidth=0.6)
        axes.set(xlabel=TAU_LABEL, ylabel='spool / stroke [-]', xlim=(0.0, run.tau[count - 1]))
        axes.grid(True)
        si_right(axes, stroke * 1e3, 'spool [mm]')
    si_top(panels[0], run)
    period = 1.0 / (run.frequency * run.time_unit)
    return (f'A sine of {run.frequency:g} Hz, {run.amplitude:g} of the stroke of '
            f'{stroke * 1e3:g} mm: a period is {period:g} units of L/c = '
            f'{run.time_unit * 1e3:.4g} ms. Above the whole run, below its first '
            f'{PERIODS_IN_DETAIL:g} periods.')


def figure_5b(figure, case: Case) -> str:
    """Draw velocity at all twelve stations."""
    return _draw_all(figure, case, VELOCITY)


def figure_5c(figure, case: Case) -> str:
    """Draw pressure at all twelve stations."""
    return _draw_all(figure, case, PRESSURE)


def _draw_short(figure, case: Case, units: float) -> str:
    run = case.run()
    count = int(np.searchsorted(run.tau, units, side='right'))
    values, tau = VELOCITY.stations(run)[:count], run.tau[:count]
    panels = figure.subplots(1, 2, sharex=True, sharey=True)
    for side, axes in enumerate(panels):
        letters = STATIONS[6 * side:6 * side + 6]
        for letter in letters:
            axes.plot(tau, values[:, run.station(letter)], label=letter, linewidth=1.3,
                      **station_line(letter))
        axes.set(xlabel=TAU_LABEL, xlim=(0.0, tau[-1]))
        axes.grid(True)
        axes.set_title('pump to piston' if side == 0 else 'piston to tank', fontsize=9)
        axes.legend(loc='upper left', ncols=3, **LEGEND)
    panels[0].set_ylabel(VELOCITY.label)
    # Room for the legends.
    low, high = panels[0].get_ylim()
    panels[0].set_ylim(low, high + 0.16 * (high - low))
    si_right(panels[1], run.velocity_unit, 'velocity [m/s]')
    words = ''
    if units <= ARRIVALS_SHOWN:
        _draw_arrivals(panels, run)
        words = (' Dotted: when a wave from the opening valve arrives at a station, its distance '
                 'over c.')
    return (f'The first {units:g} units, {units * run.time_unit * 1e3:.3g} ms, '
            f'{count} steps, each drawn; {VELOCITY.unit_in_words(run)}.{words}')


def _draw_arrivals(panels, run: Run) -> None:
    """Draw when the first wave from the valve arrives at the stations, by distance over c."""
    places = dict(zip(STATIONS, run.station_places))
    for axes, valve, letters in ((panels[0], 'A', 'CEO'), (panels[1], 'J', 'HFK')):
        for letter in letters:
            delay = abs(places[letter] - places[valve])
            axes.axvline(delay, color=station_line(letter)['color'], linewidth=1.0,
                         linestyle=':')
            axes.annotate(letter, (delay, 0.0), xycoords=('data', 'axes fraction'), fontsize=8,
                          xytext=(2, 3), textcoords='offset points')


def figure_5d(figure, case: Case) -> str:
    """Draw velocities in the first unit and a half."""
    return _draw_short(figure, case, SHORT_WINDOWS['5d'])


def figure_5e(figure, case: Case) -> str:
    """Draw velocities in the first five units."""
    return _draw_short(figure, case, SHORT_WINDOWS['5e'])


def figure_5f(figure, case: Case) -> str:
    """Draw velocities in the first twenty units."""
    return _draw_short(figure, case, SHORT_WINDOWS['5f'])


