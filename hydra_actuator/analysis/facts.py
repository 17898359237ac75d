# SPDX-License-Identifier: Apache-2.0
"""The numbers of a run, in words: duration, ticks, stroke, extreme pressures, real time."""

from hydra_actuator.analysis import timing
from hydra_actuator.analysis.figure import MEGAPASCAL, MICRO, MILLI
from hydra_actuator.analysis.series import Cavities, Series
from hydra_actuator.analysis.window import motion_frequency
from hydra_actuator.parameters.table import definitions
import numpy as np

Rows = list[tuple[str, str]]


def run_facts(series: Series) -> Rows:
    """Return the facts of the run as (what, value with unit)."""
    time = series.time
    duration = float(time[-1] - time[0])
    rows = [('duration', f'{duration:.6g} s'), ('states', f'{len(time):,}'.replace(',', ' '))]
    if duration > 0:
        rows.append(('rate of the states', f'{(len(time) - 1) / duration:.6g} Hz'))
    low, high = float(series.position.min()) * MILLI, float(series.position.max()) * MILLI
    rows += [
        ('piston travel', f'{high - low:.4g} mm, from {low:+.4g} to {high:+.4g} mm'),
        ('greatest piston speed', f'{np.abs(series.velocity).max():.4g} m/s'),
        ('dominant frequency', _frequency(series)),
    ]
    if series.pressure.size:
        rows += [(f'{word} pressure', _extreme_pressure(series, word))
                 for word in ('highest', 'lowest')]
    if series.cavities is not None:
        rows += _cavity_facts(series.cavities)
    for command in series.commands:
        rows.append((f'messages on {command.topic}', str(len(command.time))))
    if series.field is not None:
        rows.append(('field', f'{len(series.field.time)} frames of {len(series.field.positions)} '
                     f'nodes, {1 / series.field.interval:.6g} Hz'))
    rows.append(('written by', series.source or 'unknown'))
    return rows + [(f'version of {name}', str(text)) for name, text in series.versions.items()]


def real_time_facts(series: Series) -> Rows:
    """Return real-time statistics over the whole run as (what, value with unit)."""
    if series.source == 'simulate':
        return []
    rows: Rows = []
    reports = timing.real_time_reports(series)
    if reports:
        rows += [(key.replace('_', ' '), text + _unit(key))
                 for key, text in reports[-1].values.items()]
    steps = timing.stamp_steps(series)
    if steps is not None:
        worst = np.abs(steps.deviation).max() * MICRO
        rows += [('greatest deviation of a stamp step',
                  f'{worst:.0f} us' if worst >= 1e4 else f'{worst:.4g} us'),
                 ('missing ticks between stamps', str(steps.missing))]
    if len(series.send_delay) and not timing.in_simulated_time(series):
        p50, p99, top = np.percentile(series.send_delay, [50, 99, 100]) * MICRO
        rows.append(('sending after the stamp, p50 / p99 / max',
                     f'{p50:.0f} / {p99:.0f} / {top:.0f} us'))
    return rows


def _cavity_facts(cavities: Cavities) -> Rows:
    """Return how many cavities there were and how large they became."""
    top = int(np.argmax(cavities.volume))
    opened, collapsed = int(cavities.opened[-1]), int(cavities.collapsed[-1])
    return [
        ('cavities', f'{opened} opened, {collapsed} collapsed'),
        ('largest volume of cavities',
         f'{cavities.volume[top] * 1e6:.4g} ml, t = {cavities.time[top]:.4f} s'),
    ]


def _unit(key: str) -> str:
    """Return the unit of one of the node's real-time statistics."""
    if key.startswith(('lateness', 'execution')):
        return ' us'
    return ' s' if key == 'slip' else ''


def _extreme_pressure(series: Series, word: str) -> str:
    """Return the highest or lowest pressure of all sections, where and when."""
    found = series.extreme_pressure(word)
    if found is None:
        return 'none'
    value, tick, section = found
    value *= MEGAPASCAL
    told = f'{value:.4f}' if abs(value) >= 0.01 else f'{value:.3g}'
    return (f'{told} MPa abs at {series.section_names[section]}, '
            f't = {series.time[tick]:.4f} s')


def _frequency(series: Series) -> str:
    """Return the dominant frequency of the piston in words."""
    frequency = motion_frequency(series)
    return f'{frequency:.4g} Hz' if frequency else 'none (not periodic)'


def changed_parameters(series: Series) -> Rows:
    """Return the recorded parameters that differ from the defaults, with their units."""
    rows = []
    table = definitions(series.section_names)
    for name, value in series.parameters.items():
        known = table.get(name)
        if known is None:
            rows.append((name, f'{_shown(value)} (unknown to this version)'))
        elif not _equal(value, known.default):
            unit = '' if known.unit in ('', '1') else f' {known.unit}'
            rows.append((name, f'{_shown(value)}{unit} (default {_shown(known.default)})'))
    return rows


def _equal(value: object, default: object) -> bool:
    """Tell whether a value read from YAML is the default."""
    if isinstance(default, tuple):
        return list(value) == list(default) if isinstance(value, (list, tuple)) else False
    return value == default


def _shown(value: object) -> str:
    """Return a value as short text."""
    if isinstance(value, (list, tuple)):
        return '[' + ', '.join(map(_shown, value)) + ']'
    return (str(value).lower() if isinstance(value, bool) else str(value)) or 'empty'
