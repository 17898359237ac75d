# SPDX-License-Identifier: Apache-2.0
"""
The lowest and the highest pressure and velocity of a run at every place of the streamline.

Within the stroke a place belongs to the chamber that covers it; both count.
"""

from hydra_actuator.analysis import streamline
from hydra_actuator.analysis.figure import Figure, rows_layout
from hydra_actuator.analysis.figure_fields import COLUMNS, origin, QUANTITIES, x_axis
from hydra_actuator.analysis.palette import BLUE, ORANGE
from hydra_actuator.analysis.series import Field
from hydra_actuator.analysis.units import SI, Units
import numpy as np

STYLES = {'highest': {'color': ORANGE}, 'lowest': {'color': BLUE}}


def ranges(field: Field, stations: Field | None, units: Units = SI) -> Figure:
    """Return the lowest and the highest pressure and velocity of the run along the streamline."""
    grid = np.linspace(field.positions.min(), field.positions.max(), 2 * COLUMNS)
    traces = []
    for row, quantity in enumerate(QUANTITIES):
        scale = getattr(units, quantity)
        panel = {'xaxis': 'x', 'yaxis': f'y{row + 1}' if row else 'y', 'showlegend': row == 0}
        for word, style in STYLES.items():
            common = {
                'type': 'scatter', 'legendgroup': word, **panel,
                'hovertemplate': f'x %{{x:.3f}}: %{{y:.3f}} {scale.unit}<extra>{word}</extra>',
            }
            traces.append({
                **common, 'mode': 'lines', 'name': f'{word} of {field.source}', 'line': style,
                'x': units.place(grid).astype(np.float32),
                'y': np.asarray(scale(_extreme(field, quantity, word, grid)), np.float32),
            })
            if stations is not None:
                x, y = _station_extremes(stations, quantity, word)
                traces.append({
                    **common, 'mode': 'markers', 'name': f'{word} of the stations',
                    'x': units.place(x), 'y': scale(y), 'marker': style, 'cliponaxis': False,
                })
    layout = rows_layout([getattr(units, quantity).label(quantity) for quantity in QUANTITIES])
    layout['xaxis'].update(x_axis(streamline.boundaries(field), units))
    dots = '' if stations is None else f' Dots: {origin(stations)}, less the moving ones.'
    return Figure(
        'ranges', 'Range along the streamline',
        f'Extremes of the whole run, from {origin(field)}.{dots}', traces, layout, height=480,
    )


def _extreme(field: Field, quantity: str, word: str, grid: np.ndarray) -> np.ndarray:
    """Return the highest or lowest value of the run on a grid of x [m]."""
    _, lowest, highest = field.extremes(quantity, 1)
    part = highest if word == 'highest' else lowest
    return streamline.extremes_on_even_grid(field, part, grid, highest=word == 'highest')[0]


def _station_extremes(stations: Field, quantity: str, word: str) -> tuple:
    """Return x [m] and the extreme of each station that does not move with the piston."""
    still = ~np.isin(np.arange(len(stations.positions)), stations.faces or ())
    choose = np.fmax if word == 'highest' else np.fmin
    columns = getattr(stations, quantity).T
    extremes = np.array([choose.reduce(columns[k]) for k in np.flatnonzero(still)], np.float32)
    return stations.positions[still].astype(np.float32), extremes
