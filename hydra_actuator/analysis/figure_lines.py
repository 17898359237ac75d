# SPDX-License-Identifier: Apache-2.0
"""Lines over time: pressures and velocities of the sections; piston, spool and commands."""

from hydra_actuator.analysis.decimation import line_samples
from hydra_actuator.analysis.figure import Figure, MEGAPASCAL, MILLI, rows_layout
from hydra_actuator.analysis.palette import BLUE, GREEN, line_style, ORANGE, PURPLE, SKY, VERMILION
from hydra_actuator.analysis.series import Command, Series
from hydra_actuator.analysis.window import Window
import numpy as np

SECTION_POINTS = 12_000      # of one line; a run of 10 s at 1 kHz is shown whole
PISTON_POINTS = 20_000


class Lines:
    """Traces over time that share one time axis, decimated alike, full from the shown window."""

    def __init__(self, time: np.ndarray, shown: Window, points: int):
        self._time = time
        self._points = points
        self._full_from = int(np.searchsorted(time, shown.start))
        self._whole = np.asarray(time, np.float64)
        self.traces: list[dict] = []

    def add(self, name: str, values: np.ndarray, row: int, unit: str, line: dict, **more) -> None:
        """Append one line in panel `row` (0 is the top one); instants without a value go."""
        known = np.flatnonzero(np.isfinite(values))
        full_from = int(np.searchsorted(known, self._full_from))
        kept = known[line_samples(values[known], self._points, full_from)]
        every = len(kept) == len(self._time)
        self.traces.append({
            'type': 'scatter', 'mode': 'lines', 'name': name,
            'x': self._whole if every else self._whole[kept],
            'y': np.asarray(values[kept], np.float32),
            'line': {'width': 1.5, **line}, 'xaxis': 'x',
            'yaxis': f'y{row + 1}' if row else 'y',
            'hovertemplate': f'%{{x:.4f}} s: %{{y:.4g}} {unit}<extra>{name}</extra>', **more,
        })


def sections(series: Series, shown: Window) -> Figure:
    """Return pressures and velocities of all sections over time."""
    if not series.section_names:
        return Figure.absent('sections', 'Sections over time', 'the recording has no sections')
    lines = Lines(series.time, shown, SECTION_POINTS)
    velocities = series.flow_velocity.shape[1] == len(series.section_names)
    for k, name in enumerate(series.section_names):
        style = line_style(name, k)
        lines.add(name, series.pressure[:, k] * MEGAPASCAL, 0, 'MPa', style, legendgroup=name)
        if velocities:
            lines.add(name, series.flow_velocity[:, k], 1, 'm/s', style, legendgroup=name,
                      showlegend=False)
    titles = ['pressure [MPa abs]'] + ['velocity [m/s]'] * velocities
    layout = rows_layout(titles)
    layout['xaxis']['range'] = [shown.start, shown.end]
    return Figure(
        'sections', 'Sections over time',
        'The two ends of one domain share a colour. Click a letter to hide it, double-click to '
        'see it alone; double-click the picture for the whole run.',
        lines.traces, layout, height=640, linked=True,
    )


def piston(series: Series, shown: Window) -> Figure:
    """Return position and velocity of the piston, command and spool, and the load if any."""
    lines = Lines(series.time, shown, PISTON_POINTS)
    lines.add('position', series.position * MILLI, 0, 'mm', {'color': BLUE})
    lines.add('velocity', series.velocity, 1, 'm/s', {'color': GREEN})
    titles = ['position [mm]', 'velocity [m/s]', 'spool / stroke [1]']
    stroke = series.parameters.get('valve.stroke') or 1.0
    if stroke == 1.0:
        titles[2] = 'spool [m]'
    _add_commands(lines, series.commands, 'spool_command', shown)
    for k in range(series.spool.shape[1]):
        name = 'spool' if series.spool.shape[1] == 1 else f'spool {k + 1}'
        lines.add(name, series.spool[:, k] / stroke, 2, '', {'color': (VERMILION, PURPLE)[k]})
    if np.any(series.load_force):
        titles.append('load [kN]')
        lines.add('load', series.load_force * 1e-3, 3, 'kN', {'color': PURPLE})
    layout = rows_layout(titles)
    layout['xaxis']['range'] = [shown.start, shown.end]
    return Figure(
        'piston', 'Piston, spool and command',
        'Commands stand at the instant they were received and hold until the next.',
        lines.traces, layout, height=620, linked=True,
    )


def _add_commands(lines: Lines, commands: tuple[Command, ...], name: str, shown: Window) -> None:
    """Append the received spool commands as staircases."""
    colours = (ORANGE, SKY)
    for command in commands:
        if not command.topic.endswith((name, '/commands')) or not len(command.time):
            continue
        steps = Lines(command.time, shown, PISTON_POINTS)
        for k in range(command.values.shape[1]):
            suffix = f' {k + 1}' if command.values.shape[1] > 1 else ''
            steps.add(f'command{suffix}', command.values[:, k], 2, '',
                      {'color': colours[k % 2], 'shape': 'hv'})
        lines.traces.extend(steps.traces)
