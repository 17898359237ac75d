# SPDX-License-Identifier: Apache-2.0
"""Lines over time: pressures and velocities of the sections; piston; spool, commands, load."""

from hydra_actuator.analysis.decimation import line_samples
from hydra_actuator.analysis.figure import Figure, rows_layout
from hydra_actuator.analysis.palette import BLUE, GREEN, line_style, ORANGE, PURPLE, SKY, VERMILION
from hydra_actuator.analysis.series import Command, Series
from hydra_actuator.analysis.units import Scale, SI, Units
from hydra_actuator.analysis.window import Window
import numpy as np

SECTION_POINTS = 12_000      # of one line; a run of 10 s at 1 kHz is shown whole
PISTON_POINTS = 20_000
CLOSE = 0.4                   # share of the whole range
RATIO, KILONEWTON = Scale(1.0, '1'), Scale(1e-3, 'kN')


class Lines:
    """Traces over time that share one time axis, decimated alike, full from the shown window."""

    def __init__(self, time: np.ndarray, shown: Window, points: int, units: Units = SI):
        self._time = time
        self._points = points
        self._full_from = int(np.searchsorted(time, shown.start))
        self._whole = np.asarray(units.time(time), np.float64)
        self._unit = units.time.unit
        self.traces: list[dict] = []

    def add(self, name: str, values: np.ndarray, row: int, scale: Scale, line: dict,
            **more) -> None:
        """Append one line in panel `row` (0 is the top one); instants without a value go."""
        # What is kept is chosen before it is scaled: it is the same in all units.
        known = np.flatnonzero(np.isfinite(values))
        full_from = int(np.searchsorted(known, self._full_from))
        kept = known[line_samples(values[known], self._points, full_from)]
        every = len(kept) == len(self._time)
        unit = '' if scale is RATIO else scale.unit
        self.traces.append({
            'type': 'scatter', 'mode': 'lines', 'name': name,
            'x': self._whole if every else self._whole[kept],
            'y': np.asarray(scale(values[kept]), np.float32),
            'line': {'width': 1.5, **line}, 'xaxis': 'x',
            'yaxis': f'y{row + 1}' if row else 'y',
            'hovertemplate': f'%{{x:.4f}} {self._unit}: %{{y:.4g}} {unit}<extra>{name}</extra>',
            **more,
        })


def over_time(titles: list[str], shown: Window, units: Units, traces: list[dict]) -> dict:
    """
    Return the layout of stacked panels over the run's time, the shown part in view.

    A panel whose lines move far less in that part than in the whole run has a range of its own.
    """
    layout = rows_layout(titles)
    layout['xaxis']['title']['text'] = units.time.label('time')
    layout['xaxis']['range'] = [float(units.time(t)) for t in (shown.start, shown.end)]
    for k in range(len(titles)):
        name = f'y{k + 1}' if k else 'y'
        span = _close_range([t for t in traces if t['yaxis'] == name], layout['xaxis']['range'])
        if span:
            layout[f'yaxis{name[1:]}']['range'] = span
    return layout


def _close_range(traces: list[dict], shown: list[float]) -> list[float] | None:
    """Return the range of lines in the part shown, if it is far less than that of all."""
    parts, wholes = [], []
    for trace in traces:
        first, end = np.searchsorted(trace['x'], shown)
        parts.append(trace['y'][max(first - 1, 0): end + 1])
        wholes.append(trace['y'])
    if not sum(map(len, parts)):
        return None
    part, whole = (np.concatenate(lines) for lines in (parts, wholes))
    low, high = float(part.min()), float(part.max())
    if high - low >= CLOSE * float(np.ptp(whole)) or high == low:
        return None
    margin = 0.06 * (high - low)
    return [low - margin, high + margin]


def sections(series: Series, shown: Window, units: Units = SI) -> Figure:
    """Return pressures and velocities of all sections over time."""
    if not series.section_names:
        return Figure.absent('sections', 'Sections over time', 'the recording has no sections')
    lines = Lines(series.time, shown, SECTION_POINTS, units)
    velocities = series.flow_velocity.shape[1] == len(series.section_names)
    for k, name in enumerate(series.section_names):
        style = line_style(name, k)
        lines.add(name, series.pressure[:, k], 0, units.pressure, style, legendgroup=name)
        if velocities:
            lines.add(name, series.flow_velocity[:, k], 1, units.velocity, style,
                      legendgroup=name, showlegend=False)
    titles = [units.pressure.label('pressure')]
    titles += [units.velocity.label('velocity')] * velocities
    return Figure(
        'sections', 'Sections over time',
        'The two ends of one domain share a colour. Click a letter to hide it, double-click to '
        'see it alone; double-click the picture for the whole run.',
        lines.traces, over_time(titles, shown, units, lines.traces), height=640, linked=True,
    )


def piston(series: Series, shown: Window, units: Units = SI) -> Figure:
    """Return position and velocity of the piston, and the pressures on its two faces."""
    lines = Lines(series.time, shown, PISTON_POINTS, units)
    lines.add('position', series.position, 0, units.travel, {'color': BLUE}, showlegend=False)
    lines.add('velocity', series.velocity, 1, units.velocity, {'color': GREEN}, showlegend=False)
    titles = [units.travel.label('position'), units.velocity.label('velocity')]
    faces = [name for name in 'EF' if name in series.section_names]
    for name, colour in zip(faces, (ORANGE, VERMILION)):
        k = series.section_names.index(name)
        lines.add(f'face {name}', series.pressure[:, k], 2, units.pressure, {'color': colour})
    titles += [units.pressure.label('faces')] * bool(faces)
    return Figure(
        'piston', 'Piston and its two faces', '',
        lines.traces, over_time(titles, shown, units, lines.traces), height=560, linked=True,
    )


def command(series: Series, shown: Window, units: Units = SI) -> Figure:
    """Return received commands and spool displacement over the stroke, and the load if any."""
    lines = Lines(series.time, shown, PISTON_POINTS, units)
    stroke = series.parameters.get('valve.stroke') or 1.0
    titles = ['spool [m]' if stroke == 1.0 else 'spool / stroke [1]']
    _add_commands(lines, series.commands, shown, units)
    for k in range(series.spool.shape[1]):
        name = 'spool' if series.spool.shape[1] == 1 else f'spool {k + 1}'
        lines.add(name, series.spool[:, k] / stroke, 0, RATIO,
                  {'color': (VERMILION, PURPLE)[k]})
    if np.any(series.load_force):
        titles.append(KILONEWTON.label('load'))
        lines.add('load', series.load_force, 1, KILONEWTON, {'color': PURPLE}, showlegend=False)
    return Figure(
        'command', 'Command and spool',
        'Commands stand at the instant they were received and hold until the next.',
        lines.traces, over_time(titles, shown, units, lines.traces),
        height=200 + 160 * len(titles), linked=True,
    )


def _add_commands(lines: Lines, commands: tuple[Command, ...], shown: Window,
                  units: Units) -> None:
    """Append the received spool commands as staircases."""
    colours = (ORANGE, SKY)
    for received in commands:
        if not received.topic.endswith(('spool_command', '/commands')) or not len(received.time):
            continue
        steps = Lines(received.time, shown, PISTON_POINTS, units)
        for k in range(received.values.shape[1]):
            suffix = f' {k + 1}' if received.values.shape[1] > 1 else ''
            steps.add(f'command{suffix}', received.values[:, k], 0, RATIO,
                      {'color': colours[k % 2], 'shape': 'hv'})
        lines.traces.extend(steps.traces)
