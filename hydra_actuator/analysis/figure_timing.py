# SPDX-License-Identifier: Apache-2.0
"""Real time over the run: lateness and execution of the ticks, overruns, sending, stamp steps."""

from hydra_actuator.analysis import timing
from hydra_actuator.analysis.decimation import extreme_samples
from hydra_actuator.analysis.figure import Figure, logarithmic, MICRO, rows_layout
from hydra_actuator.analysis.palette import BLUE, GREEN, ORANGE, VERMILION
from hydra_actuator.analysis.series import Series
import numpy as np

BUCKETS = 200
STAMP_POINTS = 8000
_SIMULATED = 'the node ran in simulated time'
_PERCENTILES = {'p50': BLUE, 'p99': ORANGE, 'max': VERMILION}


def real_time(series: Series) -> Figure:
    """Return lateness, execution time and overruns as the node reported them."""
    title = 'Real time: lateness of the ticks'
    reports = timing.real_time_reports(series)
    if not reports:
        return Figure.absent(
            'real_time', title, 'the recording has no real-time statistics of a node',
        )
    if timing.in_simulated_time(series):
        return Figure.absent('real_time', title, _SIMULATED)
    time = np.array([report.time for report in reports])
    values = timing.numeric_values(reports)
    traces, titles = [], []
    for quantity in ('lateness', 'execution'):
        lines = {p: values[f'{quantity}_{p}'] for p in _PERCENTILES if f'{quantity}_{p}' in values}
        if lines:
            titles.append(f'{quantity} [us]')
            # Before the first tick the node reports zeros, which have no place on this axis.
            traces += [_line(p, time, np.where(line > 0, line, np.nan), len(titles), 'us',
                             len(titles) == 1) for p, line in lines.items()]
    for key in ('overruns', 'slip'):
        if np.any(np.nan_to_num(values.get(key, 0.0))) or (key == 'overruns' and key in values):
            titles.append('overruns' if key == 'overruns' else 'slip [s]')
            trace = _line(key, time, values[key], len(titles), '', False)
            traces.append({**trace, 'line': {'color': GREEN, 'shape': 'hv'}})
    layout = rows_layout(titles)
    for k, name in enumerate(titles):
        layout['yaxis' if k == 0 else f'yaxis{k + 1}'].update(
            logarithmic() if name.endswith('[us]') else {'exponentformat': 'none'})
    return Figure(
        'real_time', title, 'As the node reported it in its diagnostics, once a second.',
        traces, layout, height=170 * len(titles) + 120, linked=False,
    )


def sending(series: Series) -> Figure:
    """Return how long after its stamp each state left: percentiles over the run."""
    title = 'Real time: sending the states'
    if not len(series.send_delay):
        return Figure.absent('sending', title, 'the recording has no times of sending')
    if timing.in_simulated_time(series):
        return Figure.absent('sending', title, _SIMULATED)
    time, lines = timing.percentiles_over_time(
        series.time, series.send_delay * MICRO, min(BUCKETS, max(len(series.time) // 100, 1)),
    )
    traces = [_line(name, time, line, 1, 'us', True) for name, line in lines.items()]
    layout = rows_layout(['send time - stamp [us]'])
    layout['yaxis'].update(logarithmic())
    return Figure(
        'sending', title, 'Publish time of joint_states less its stamp.', traces, layout,
        height=320, wide=False,
    )


def stamps(series: Series) -> Figure:
    """Return the deviation of the stamps' steps from the period."""
    title = 'Real time: steps of the stamps'
    steps = timing.stamp_steps(series)
    if steps is None:
        return Figure.absent('stamps', title, 'fewer than two states were recorded')
    kept = extreme_samples(steps.deviation, STAMP_POINTS // 2)
    trace = _line('step', steps.time[kept], steps.deviation[kept] * MICRO, 1, 'us', False)
    trace['line'] = {'color': BLUE, 'width': 1}
    layout = rows_layout(['step - period [us]'])
    layout['yaxis']['exponentformat'] = 'none'
    if np.abs(steps.deviation).max() * MICRO < 1:
        layout['yaxis']['range'] = [-1, 1]
    return Figure(
        'stamps', title, f'Period {steps.period * MICRO:.6g} us. {_about(steps)}', [trace],
        layout, height=320, wide=False,
    )


def _about(steps: timing.StampSteps) -> str:
    """Return in words what the steps say."""
    missing = steps.missing
    if missing:
        return f'Ticks that are missing, or that simulated time slipped by: {missing}.'
    return 'No tick is missing and simulated time never slipped.'


def _line(name: str, time: np.ndarray, values: np.ndarray, row: int, unit: str,
          legend: bool) -> dict:
    """Return one line in panel `row`, counted from 1."""
    return {
        'type': 'scatter', 'mode': 'lines+markers' if len(time) < 40 else 'lines', 'name': name,
        'x': np.asarray(time, np.float64), 'y': np.asarray(values, np.float32), 'xaxis': 'x',
        'yaxis': 'y' if row == 1 else f'y{row}', 'legendgroup': name, 'showlegend': legend,
        'line': {'color': _PERCENTILES.get(name, BLUE)},
        'hovertemplate': f'%{{x:.2f}} s: %{{y:.4g}} {unit}<extra>{name}</extra>',
    }
