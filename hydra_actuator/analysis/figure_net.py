# SPDX-License-Identifier: Apache-2.0
"""
The net of characteristics of all domains, and the moving piston in it.

Slopes are u + c and u - c with the recorded velocities, linear between frames, and the wave speed
of each domain. Lines start evenly spaced; at the end of its domain each is reflected.
"""

from hydra_actuator.analysis import streamline
from hydra_actuator.analysis.characteristics import family, Net
from hydra_actuator.analysis.figure import Figure
from hydra_actuator.analysis.figure_fields import map_layout, origin
from hydra_actuator.analysis.palette import BLUE, ORANGE, VERMILION
from hydra_actuator.analysis.series import Field, Series
from hydra_actuator.analysis.units import complete, SI, Units
from hydra_actuator.analysis.window import Window
from hydra_actuator.parameters.streamline import wave_speed
import numpy as np

KEY, TITLE = 'net', 'Characteristic net'
SPAN = 0.8              # [L/c], by default
MOST_TRAVELS = 4.0      # L/c: beyond it the net is a solid colour
INSTANTS = 240
SPACING = 1.0 / 25      # of the streamline


def net(series: Series, field: Field, shown: Window, units: Units = SI) -> Figure:
    """
    Return the net over a few travels of a wave from the window's start, with the piston's path.

    Absent where the recording's parameters are missing: they hold the wave speeds.
    """
    if not series.parameters:
        return Figure.absent(KEY, TITLE, 'the recording holds no parameters, thus no wave speed')
    if len(field.time) < 2:
        return Figure.absent(KEY, TITLE, 'the velocity was recorded at fewer than two instants')
    travel = float(np.ptp(field.positions)) / wave_speed(complete(series))
    end = min(shown.end, shown.start + MOST_TRAVELS * travel)
    time = np.linspace(shown.start, end, INSTANTS)
    near = field.between(shown.start - field.interval, end + field.interval)
    x, velocity = _at(series, near, time)
    moment, label = units.since(shown.start)
    traces = []
    labels, spacing = np.array(field.labels), SPACING * float(np.ptp(field.positions))
    for domain in dict.fromkeys(field.labels):
        inside = np.flatnonzero(labels == domain)
        lines = Net(time, x[:, inside], velocity[:, inside], _speed(series, domain), substeps=4)
        places, ways = lines.lines(spacing)
        traces += [_family(units.place(family(places, ways, sign)), moment(lines.time), sign)
                   for sign in (1.0, -1.0)]
    if field.faces is not None:
        traces.append({'type': 'scatter', 'mode': 'lines', 'name': 'piston', 'y': moment(time),
                       'x': units.place(x[:, field.faces[0]]), 'hoverinfo': 'skip',
                       'line': {'color': VERMILION, 'width': 3}})
    named = set()
    for trace in traces:
        trace['showlegend'] = trace['name'] not in named
        named.add(trace['name'])
    layout = map_layout(field, moment(time), label, units)
    layout['legend'] = {'orientation': 'h', 'x': 0, 'y': 1.01, 'yanchor': 'bottom'}
    return Figure(
        KEY, TITLE, f'From t = {shown.start:.4f} s; slopes by the velocities of {origin(field)} '
        'and the wave speed of each domain.', traces, layout, height=520)


def net_window(series: Series, field: Field, shown: Window) -> Window:
    """Return the default window of the net, from the start of the part shown."""
    speed = wave_speed(complete(series))
    return Window(shown.start, shown.start + SPAN * float(np.ptp(field.positions)) / speed,
                  shown.frequency)


def _at(series: Series, field: Field, time: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return x [m] and gapless velocity [m/s] of all nodes at times [s] between frames."""
    gapless = streamline.gapless(field, field.velocity)
    velocity = np.stack([np.interp(time, field.time, node) for node in gapless.T], axis=1)
    piston = np.interp(time, series.time, series.position)
    between = Field(time, field.positions, field.labels, velocity, velocity, field.faces, '')
    return streamline.node_positions(between, piston), velocity


def _speed(series: Series, domain: str) -> float:
    """Return the wave speed [m/s] of a domain; the walls of chambers are rigid."""
    return wave_speed(complete(series), '' if 'chamber' in domain else domain)


def _family(x: np.ndarray, time: np.ndarray, sign: float) -> dict:
    """Return all lines of one family as one trace, NaN between them."""
    gap = np.full((1, x.shape[1]), np.nan)
    return {
        'type': 'scatter', 'mode': 'lines', 'name': 'u + c' if sign > 0 else 'u - c',
        'x': np.concatenate((x, gap)).T.ravel().astype(np.float32),
        'y': np.tile(np.append(time, np.nan), x.shape[1]),
        'line': {'color': BLUE if sign > 0 else ORANGE, 'width': 0.8}, 'hoverinfo': 'skip',
    }
