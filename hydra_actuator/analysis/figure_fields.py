# SPDX-License-Identifier: Apache-2.0
"""
Pressure and velocity over streamline and time: surfaces, and maps in which waves are lines.

In a map x runs from pump to tank and time upwards: a wave is a line of slope 1/c, a moving
piston the line between the two chambers.
"""

from hydra_actuator.analysis import streamline
from hydra_actuator.analysis.figure import Figure, MILLI
from hydra_actuator.analysis.palette import INK, PRESSURE_SCALE, VELOCITY_SCALE
from hydra_actuator.analysis.series import Field, Series
from hydra_actuator.analysis.units import Scale, SI, Units
from hydra_actuator.analysis.window import Window
import numpy as np

SURFACE_FRAMES, MAP_FRAMES, WHOLE_RUN_ROWS, COLUMNS = 240, 420, 210, 360

QUANTITIES = ('pressure', 'velocity')


def thinned(field: Field, frames: int) -> Field:
    """Return every n-th frame, so that no more than `frames` are left."""
    return field.at(slice(None, None, max(1, -(-len(field.time) // frames))))


def _unseen(key: str, title: str, quantity: str) -> Figure:
    """Return the place of a figure for which there are too few frames."""
    return Figure.absent(
        key, title, f'the {quantity} was recorded at fewer than two instants of the part shown')


def surface(series: Series, field: Field, shown: Window, quantity: str,
            units: Units = SI) -> Figure:
    """Return the surface of 'pressure' or 'velocity' over streamline and time."""
    scale: Scale = getattr(units, quantity)
    key, title = f'surface_{quantity}', f'{quantity.capitalize()} over streamline and time'
    part = thinned(field.between(shown.start, shown.end), SURFACE_FRAMES)
    if len(part.time) < 2:
        return _unseen(key, title, quantity)
    piston = np.interp(part.time, series.time, series.position)
    values = scale(streamline.gapless(part, getattr(part, quantity)))
    moment, label = units.since(shown.start)
    time = moment(part.time)
    ends = streamline.boundaries(field)
    trace = {
        'type': 'surface', 'name': quantity,
        'x': units.place(streamline.node_positions(part, piston)),
        'y': np.tile(time[:, None], (1, values.shape[1])), 'z': values,
        'showscale': False,
        'hovertemplate': (
            f'x %{{x:.3f}} {units.place.unit}<br>%{{y:.2f}} {moment.unit}<br>'
            f'%{{z:.3f}} {scale.unit}<extra></extra>'),
        'lighting': {'ambient': 0.75, 'diffuse': 0.5, 'specular': 0.1, 'roughness': 0.9},
        'contours': {'x': {'highlight': False}, 'z': {'highlight': False}},
        **_surface_colours(quantity, values),
    }
    scene = {
        'aspectmode': 'manual', 'aspectratio': {'x': 1.5, 'y': 1.2, 'z': 0.75},
        'camera': {'eye': {'x': 1.38, 'y': -2.02, 'z': 1.0}, 'center': {'x': -0.03, 'z': -0.13}},
        'xaxis': {'title': {'text': 'x: pump to tank'},
                  'tickvals': [float(units.place(x)) for x, _ in ends],
                  'ticktext': [letters for _, letters in ends]},
        'yaxis': {'title': {'text': label}},
        'zaxis': {'title': {'text': scale.unit or scale.symbol}},
    }
    return Figure(
        key, title, f'{span(shown)}, from {origin(part)}. Drag to turn, double-click to reset.',
        [trace], {'scene': scene}, height=480, wide=False,
    )


def wave_map(series: Series, field: Field, shown: Window, quantity: str,
             waves: bool = False, units: Units = SI) -> Figure:
    """
    Return the x-t map of 'pressure' or 'velocity' in a window, with the piston's path.

    Two views: the quantity itself, and its difference from the window's mean at each place, in
    which waves stand out; `waves` shows the second one first.
    """
    scale: Scale = getattr(units, quantity)
    key, title = f'map_{quantity}', f'{quantity.capitalize()}: x-t map'
    part = thinned(field.between(shown.start, shown.end), MAP_FRAMES)
    if len(part.time) < 2:
        return _unseen(key, title, quantity)
    x = streamline.node_positions(part, np.interp(part.time, series.time, series.position))
    grid = np.linspace(field.positions.min(), field.positions.max(), COLUMNS)
    values = scale(streamline.on_even_grid(
        x, streamline.gapless(part, getattr(part, quantity)), grid))
    moment, label = units.since(shown.start)
    time = moment(part.time)
    itself = heatmap(units.place(grid), time, values, quantity, scale)
    change = units.pressure_change if quantity == 'pressure' else scale
    difference = heatmap(units.place(grid), time, values - values.mean(axis=0), 'velocity',
                         change)
    itself['visible'], difference['visible'] = not waves, waves
    difference['name'] = f'{quantity} less its mean'
    traces = [itself, difference]
    layout = map_layout(field, time, label, units)
    layout['updatemenus'] = [_choice([f'{quantity} itself', 'less its mean'], int(waves))]
    if field.faces is not None:
        traces.append({
            'type': 'scatter', 'mode': 'lines', 'name': 'piston',
            'x': units.place(x[:, field.faces[0]]), 'y': time,
            'line': {'color': INK, 'width': 1.5, 'dash': 'dot'},
            'hoverinfo': 'skip', 'showlegend': False,
        })
    return Figure(
        key, title, f'{span(shown)}, from {origin(part)}. Dotted: the piston.',
        traces, layout, height=520, wide=False,
    )


def whole_run_map(field: Field, quantity: str, buckets: int = WHOLE_RUN_ROWS,
                  units: Units = SI) -> Figure:
    """Return the map of the whole run: the highest or the lowest value of every bucket of time."""
    scale: Scale = getattr(units, quantity)
    starts, lowest, highest = field.extremes(quantity, buckets)
    grid = np.linspace(field.positions.min(), field.positions.max(), COLUMNS)
    maps = [
        scale(streamline.extremes_on_even_grid(field, part, grid, highest=high))
        for part, high in ((highest, True), (lowest, False))
    ]
    time = units.time(field.time[starts])
    traces = [heatmap(units.place(grid), time, values, quantity, scale) for values in maps]
    for k, trace in enumerate(traces):
        trace.update(_shared_range(maps, quantity), visible=k == 0)
    layout = map_layout(field, time, units.time.label('time'), units)
    layout['updatemenus'] = [_choice(['highest in each row', 'lowest in each row'], 0)]
    seconds = (field.time[-1] - field.time[0]) / max(len(starts), 1)
    return Figure(
        f'whole_{quantity}', f'{quantity.capitalize()} over the whole run',
        f'Each row of the map holds {seconds * MILLI:.3g} ms of {field.source} and shows the '
        'extreme in it: no peak is averaged away.',
        traces, layout, height=400, wide=False,
    )


def _bar(unit: str) -> dict:
    """Return the colour bar of a map or a surface."""
    return {'title': {'text': unit}, 'thickness': 12, 'len': 0.8, 'outlinewidth': 0,
            'exponentformat': 'power'}


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


def heatmap(grid: np.ndarray, time: np.ndarray, values: np.ndarray, quantity: str,
            scale: Scale) -> dict:
    """Return a heat map trace of (frames, columns) values, coloured as a quantity is."""
    return {
        'type': 'heatmap', 'name': quantity, 'x': np.asarray(grid, np.float32), 'y': time,
        'z': values, 'zsmooth': 'fast' if len(time) > MAP_FRAMES // 2 else 'best',
        'colorscale': PRESSURE_SCALE if quantity == 'pressure' else VELOCITY_SCALE,
        'colorbar': _bar(scale.unit or scale.symbol), **_shared_range([values], quantity),
        'hovertemplate': f'x %{{x:.3f}}<br>t %{{y:.4g}}<br>%{{z:.3f}} {scale.unit}<extra></extra>',
    }


def _choice(labels: list[str], active: int) -> dict:
    """Return buttons that show one of the first traces and hide the others."""
    first = list(range(len(labels)))
    return {
        'type': 'buttons', 'direction': 'right', 'x': 0, 'xanchor': 'left', 'y': 1.02,
        'yanchor': 'bottom', 'showactive': True, 'active': active, 'buttons': [
            {'label': label, 'method': 'restyle',
             'args': [{'visible': [k == chosen for k in first]}, first]}
            for chosen, label in enumerate(labels)
        ],
    }


def x_axis(ends: list[tuple[float, str]], units: Units = SI) -> dict:
    """Return the x axis of a map: station letters and places at the ends of the domains."""
    places = [(float(units.place(x)), letters) for x, letters in ends]
    return {
        'title': {'text': units.place.label('x: pump to tank')},
        'range': [places[0][0], places[-1][0]],
        'tickvals': [x for x, _ in places],
        'ticktext': [f'{letters}<br>{x:.3g}' for x, letters in places],
    }


def map_layout(field: Field, time: np.ndarray, time_title: str, units: Units = SI) -> dict:
    """Return the layout of a map."""
    return {
        'xaxis': {**x_axis(streamline.boundaries(field), units), 'showgrid': False},
        'yaxis': {'title': {'text': time_title}, 'range': [float(time[0]), float(time[-1])],
                  'showgrid': False},
    }


def span(shown: Window) -> str:
    """Return what part of the run is shown, in words."""
    length = (shown.end - shown.start) * MILLI
    periods = f' of a {shown.frequency:.4g} Hz motion' if shown.frequency else ''
    return f'{length:.3g} ms{periods}, from t = {shown.start:.4f} s'


def origin(field: Field) -> str:
    """Return where the frames come from and how dense they are, in words."""
    if not np.isfinite(field.interval):
        return field.source
    frequency = 1.0 / field.interval
    rate = f' at {frequency:.0f} Hz' if frequency >= 100.0 else f' at {frequency:.4g} Hz'
    return f'{field.source}{rate}'
