# SPDX-License-Identifier: Apache-2.0
"""The pictures of a sweep: parallel coordinates, sensitivities, every figure over every factor."""

from hydra_actuator.analysis.figure import Figure
from hydra_actuator.analysis.palette import (
    BLUE,
    LINES,
    PRESSURE_SCALE,
    VELOCITY_SCALE,
    VERMILION,
)
from hydra_actuator.sweep.results import Column, Results
from hydra_actuator.sweep.sensitivity import FEWEST_RUNS, first_order, rank_correlation
import numpy as np

# What parallel coordinates and scatters show, where it varies.
FOREMOST = ('bandwidth', 'travel', 'peak_velocity', 'peak_pressure', 'lowest_pressure',
            'cavity_volume', 'supply_power')
# Beyond this part of failed runs the rest is no fair sample.
MOST_FAILED = 0.2
ROW_HEIGHT, GAP = 190, 0.04


def foremost(results: Results) -> list[Column]:
    """Return the figures that are shown first."""
    found = {column.name: column for column in results.figures if column.varies}
    return [found[name] for name in FOREMOST if name in found]


def parallel(results: Results) -> Figure:
    """Return the parallel coordinates: a line per run, coloured by the first figure."""
    key, title = 'parallel', 'Runs as lines through factors and figures'
    figures = foremost(results)
    shown = [*results.factors, *figures]
    sound = np.all([np.isfinite(column.values) for column in shown], axis=0)
    if not figures or sound.sum() < 2:
        return Figure.absent(key, title, 'fewer than two runs are done, or all are alike')
    colour = figures[0]
    caption = (f'Each line is a run, coloured by {colour.name}. Draw along an axis to choose runs '
               'by it, drag a name to move its axis.')
    if not sound.all():
        caption += f' {int((~sound).sum())} runs without a finite figure are left out.'
    trace = {
        'type': 'parcoords', 'dimensions': [_dimension(column, sound) for column in shown],
        'line': {'color': colour.values[sound].astype(np.float32), 'colorscale': PRESSURE_SCALE,
                 'showscale': True, 'colorbar': {'title': {'text': colour.label}}},
        'labelangle': -20, 'domain': {'x': [0.03, 0.97], 'y': [0.0, 0.84]}}
    return Figure(key, title, caption, [trace], {}, height=560)


def correlations(results: Results) -> Figure:
    """Return the rank correlations of figures with factors."""
    factors = [c for c in results.factors if len(c.texts) <= 2]
    figures = [c for c in results.figures if c.varies]
    key, title = 'correlation', 'Rank correlation'
    if not factors or not figures or len(results.runs) < 3:
        return Figure.absent(key, title, 'too few runs are done, or no factor has an order')
    values = np.array([[rank_correlation(factor.values, figure.values) for factor in factors]
                       for figure in figures])
    caption = ('Coefficient of Spearman: 1 where the figure rises whenever the factor does, -1 '
               'where it falls, 0 where neither, or both.')
    return _map(key, title, caption, (figures, factors, values), (VELOCITY_SCALE, -1.0))


def sobol_indices(results: Results) -> Figure:
    """Return the first-order Sobol indices, where the runs allow them."""
    key, title = 'sobol', 'Sobol indices of first order'
    figures = [c for c in results.figures if c.varies]
    reason = ''
    if not results.all_ranges:
        reason = 'they need factors that were all drawn from ranges'
    elif len(results.runs) < FEWEST_RUNS:
        reason = f'they need {FEWEST_RUNS} runs, and {len(results.runs)} are done'
    elif len(results.failed) > MOST_FAILED * results.asked:
        reason = f'{len(results.failed)} runs failed, and the rest is no fair sample'
    if reason or not figures:
        return Figure.absent(key, title, reason or 'all runs are alike')
    drawn = np.stack([factor.values for factor in results.factors], axis=1)
    values = np.array([first_order(drawn, figure.values) for figure in figures])
    caption = ('The part of the variance over the ranges that a factor explains alone '
               '(RBD-FAST); what a row leaves to 1 is due to factors together.')
    return _map(key, title, caption, (figures, list(results.factors), values),
                (PRESSURE_SCALE, 0.0))


