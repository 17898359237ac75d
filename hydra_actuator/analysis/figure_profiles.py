# SPDX-License-Identifier: Apache-2.0
"""
Pressure and velocity along the streamline at instants.

A frame of the field is the state at its instant; the frame nearest to a chosen one is taken. The
two faces of the piston are where they were then, and what it has left behind is not drawn.
"""

from collections.abc import Sequence

from hydra_actuator.analysis import streamline
from hydra_actuator.analysis.figure import Figure, MILLI, rows_layout
from hydra_actuator.analysis.figure_fields import origin, QUANTITIES, span, x_axis
from hydra_actuator.analysis.palette import BLUE, sequence
from hydra_actuator.analysis.series import Field, Series
from hydra_actuator.analysis.units import SI, Units
from hydra_actuator.analysis.window import Window
import numpy as np

INSTANTS = 6            # where none are chosen
SLIDER_FRAMES = 60
FRAME_TIME = 80         # [ms] of each while it plays
TITLE = 'Along the streamline'


def at_instants(series: Series, field: Field, shown: Window, instants: Sequence[float] = (),
                units: Units = SI) -> Figure:
    """Return the distribution at instants [s], by default at some over the part shown."""
    chosen = instants or _spread(shown)
    frames = [int(np.abs(field.time - t).argmin()) for t in chosen]
    colours = sequence(len(frames))
    traces = []
    for frame, colour in zip(frames, colours):
        traces += _profile(series, field, frame, units, colour)
    return Figure('streamline', TITLE, f'From {origin(field)}.', traces, _layout(field, units),
                  height=560)


def over_time(series: Series, field: Field, shown: Window, units: Units = SI) -> Figure:
    """Return the distribution at one instant at a time, chosen by a slider."""
    within = np.arange(*np.searchsorted(field.time, [shown.start - 1e-9, shown.end + 1e-9]))
    frames = within[::max(1, -(-len(within) // SLIDER_FRAMES))]
    if not len(frames):
        return Figure.absent('streamline', TITLE, 'no frame lies in the part shown')
    moving = [{'name': str(place), 'data': _profile(series, field, int(frame), units, BLUE,
                                                    showlegend=False)}
              for place, frame in enumerate(frames)]
    layout = _layout(field, units)
    # The same axes for all instants: what moves is the oil.
    for axis, quantity in zip(('yaxis', 'yaxis2'), QUANTITIES):
        values = getattr(units, quantity)(getattr(field, quantity)[within])
        low, high = float(np.nanmin(values)), float(np.nanmax(values))
        margin = 0.05 * max(high - low, 0.02 * max(abs(low), abs(high)), 1e-9)
        layout[axis]['range'] = [low - margin, high + margin]
    layout['sliders'] = [{
        'pad': {'t': 44, 'r': 30}, 'currentvalue': {'prefix': 'time: '}, 'steps': [
            {'label': _moment(field.time[frame], units), 'method': 'animate',
             'args': [[str(place)], _motion(0)]}
            for place, frame in enumerate(frames)],
    }]
    layout['updatemenus'] = [{
        'type': 'buttons', 'direction': 'right', 'x': 0, 'xanchor': 'left', 'y': 1.02,
        'yanchor': 'bottom', 'showactive': False, 'buttons': [
            {'label': '\u25b6 Play', 'method': 'animate',
             'args': [None, {**_motion(FRAME_TIME), 'fromcurrent': True}]},
            {'label': '\u275a\u275a Pause', 'method': 'animate', 'args': [[None], _motion(0)]},
        ],
    }]
    return Figure('streamline', TITLE,
                  f'{span(shown)}, from {origin(field)}. The slider chooses the instant, Play '
                  'runs through them.', list(moving[0]['data']), layout, height=600, frames=moving)


def _motion(duration: int) -> dict:
    """Return how a frame is shown: at once, for a time [ms]."""
    return {'mode': 'immediate', 'transition': {'duration': 0},
            'frame': {'duration': duration, 'redraw': False}}


def _spread(shown: Window) -> np.ndarray:
    """Return instants [s] over the part shown; over one period, if it has some."""
    if shown.frequency and shown.end - shown.start >= 1.0 / shown.frequency:
        return shown.start + np.arange(INSTANTS) / (INSTANTS * shown.frequency)
    return np.linspace(shown.start, shown.end, INSTANTS)


def _profile(series: Series, field: Field, frame: int, units: Units, colour: str,
             **more) -> list[dict]:
    """Return the two lines of one frame; a jump between two domains is vertical."""
    part = field.at(slice(frame, frame + 1))
    piston = np.interp(part.time, series.time, series.position)
    x = units.place(streamline.node_positions(part, piston)[0])
    name, traces = _moment(float(part.time[0]), units), []
    for row, quantity in enumerate(QUANTITIES):
        scale = getattr(units, quantity)
        traces.append({
            'type': 'scatter', 'mode': 'lines', 'name': name, 'legendgroup': name,
            'x': np.asarray(x, np.float32), 'xaxis': 'x', 'yaxis': 'y2' if row else 'y',
            'y': np.asarray(scale(streamline.gapless(part, getattr(part, quantity))[0]),
                            np.float32),
            'line': {'color': colour, 'width': 1.5}, 'showlegend': row == 0,
            'hovertemplate': f'x %{{x:.3f}}: %{{y:.3f}} {scale.unit}<extra>{name}</extra>',
            **more,
        })
    return traces


def _moment(time: float, units: Units) -> str:
    """Return an instant in words."""
    if units.time.unit:
        return f'{time * MILLI:.2f} ms'
    return f'{float(units.time(time)):.3f} L/c'


def _layout(field: Field, units: Units) -> dict:
    layout = rows_layout([getattr(units, quantity).label(quantity) for quantity in QUANTITIES])
    layout['xaxis'].update(x_axis(streamline.boundaries(field), units))
    return layout
