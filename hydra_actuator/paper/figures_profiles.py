# SPDX-License-Identifier: Apache-2.0
"""
Figures 3c, 3e, 3f and 4c to 4f: the piston's two faces, and distributions along the streamline.

3e and 3f show the last moment and, beside it, a quarter of a period before: at 650 units the
command is at full opening, at 640 it is zero. 4c to 4f show the first transient, before and
after waves have crossed the streamline.
"""

from hydra_actuator.analysis import streamline
from hydra_actuator.analysis.palette import BLUE, ORANGE, SKY, VERMILION
from hydra_actuator.analysis.series import Field
from hydra_actuator.channels import STATIONS
from hydra_actuator.paper.canvas import (
    LEGEND,
    mark_vacuum,
    plot_line,
    PRESSURE,
    Quantity,
    si_right,
    si_top,
    station_ticks,
    TAU_LABEL,
    VELOCITY,
)
from hydra_actuator.paper.case import Case
from hydra_actuator.paper.runs import PAPERS_END, Run
import numpy as np

EARLY = (0.05, 0.1, 0.15, 0.2, 0.3, 0.4, 0.6, 0.8)      # [L/c]
LATER = (1.0, 2.0, 3.0, 4.0, 6.0, 8.0, 10.0, 12.0)
LAST_COLOURS = (VERMILION, BLUE, SKY)


def figure_3c(figure, case: Case) -> str:
    """Draw position and pressure of both piston faces."""
    run = case.run()
    place, pressure = figure.subplots(2, 1, sharex=True)
    unit = run.length_unit
    for letter, node, colour, style in zip(
            'EF', run.field.faces, (ORANGE, VERMILION), ({'linewidth': 2.4},
                                                         {'linewidth': 1.0, 'linestyle': '--'})):
        x = (run.field.positions[node] + run.position) / unit
        plot_line(place, run.tau, x, color=colour, label=f'face {letter}', **style)
        plot_line(pressure, run.tau, run.station_pressure[:, run.station(letter)], color=colour,
                  linewidth=0.9, label=f'face {letter}')
    middle = run.field.positions[run.field.faces[0]] / unit
    place.axhline(middle, color='#59636e', linewidth=0.8, linestyle=':')
    place.set_ylabel('position x/L [-]')
    axis = place.secondary_yaxis('right', functions=(
        lambda y: (y - middle) * unit * 1e3, lambda y: y / (unit * 1e3) + middle))
    axis.set_ylabel('from mid-stroke [mm]')
    pressure.set(xlabel=TAU_LABEL, ylabel=PRESSURE.label, xlim=(0.0, run.tau[-1]))
    si_right(pressure, PRESSURE.si_unit(run), 'pressure [MPa]')
    si_top(place, run)
    for axes in (place, pressure):
        axes.grid(True)
        axes.legend(loc='upper right', ncols=2, **LEGEND)
    return f'The two faces share one place: the piston has no thickness here. {_strokes(run)}'


def _strokes(run: Run) -> str:
    """Return the travel of the piston in its first and last period, in words."""
    count = round(1.0 / (run.frequency * run.step_time))
    words = []
    for name, part in (('First', run.position[:count + 1]), ('last', run.position[-count - 1:])):
        # Adding 0.0 takes the sign from a zero.
        low, high = (round(x * 1e3, 2) + 0.0 for x in (part.min(), part.max()))
        words.append(f'{name} period {low:+.2f} to {high:+.2f} mm')
    return '; '.join(words) + '.'


def profile(run: Run, field: Field, quantity: Quantity, tau: float) -> tuple:
    """Return (t c/L, x/L (nodes,), values (nodes,)) of the frame nearest to a time [L/c]."""
    k = int(np.abs(field.time / run.time_unit - tau).argmin())
    frame = Field(field.time[k:k + 1], field.positions, field.labels, field.pressure[k:k + 1],
                  field.velocity[k:k + 1], field.faces, field.source)
    values = streamline.gapless(frame, quantity.field(run, frame))[0]
    return frame.time[0] / run.time_unit, run.positions_of(frame)[0] / run.length_unit, values