def scatters(results: Results) -> Figure:
    """Return every foremost figure over every factor."""
    key, title = 'scatter', 'Figures over factors'
    figures = foremost(results)
    if not figures:
        return Figure.absent(key, title, 'fewer than two runs are done, or all are alike')
    traces, layout, columns = [], {'showlegend': False}, len(results.factors)
    for row, figure in enumerate(figures):
        for k, factor in enumerate(results.factors):
            number = row * columns + k + 1
            suffix = '' if number == 1 else str(number)
            traces.append({
                'type': 'scatter', 'mode': 'markers', 'x': factor.values.astype(np.float32),
                'y': figure.values.astype(np.float32), 'xaxis': f'x{suffix}',
                'yaxis': f'y{suffix}', 'marker': {'color': BLUE, 'size': 4, 'opacity': 0.7}})
            x, y = _cell(k, columns), _cell(len(figures) - 1 - row, len(figures))
            layout[f'xaxis{suffix}'] = {
                'domain': x, 'anchor': f'y{suffix}', **_scale(factor),
                **({'title': {'text': factor.label}} if row == len(figures) - 1 else
                   {'showticklabels': False})}
            layout[f'yaxis{suffix}'] = {
                'domain': y, 'anchor': f'x{suffix}',
                **({'title': {'text': figure.label}} if k == 0 else {'showticklabels': False})}
    return Figure(key, title, 'A point is a run.', traces, layout,
                  height=80 + ROW_HEIGHT * len(figures))


def failed_runs(results: Results) -> Figure:
    """Return where in the first two factors runs failed, by kind."""
    key, title = 'failed', 'Runs that failed'
    if not results.failed:
        return Figure.absent(key, title, 'no run failed')
    kinds = {}
    for one in results.failed:
        kinds.setdefault(one.status, []).append(one.run)
    groups = [('done', results.runs.tolist(), BLUE, 'circle'),
              *((kind, runs, colour, 'x') for (kind, runs), colour in
                zip(kinds.items(), (VERMILION, *LINES[1:])))]
    second = min(1, len(results.factors) - 1)
    traces = [{
        'type': 'scatter', 'mode': 'markers', 'name': f'{kind} ({len(runs)})',
        'x': results.samples(0, runs).values.astype(np.float32),
        'y': results.samples(second, runs).values.astype(np.float32),
        'marker': {'color': colour, 'symbol': symbol, 'size': 7}}
        for kind, runs, colour, symbol in groups]
    layout = {f'{axis}axis': {'title': {'text': factor.label}, **_scale(factor)}
              for axis, factor in (('x', results.factors[0]), ('y', results.factors[second]))}
    layout['legend'] = {'orientation': 'h', 'x': 0, 'y': 1.01, 'yanchor': 'bottom'}
    return Figure(key, title, 'Over the first two factors.', traces, layout)


def _dimension(column: Column, sound: np.ndarray) -> dict:
    """Return one axis of the parallel coordinates."""
    values = column.values[sound]
    axis = {'label': column.label}
    if column.texts:
        axis |= {'tickvals': list(range(len(column.texts))), 'ticktext': list(column.texts)}
    elif column.logarithmic:
        ticks = np.geomspace(values.min(), values.max(), 5)
        axis |= {'tickvals': np.log10(ticks).tolist(), 'ticktext': [f'{t:.3g}' for t in ticks]}
        values = np.log10(values)
    return {**axis, 'values': values.astype(np.float32)}


def _map(key: str, title: str, caption: str, content: tuple, scale: tuple) -> Figure:
    """Return a table of numbers in colour: figures down, factors across."""
    figures, factors, values = content
    colours, lowest = scale
    text = [['' if np.isnan(v) else f'{v:.2f}' for v in row] for row in values]
    trace = {
        'type': 'heatmap', 'x': [c.name for c in factors], 'y': [c.name for c in figures],
        'z': [[None if np.isnan(v) else round(float(v), 4) for v in row] for row in values],
        'text': text, 'texttemplate': '%{text}', 'colorscale': colours, 'zmin': lowest,
        'zmax': 1.0, 'xgap': 2, 'ygap': 2, 'hovertemplate': '%{y} by %{x}: %{z}<extra></extra>'}
    layout = {'yaxis': {'autorange': 'reversed', 'showgrid': False},
              'xaxis': {'showgrid': False}}
    return Figure(key, title, caption, [trace], layout, height=120 + 26 * len(figures),
                  wide=False)


def _cell(k: int, count: int) -> list[float]:
    width = (1.0 - GAP * (count - 1)) / count
    start = k * (width + GAP)
    return [start, min(start + width, 1.0)]


def _scale(column: Column) -> dict:
    if column.texts:
        return {'tickvals': list(range(len(column.texts))), 'ticktext': list(column.texts)}
    return {'type': 'log'} if column.logarithmic else {}
