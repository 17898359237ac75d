# SPDX-License-Identifier: Apache-2.0
"""
Amplitude spectra of pressures and of the piston's speed, with the plant's natural frequencies.

Hann window over the evenly spaced states of the part shown, mean removed, scaled so that a lone
sine has its amplitude. A state rate of f shows nothing above f/2, and folds what is there.
"""

from hydra_actuator.analysis.decimation import extreme_samples
from hydra_actuator.analysis.figure import Figure, rows_layout
from hydra_actuator.analysis.line_frequencies import line_frequencies
from hydra_actuator.analysis.palette import BLUE, GREEN, line_style, ORANGE, VERMILION
from hydra_actuator.analysis.series import Series
from hydra_actuator.analysis.timing import stamp_steps
from hydra_actuator.analysis.units import complete, SI, Units
from hydra_actuator.analysis.window import Window
from hydra_actuator.parameters.streamline import streamline_length, wave_speed
import numpy as np

KEY, TITLE = 'spectrum', 'Spectra'
FEWEST_STATES = 32
STATIONS_SHOWN = ('A', 'E', 'F', 'J')
LINE_COLOURS = {'supply_line': BLUE, 'return_line': ORANGE, 'piston and oil': VERMILION}
RANGE = 1e-5            # of the highest value, that the picture reaches down to
HIGHEST = 4.0           # [c/L], that is shown
MOST_MISSING = 0.001    # of the ticks, for a spectrum to hold
POINTS = 8000           # of one line; of its neighbours the lowest and the highest stay


def spectrum(series: Series, part: Window, units: Units = SI) -> Figure:
    """Return the spectra of a part of the run."""
    states = slice(*np.searchsorted(series.time, [part.start - 1e-9, part.end + 1e-9]))
    time = series.time[states]
    if len(time) < FEWEST_STATES:
        return Figure.absent(KEY, TITLE, f'fewer than {FEWEST_STATES} states in the part shown')
    lines = [(f'pressure {name}', series.pressure[states, k], 'pressure', line_style(name, k))
             for k, name in _columns(series)]
    lines.append(('piston velocity', series.velocity[states], 'velocity', {'color': GREEN}))
    quantities = list(dict.fromkeys(quantity for _, _, quantity, _ in lines))
    traces, tops = [], dict.fromkeys(quantities, 0.0)
    for name, values, quantity, style in lines:
        scale = units.pressure_change if quantity == 'pressure' else units.velocity
        frequency, height = amplitudes(time, values)
        if not height[1:].any():
            continue            # nothing moves there
        kept = 1 + extreme_samples(height[1:], POINTS // 2)
        frequency, height = frequency[kept], scale(height[kept])
        tops[quantity] = max(tops[quantity], float(height.max()))
        row = quantities.index(quantity) + 1
        traces.append({
            'type': 'scatter', 'mode': 'lines', 'name': name,
            'x': units.frequency(frequency),
            'y': np.asarray(np.where(height > 0, height, np.nan), np.float32),
            'xaxis': 'x', 'yaxis': 'y' if row == 1 else f'y{row}',
            'line': {'width': 1.2, **style},
        })
    scales = {'pressure': units.pressure_change, 'velocity': units.velocity}
    layout = rows_layout([scales[q].label(f'{q} amplitude') for q in quantities])
    layout['xaxis']['title'] = {'text': units.frequency.label('frequency')}
    end = min(float(frequency[-1]), _highest(series))
    layout['xaxis']['range'] = [0.0, float(units.frequency(end))]
    for k, quantity in enumerate(quantities):
        top = np.log10(max(tops[quantity], 1e-12))
        span = [float(top + np.log10(RANGE)), float(top + 0.3)]
        layout['yaxis' if k == 0 else f'yaxis{k + 1}'].update(type='log', range=span)
        traces += _marks(series, end, 10.0**np.array(span), k + 1, units)
    return Figure(KEY, TITLE, _caption(series), traces, layout, height=560)


def amplitudes(time: np.ndarray, values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """
    Return (frequencies [Hz], amplitudes) of evenly sampled values, Hann window.

    Up to 1 % of them are left out at the beginning, for a length that is quickly transformed.
    """
    first = len(values) - fast_length(len(values))
    time, values = time[first:], values[first:]
    window = np.hanning(len(values))
    values = np.nan_to_num(values - np.nanmean(values))
    interval = (time[-1] - time[0]) / (len(time) - 1)
    height = np.abs(np.fft.rfft(values * window)) * 2.0 / window.sum()
    return np.fft.rfftfreq(len(values), interval), height


def fast_length(count: int) -> int:
    """Return the highest length up to a count without prime factors above 11, if it is near."""
    for length in range(count, int(0.99 * count), -1):
        rest = length
        for prime in (2, 3, 5, 7, 11):
            while rest % prime == 0:
                rest //= prime
        if rest == 1:
            return length
    return count


def _columns(series: Series) -> list[tuple[int, str]]:
    """Return column and name of the sections shown: some stations, else the first ones."""
    names = series.section_names
    chosen = [name for name in STATIONS_SHOWN if name in names] or names[:4]
    found = [(names.index(name), name) for name in chosen]
    return [(k, name) for k, name in found if np.isfinite(series.pressure[:, k]).any()]


def _marks(series: Series, highest: float, span: np.ndarray, row: int,
           units: Units) -> list[dict]:
    """Return the natural frequencies as vertical lines over the span of a panel."""
    if not series.parameters:
        return []
    found = line_frequencies(complete(series), float(np.mean(series.position)), highest)
    marks = []
    for name, colour in LINE_COLOURS.items():
        values = units.frequency(np.array([one.value for one in found if one.name == name]))
        if len(values):
            marks.append({
                'type': 'scatter', 'mode': 'lines', 'name': f'{name}, valve closed',
                'x': np.repeat(values, 3), 'xaxis': 'x',
                'y': np.tile([*span, np.nan], len(values)).astype(np.float32),
                'yaxis': 'y' if row == 1 else f'y{row}', 'showlegend': row == 1,
                'line': {'color': colour, 'width': 1.2, 'dash': 'dot'},
            })
    return marks


def _highest(series: Series) -> float:
    """Return up to what frequency [Hz] a spectrum is shown."""
    values = complete(series)
    return HIGHEST * wave_speed(values) / streamline_length(values)


def _caption(series: Series) -> str:
    steps = stamp_steps(series)
    uneven = ''
    if steps is not None and steps.missing > MOST_MISSING * len(steps.time):
        uneven = (f' {steps.missing} ticks are missing between the states, which are taken as '
                  'evenly spaced: the frequencies are not to be trusted.')
    if not series.parameters:
        return f'Amplitudes, Hann window.{uneven}'
    return (f'Amplitudes, Hann window.{uneven} Dotted: natural frequencies without losses, valve '
            'closed: the quarter waves of supply and return line, and the piston between its two '
            'columns of oil, about its mean place.')
