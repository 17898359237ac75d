# SPDX-License-Identifier: Apache-2.0
"""
Pressure and velocity over streamline and time: surfaces, maps in which waves are lines, ranges.

In a map x runs from pump to tank and time upwards: a wave is a line of slope 1/c, a moving
piston the line between the two chambers.
"""

from hydra_actuator.analysis import streamline
from hydra_actuator.analysis.decimation import bucket_extremes
from hydra_actuator.analysis.figure import Figure, MEGAPASCAL, MILLI, rows_layout
from hydra_actuator.analysis.palette import BLUE, ORANGE, PRESSURE_SCALE, VELOCITY_SCALE
from hydra_actuator.analysis.series import Field, Series
from hydra_actuator.analysis.window import Window
import numpy as np

SURFACE_FRAMES, MAP_FRAMES, COLUMNS = 160, 420, 360

QUANTITIES = {
    'pressure': ('pressure', 'MPa abs', MEGAPASCAL),
    'velocity': ('velocity', 'm/s', 1.0),
}


def thinned(field: Field, frames: int) -> Field:
    """Return every n-th frame, so that no more than `frames` are left."""
    step = max(1, -(-len(field.time) // frames))
    return Field(
        field.time[::step], field.positions, field.labels, field.pressure[::step],
        field.velocity[::step], field.faces, field.source,
    )


def surface(series: Series, field: Field, shown: Window, quantity: str) -> Figure:
    """Return the surface of 'pressure' or 'velocity' over streamline and time."""
    name, unit, scale = QUANTITIES[quantity]
    part = thinned(field.between(shown.start, shown.end), SURFACE_FRAMES)
    piston = np.interp(part.time, series.time, series.position)
    values = streamline.gapless(part, getattr(part, quantity)) * scale
    time = (part.time - shown.start) * MILLI
    ends = streamline.boundaries(field)
    trace = {
        'type': 'surface', 'name': name, 'x': streamline.node_positions(part, piston),
        'y': np.tile(time[:, None], (1, values.shape[1])), 'z': values,
        'colorbar': _bar(name, unit), 'connectgaps': True,
        'hovertemplate': f'x %{{x:.3f}} m<br>%{{y:.2f}} ms<br>%{{z:.3f}} {unit}<extra></extra>',
        'lighting': {'ambient': 0.75, 'diffuse': 0.5, 'specular': 0.1, 'roughness': 0.9},
        'contours': {'x': {'highlight': False}, 'z': {'highlight': False}},
        **_surface_colours(quantity, values),
    }
    scene = {
        'aspectmode': 'manual', 'aspectratio': {'x': 1.5, 'y': 1.2, 'z': 0.75},
        'camera': {'eye': {'x': 1.35, 'y': -1.95, 'z': 0.9}, 'center': {'x': 0.08, 'z': -0.1}},
        'domain': {'x': [0.0, 0.94]},
        'xaxis': {'title': {'text': 'x: pump to tank'}, 'tickvals': [x for x, _ in ends],
                  'ticktext': [letters for _, letters in ends]},
        'yaxis': {'title': {'text': 'time [ms]'}},
        'zaxis': {'title': {'text': f'{name} [{unit}]'}},
    }
    return Figure(
        f'surface_{quantity}', f'{name.capitalize()} over streamline and time',
        f'{_span(shown)}, from {_origin(part)}. Drag to turn, double-click to reset.',
        [trace], {'scene': scene}, height=520, wide=False,
    )


def wave_map(series: Series, field: Field, shown: Window, quantity: str) -> Figure:
    """Return the x-t map of 'pressure' or 'velocity' in a window, with the piston's path."""
    name, unit, scale = QUANTITIES[quantity]
    part = thinned(field.between(shown.start, shown.end), MAP_FRAMES)
    piston = np.interp(part.time, series.time, series.position)
    x = streamline.node_positions(part, piston)
    grid = np.linspace(field.positions.min(), field.positions.max(), COLUMNS)
    values = streamline.on_even_grid(
        x, streamline.gapless(part, getattr(part, quantity)), grid,
    ) * scale
    time = (part.time - shown.start) * MILLI
    traces = [_heatmap(grid, time, values, quantity)]
    if field.faces is not None:
        traces.append({
            'type': 'scatter', 'mode': 'lines', 'name': 'piston', 'x': x[:, field.faces[0]],
            'y': time, 'line': {'color': '#ffffff' if quantity == 'pressure' else '#222222',
                                'width': 1.5, 'dash': 'dot'},
            'hoverinfo': 'skip', 'showlegend': False,
        })
    return Figure(
        f'map_{quantity}', f'{name.capitalize()}: x-t map',
        f'{_span(shown)}, from {_origin(part)}. Dotted: the piston.',
        traces, _map_layout(field, time, 'time [ms]'), height=520, wide=False,
    )


def whole_run_map(field: Field, quantity: str) -> Figure:
    """Return the map of the whole run: the highest or the lowest value of every bucket of time."""
    name, unit, scale = QUANTITIES[quantity]
    starts, lowest, highest = bucket_extremes(getattr(field, quantity), MAP_FRAMES // 2)
    grid = np.linspace(field.positions.min(), field.positions.max(), COLUMNS)
    maps = [
        streamline.extremes_on_even_grid(field, part, grid, highest=high) * scale
        for part, high in ((highest, True), (lowest, False))
    ]
    traces = [_heatmap(grid, field.time[starts], values, quantity) for values in maps]
    for k, trace in enumerate(traces):
        trace.update(_shared_range(maps, quantity), visible=k == 0)
    layout = _map_layout(field, field.time[starts], 'time [s]')
    layout['updatemenus'] = [{
        'type': 'buttons', 'direction': 'right', 'x': 0, 'xanchor': 'left', 'y': 1.02,
        'yanchor': 'bottom', 'showactive': True, 'buttons': [
            {'label': f'{word} in each row', 'method': 'restyle',
             'args': [{'visible': [word == 'highest', word == 'lowest']}]}
            for word in ('highest', 'lowest')
        ],
    }]
    seconds = (field.time[-1] - field.time[0]) / max(len(starts), 1)
    return Figure(
        f'whole_{quantity}', f'{name.capitalize()} over the whole run',
        f'Each row of the map holds {seconds * MILLI:.3g} ms of {field.source} and shows the '
        'extreme in it: no peak is averaged away.',
        traces, layout, height=380, wide=False,
    )


def ranges(field: Field, stations: Field | None) -> Figure:
    """Return the lowest and the highest pressure and velocity of the run along the streamline."""
    grid = np.linspace(field.positions.min(), field.positions.max(), 2 * COLUMNS)
    traces = []
    for row, (quantity, (name, unit, scale)) in enumerate(QUANTITIES.items()):
        panel = {'xaxis': 'x', 'yaxis': f'y{row + 1}' if row else 'y', 'showlegend': row == 0}
        for word, style in _RANGE_STYLES.items():
            traces.append({
                'type': 'scatter', 'mode': 'lines', 'name': f'{word} of {field.source}',
                'x': np.asarray(grid, np.float32), 'line': style, 'legendgroup': word,
                'y': np.asarray(_extreme(field, quantity, word, grid) * scale, np.float32),
                'hovertemplate': f'x %{{x:.3f}} m: %{{y:.3f}} {unit}<extra>{word} {name}</extra>',
                **panel,
            })
            if stations is not None:
                choose = np.fmax if word == 'highest' else np.fmin
                traces.append({
                    'type': 'scatter', 'mode': 'markers', 'name': f'{word} of {stations.source}',
                    'x': np.asarray(stations.positions, np.float32), 'marker': style,
                    'cliponaxis': False,
                    'y': np.asarray(choose.reduce(getattr(stations, quantity)) * scale,
                                    np.float32), 'legendgroup': word, **panel,
                })
    layout = rows_layout(['pressure [MPa abs]', 'velocity [m/s]'])
    layout['xaxis'].update(_x_axis(streamline.boundaries(field)))
    return Figure(
        'ranges', 'Range along the streamline',
        f'Extremes of the whole run, from {_origin(field)}; dots: the stations, which are '
        'recorded more often. Those of the piston faces stand at mid-stroke.',
        traces, layout, height=480,
    )


_RANGE_STYLES = {'highest': {'color': ORANGE}, 'lowest': {'color': BLUE}}


def _extreme(field: Field, quantity: str, word: str, grid: np.ndarray) -> np.ndarray:
    """Return the highest or lowest value of the run on a grid of x [m]."""
    _, lowest, highest = bucket_extremes(getattr(field, quantity), 1)
    part = highest if word == 'highest' else lowest
    return streamline.extremes_on_even_grid(field, part, grid, highest=word == 'highest')[0]


def _bar(name: str, unit: str) -> dict:
    """Return the colour bar of a map or a surface."""
    return {'title': {'text': unit}, 'thickness': 12, 'len': 0.8, 'outlinewidth': 0}


def _shared_range(maps: list[np.ndarray], quantity: str) -> dict:
    """Return one colour range for several maps; that of a velocity is symmetric about zero."""
    low, high = (float(f([f(m[np.isfinite(m)], initial=0.0) if quantity == 'velocity'
                          else f(m[np.isfinite(m)]) for m in maps])) for f in (np.min, np.max))
    if quantity == 'velocity':
        low, high = -max(-low, high), max(-low, high)
    return {'zmin': low, 'zmax': high}


def _surface_colours(quantity: str, values: np.ndarray) -> dict:
    """Return scale and range of a surface's colours."""
    limits = _shared_range([values], quantity)
    return {
        'colorscale': PRESSURE_SCALE if quantity == 'pressure' else VELOCITY_SCALE,
        'cmin': limits['zmin'], 'cmax': limits['zmax'],
    }


def _heatmap(grid: np.ndarray, time: np.ndarray, values: np.ndarray, quantity: str) -> dict:
    """Return a heat map trace of (frames, columns) values."""
    name, unit, _ = QUANTITIES[quantity]
    return {
        'type': 'heatmap', 'name': name, 'x': np.asarray(grid, np.float32), 'y': time,
        'z': values, 'zsmooth': 'fast' if len(time) > MAP_FRAMES // 2 else 'best',
        'colorscale': PRESSURE_SCALE if quantity == 'pressure' else VELOCITY_SCALE,
        'colorbar': _bar(name, unit), **_shared_range([values], quantity),
        'hovertemplate': f'x %{{x:.3f}} m<br>t %{{y:.4g}}<br>%{{z:.3f}} {unit}<extra></extra>',
    }


def _x_axis(ends: list[tuple[float, str]]) -> dict:
    """Return the x axis of a map: station letters and metres at the ends of the domains."""
    return {
        'title': {'text': 'x: pump to tank [m]'},
        'range': [ends[0][0], ends[-1][0]],
        'tickvals': [x for x, _ in ends],
        'ticktext': [f'{letters}<br>{x:.4g}' for x, letters in ends],
    }


def _map_layout(field: Field, time: np.ndarray, time_title: str) -> dict:
    """Return the layout of a map."""
    return {
        'xaxis': {**_x_axis(streamline.boundaries(field)), 'showgrid': False},
        'yaxis': {'title': {'text': time_title}, 'range': [float(time[0]), float(time[-1])],
                  'showgrid': False},
    }


def _span(shown: Window) -> str:
    """Return what part of the run is shown, in words."""
    length = (shown.end - shown.start) * MILLI
    periods = f' of a {shown.frequency:.4g} Hz motion' if shown.frequency else ''
    return f'{length:.3g} ms{periods}, from t = {shown.start:.4f} s'


def _origin(field: Field) -> str:
    """Return where the frames come from and how dense they are, in words."""
    rate = f' at {1 / field.interval:.4g} Hz' if np.isfinite(field.interval) else ''
    return f'{field.source}{rate}'
