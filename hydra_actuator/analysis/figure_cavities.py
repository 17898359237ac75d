# SPDX-License-Identifier: Apache-2.0
"""Cavities over time, and maps of where the oil boils; nothing for a run without cavitation."""

from hydra_actuator.analysis import boiling, streamline
from hydra_actuator.analysis.figure import Figure, MILLI
from hydra_actuator.analysis.figure_fields import (
    COLUMNS,
    MAP_FRAMES,
    map_layout,
    origin,
    span,
    thinned,
    WHOLE_RUN_ROWS,
)
from hydra_actuator.analysis.figure_lines import Lines, over_time, RATIO, SECTION_POINTS
from hydra_actuator.analysis.palette import LINES, PRESSURE_SCALE
from hydra_actuator.analysis.series import Field, Series
from hydra_actuator.analysis.units import Scale, SI, Units
from hydra_actuator.analysis.window import best_field, whole_run_buckets, Window
from hydra_actuator.channels import DOMAINS
import numpy as np

MILLILITRE, PERCENT = Scale(1e6, 'ml'), 100.0
TOTAL = {'color': '#7d8791', 'width': 2, 'dash': 'dot'}     # seen on light and on dark
TITLE = 'Cavities'


def cavities(series: Series, shown: Window, units: Units = SI) -> list[Figure]:
    """Return the figures about cavities; none if cavitation was off."""
    if not boiling.cavitation_was_on(series):
        return []
    if series.cavities is not None and not series.cavities.opened.any():
        return [Figure.absent('cavities', TITLE, 'no cavity opened in this run')]
    return [volumes(series, shown, units), *void_maps(series, shown, units)]


def volumes(series: Series, shown: Window, units: Units = SI) -> Figure:
    """Return the volume of cavities by domain, and how many are open, over time."""
    found = series.cavities
    if found is None:
        return Figure.absent('cavities', 'Cavities over time',
                             'the recording has no ~/cavities: publish.sections_rate was 0')
    lines = Lines(found.time, shown, SECTION_POINTS, units)
    boiled = [k for k in range(len(found.domains)) if found.of_domain[:, k].any()]
    for k in boiled:
        colour = LINES[DOMAINS.index(found.domains[k])]
        lines.add(found.domains[k], found.of_domain[:, k], 0, MILLILITRE,
                  {'color': colour})
    if len(boiled) > 1:
        lines.add('all', found.volume, 0, MILLILITRE, TOTAL)
    lines.add('open', found.open, 1, RATIO, {'color': TOTAL['color'], 'shape': 'hv'},
              showlegend=False)
    layout = over_time([MILLILITRE.label('volume'), 'open cavities'], shown, units,
                       lines.traces)
    layout['yaxis2'].update(rangemode='tozero')
    top = int(np.argmax(found.volume))
    return Figure(
        'cavities', 'Cavities over time',
        f'Gas and vapour beyond what the free gas takes at ambient pressure. '
        f'{int(found.opened[-1])} opened, {int(found.collapsed[-1])} collapsed; most was '
        f'{MILLILITRE(found.volume[top]):.3g} ml, t = {found.time[top]:.4f} s.',
        lines.traces, layout, height=460, linked=True,
    )


def void_maps(series: Series, shown: Window, units: Units = SI) -> list[Figure]:
    """Return x-t maps of the void fraction: of the part shown first, and of the whole run."""
    drawn = best_field(series.field, streamline.field_of_stations(series), shown)
    if drawn is None:
        return [Figure.absent('map_void', 'Where the oil boils',
                              'neither the field nor enough stations were recorded')]
    result = [window_map(series, drawn, shown, units)]
    if series.field is not None and len(series.field.time) > 1:
        result.append(whole_map(series, series.field, shown, units))
    return result


def window_map(series: Series, field: Field, shown: Window, units: Units = SI) -> Figure:
    """Return the map of the void fraction in a window, with the piston's path."""
    part = thinned(field.between(shown.start, shown.end), MAP_FRAMES)
    x = streamline.node_positions(part, np.interp(part.time, series.time, series.position))
    grid = np.linspace(field.positions.min(), field.positions.max(), COLUMNS)
    exponents = np.log10(boiling.void_fraction(series, streamline.gapless(part, part.pressure)))
    moment, label = units.since(shown.start)
    time = moment(part.time)
    traces = [_heatmap(series, units.place(grid), time,
                       streamline.on_even_grid(x, exponents, grid))]
    if field.faces is not None:
        traces.append({
            'type': 'scatter', 'mode': 'lines', 'name': 'piston',
            'x': units.place(x[:, field.faces[0]]), 'y': time,
            'line': {'color': '#ffffff', 'width': 1.5, 'dash': 'dot'},
            'hoverinfo': 'skip', 'showlegend': False,
        })
    return Figure(
        'map_void', 'Where the oil boils: void fraction',
        f'{span(shown)}, from {origin(part)}. Dotted: the piston. From '
        f'{_percent(100.0 * _least(series))} on a cavity counts as open; above 100 % it has '
        'outgrown the cell of the mesh it is lumped in.',
        traces, map_layout(field, time, label, units), height=480, wide=False,
    )


def whole_map(series: Series, field: Field, shown: Window, units: Units = SI) -> Figure:
    """Return the map of the whole run: the highest void fraction of every bucket of time."""
    buckets = whole_run_buckets(field, shown, WHOLE_RUN_ROWS)
    starts, lowest, _ = field.extremes('pressure', buckets)
    grid = np.linspace(field.positions.min(), field.positions.max(), COLUMNS)
    exponents = np.log10(boiling.void_fraction(series, lowest))
    values = streamline.extremes_on_even_grid(field, exponents, grid, highest=True)
    time = units.time(field.time[starts])
    seconds = (field.time[-1] - field.time[0]) / max(len(starts), 1)
    return Figure(
        'whole_void', 'Void fraction over the whole run',
        f'Each row of the map holds {seconds * MILLI:.3g} ms of {origin(field)} and shows the '
        'highest in it.', [_heatmap(series, units.place(grid), time, values)],
        map_layout(field, time, units.time.label('time'), units), height=480, wide=False,
    )


def _least(series: Series) -> float:
    """Return the void fraction at ambient pressure."""
    return float(boiling.void_fraction(series, series.parameters.get('ambient_pressure', 101325)))


def _heatmap(series: Series, grid: np.ndarray, time: np.ndarray, exponents: np.ndarray) -> dict:
    """Return a heat map of void fractions given as exponents of ten, from ambient's on."""
    low = np.log10(_least(series))
    high = max(float(np.nanmax(exponents)), low + 2.0)
    ticks = [low, *(k for k in range(-8, 1) if low + 0.3 < k <= high)]
    return {
        'type': 'heatmap', 'name': 'void fraction', 'x': np.asarray(grid, np.float32), 'y': time,
        'z': np.maximum(exponents, low), 'customdata': 10.0 ** exponents * PERCENT,
        'zmin': low, 'zmax': high, 'zsmooth': 'fast', 'colorscale': PRESSURE_SCALE,
        'colorbar': {
            'title': {'text': 'gas'}, 'thickness': 12, 'len': 0.8, 'outlinewidth': 0,
            'tickvals': ticks, 'ticktext': [_percent(10.0 ** k) for k in ticks]},
        'hovertemplate':
            'x %{x:.3f}<br>t %{y:.4g}<br>%{customdata:.3g} % of gas<extra></extra>',
    }


def _percent(share: float) -> str:
    return f'{share * PERCENT:.3g} %'
