# SPDX-License-Identifier: Apache-2.0
"""
Two runs on one time axis, counted from the first record of each, and the first less the second.

What the second run has at other instants is taken linear in time at those of the first; where it
has no record, there is no difference.
"""

from hydra_actuator.analysis import streamline
from hydra_actuator.analysis.figure import Figure
from hydra_actuator.analysis.figure_fields import COLUMNS, heatmap, MAP_FRAMES, map_layout, thinned
from hydra_actuator.analysis.figure_lines import Lines, over_time, PISTON_POINTS
from hydra_actuator.analysis.palette import BLUE, GREEN, ORANGE
from hydra_actuator.analysis.series import Field, Series
from hydra_actuator.analysis.units import SI, Units
from hydra_actuator.analysis.window import Window
import numpy as np

FACES = ('E', 'F')


def comparison(series: Series, other: Series, shown: Window, units: Units = SI) -> list[Figure]:
    """Return the figures that compare two runs: lines, and maps of the difference."""
    return [beside(series, other, shown, units),
            *(difference_map(series, other, shown, quantity, units)
              for quantity in ('pressure', 'velocity'))]


def beside(series: Series, other: Series, shown: Window, units: Units = SI) -> Figure:
    """Return position and pressures on the faces of both runs, and their differences."""
    quantities = [('position', series.position, other.position, units.travel, units.travel)]
    for name in FACES:
        if name in series.section_names and name in other.section_names:
            quantities.append((
                f'pressure {name}', *(one.pressure[:, one.section_names.index(name)]
                                      for one in (series, other)),
                units.pressure, units.pressure_change))
    first, apart = (Lines(series.time, shown, PISTON_POINTS, units) for _ in range(2))
    second = Lines(other.time, shown, PISTON_POINTS, units)
    titles = []
    for name, mine, theirs, scale, change in quantities:
        row, legend = len(titles), not titles
        first.add(series.name, mine, row, scale, {'color': BLUE}, showlegend=legend)
        second.add(other.name, theirs, row, scale, {'color': ORANGE, 'dash': 'dash'},
                   showlegend=legend)
        apart.add('difference', difference(series.time, mine, other.time, theirs), row + 1, change,
                  {'color': GREEN}, showlegend=legend)
        titles += [scale.label(name), change.label('difference')]
    return Figure(
        'comparison', f'{series.name} and {other.name}',
        f'Difference: {series.name} less {other.name}, times from the first record of each.',
        first.traces + second.traces + apart.traces,
        over_time(titles, shown, units, first.traces + second.traces + apart.traces),
        height=100 + 150 * len(titles), linked=True)


def difference(time: np.ndarray, mine: np.ndarray, times: np.ndarray,
               theirs: np.ndarray) -> np.ndarray:
    """Return mine less theirs at `time` [s]; NaN where theirs, at `times`, has no record."""
    return mine - np.interp(time, times, theirs, left=np.nan, right=np.nan)


def difference_map(series: Series, other: Series, shown: Window, quantity: str,
                   units: Units = SI) -> Figure:
    """Return the x-t map of the first run's quantity less the second's."""
    key, title = f'difference_{quantity}', f'{quantity.capitalize()}: the difference'
    # Of both runs alike: a field of nodes differs from one of stations wherever waves are.
    fields = series.field, other.field
    if None in fields:
        fields = streamline.field_of_stations(series), streamline.field_of_stations(other)
    grids = [_on_grid(one, field, shown, quantity)
             for one, field in zip((series, other), fields)]
    if None in grids:
        return Figure.absent(key, title, 'one of the recordings holds neither the field nor '
                             'enough stations in the part shown')
    (time, grid, mine), (times, grid_2, theirs) = grids
    if not np.allclose(grid, grid_2):
        return Figure.absent(key, title, 'the two streamlines differ in length')
    change = np.stack([difference(time, a, times, b) for a, b in zip(mine.T, theirs.T)], axis=1)
    known = np.isfinite(change).all(axis=1)
    if np.sum(known) < 2:
        return Figure.absent(key, title, 'the two recordings share no instants in the part shown')
    scale = units.pressure_change if quantity == 'pressure' else units.velocity
    moment, label = units.since(shown.start)
    trace = heatmap(units.place(grid), moment(time[known]), scale(change[known]), 'velocity',
                    scale)
    trace['name'] = f'difference of {quantity}'
    return Figure(key, title, f'{series.name} less {other.name}.', [trace],
                  map_layout(fields[0], moment(time[known]), label, units), height=480, wide=False)


def _on_grid(series: Series, field: Field | None, shown: Window,
             quantity: str) -> tuple[np.ndarray, np.ndarray, np.ndarray] | None:
    """Return times [s], places [m] and values (frames, places) of a run in a window."""
    if field is None:
        return None
    part = thinned(field.having(quantity).between(shown.start, shown.end), MAP_FRAMES)
    if len(part.time) < 2:
        return None
    grid = np.linspace(field.positions.min(), field.positions.max(), COLUMNS)
    x = streamline.node_positions(part, np.interp(part.time, series.time, series.position))
    values = streamline.gapless(part, getattr(part, quantity))
    return part.time, grid, streamline.on_even_grid(x, values, grid)