def draw_profiles(axes, run: Run, quantity: Quantity, profiles: list, colours) -> None:
    """Draw distributions along the streamline into axes."""
    for (tau, x, values), colour in zip(profiles, colours):
        label = f'{tau:.3g}' if tau < 10.0 else f'{tau:.4g}'
        axes.plot(x, values, color=colour, linewidth=1.4, label=label)
    axes.set_ylabel(quantity.label)
    station_ticks(axes, run)
    axes.grid(True)
    si_right(axes, quantity.si_unit(run), f'{quantity.name} [{quantity.si_label}]')
    axes.legend(title='t c/L', loc='center left', bbox_to_anchor=(1.12, 0.5), title_fontsize=8,
                **LEGEND)
    if not quantity.velocity:
        mark_vacuum(axes, run)


def _draw_last(figure, case: Case, quantity: Quantity) -> str:
    run = case.run()
    quarter = 0.25 / (run.frequency * run.time_unit)
    last = run.tau[-1]
    instants = [last, last - quarter] + ([PAPERS_END] if last > PAPERS_END else [])
    profiles = [profile(run, run.moments, quantity, tau) for tau in instants]
    axes = figure.subplots()
    draw_profiles(axes, run, quantity, profiles, LAST_COLOURS)
    words = [f'{tau:.4g} units: {_outer_words(run, quantity, values)}'
             for tau, _, values in profiles]
    return f'{quantity.unit_in_words(run)}. At {"; at ".join(words)}.'


def _outer_words(run: Run, quantity: Quantity, values: np.ndarray) -> str:
    """Return what matters of one distribution in words: extremes, or the drops at the edges."""
    if quantity.velocity:
        return f'largest |u| {np.abs(values).max() * run.velocity_unit:.3g} m/s'
    ends = {}
    for k, letter in enumerate(STATIONS):
        nodes = np.flatnonzero(np.array(run.field.labels) == streamline.DOMAINS[k // 2])
        ends[letter] = values[nodes[-1 if k % 2 else 0]] * run.pressure_unit / 1e6
    return (f'edge drops {abs(ends["A"] - ends["B"]):.3f} MPa at A|B and '
            f'{abs(ends["I"] - ends["J"]):.3f} MPa at I|J')



def _draw_sequence(figure, case: Case, quantity: Quantity, instants: tuple) -> str:
    from matplotlib import colormaps

    run = case.run()
    longest = run.first.time[-1] / run.time_unit
    profiles = [profile(run, run.first, quantity, tau) for tau in instants if tau <= longest + 0.1]
    axes = figure.subplots()
    shades = colormaps['plasma'](np.linspace(0.0, 0.86, len(profiles)))
    draw_profiles(axes, run, quantity, profiles, shades)
    unit = run.time_unit * 1e3
    return (f'From {profiles[0][0]:.3g} to {profiles[-1][0]:.3g} units, '
            f'{profiles[0][0] * unit:.3g} to {profiles[-1][0] * unit:.3g} ms; '
            f'{quantity.unit_in_words(run)}. A quasi-static model has straight level lines within '
            'each domain from the first instant.')


def figure_3e(figure, case: Case) -> str:
    """Draw the velocity along the streamline at the last moment."""
    return _draw_last(figure, case, VELOCITY)


def figure_3f(figure, case: Case) -> str:
    """Draw the pressure along the streamline at the last moment."""
    return _draw_last(figure, case, PRESSURE)


def figure_4c(figure, case: Case) -> str:
    """Draw velocities along the streamline while the first waves spread."""
    return _draw_sequence(figure, case, VELOCITY, EARLY)


def figure_4d(figure, case: Case) -> str:
    """Draw pressures along the streamline while the first waves spread."""
    return _draw_sequence(figure, case, PRESSURE, EARLY)


def figure_4e(figure, case: Case) -> str:
    """Draw velocities along the streamline after the first waves have crossed it."""
    return _draw_sequence(figure, case, VELOCITY, LATER)


def figure_4f(figure, case: Case) -> str:
    """Draw pressures along the streamline after the first waves have crossed it."""
    return _draw_sequence(figure, case, PRESSURE, LATER)
