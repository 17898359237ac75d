# SPDX-License-Identifier: Apache-2.0
"""
Two runs in numbers: how far they are apart, extreme pressures, and the figures of a step.

Differences are the first run less the second at the instants of the first, over the time both
have. Rise, overshoot and settling are those of the piston's position, where it goes from rest to
rest; the band of settling is 2 %.
"""

from hydra_actuator.analysis.figure import MEGAPASCAL, MILLI
from hydra_actuator.analysis.figure_comparison import difference, FACES
from hydra_actuator.analysis.series import Series
from hydra_actuator.step_response import step_metrics, StepMetrics
import numpy as np

Rows = list[tuple[str, str]]

TAIL = 0.1              # share of a run at whose end the piston has to be at rest
AT_REST = 0.02          # share of its way that it may move then
LEAST_WAY = 1e-6        # [m]


def merits(series: Series, other: Series) -> Rows:
    """Return (what, values of both or difference, with units)."""
    rows = [_apart('position', series.time, series.position, other.time, other.position,
                   MILLI, 'mm')]
    for name in FACES:
        if name in series.section_names and name in other.section_names:
            mine, theirs = (one.pressure[:, one.section_names.index(name)]
                            for one in (series, other))
            rows.append(_apart(f'pressure {name}', series.time, mine, other.time, theirs,
                               MEGAPASCAL, 'MPa'))
    for word in ('highest', 'lowest'):
        found = [one.extreme_pressure(word) for one in (series, other)]
        if None not in found:
            rows.append((f'{word} pressure', _both([one[0] * MEGAPASCAL for one in found], 'MPa')))
    steps = [step_of(one) for one in (series, other)]
    if None in steps:
        return rows
    return [
        *rows,
        ('rise time of the position, 10 to 90 %',
         _both([step.rise_time * MILLI for step in steps], 'ms')),
        ('overshoot', _both([step.overshoot * 100.0 for step in steps], '%')),
        ('settling time, to 2 %', _both([step.settling_time * MILLI for step in steps], 'ms')),
    ]


def step_of(series: Series) -> StepMetrics | None:
    """Return the figures of the position as a step; None where it does not end at rest."""
    known = np.isfinite(series.position)
    time, position = series.time[known], series.position[known]
    if len(time) < 20:
        return None
    tail = position[time >= time[-1] - TAIL * (time[-1] - time[0])]
    target = float(tail.mean())
    way = abs(target - float(position[0]))
    if way < LEAST_WAY or np.ptp(tail) > AT_REST * way:
        return None
    return step_metrics(time, position, target)


def _apart(name: str, time: np.ndarray, mine: np.ndarray, times: np.ndarray, theirs: np.ndarray,
           factor: float, unit: str) -> tuple[str, str]:
    """Return root mean square and greatest difference of a quantity."""
    known, known_2 = np.isfinite(mine), np.isfinite(theirs)
    apart = np.empty(0)
    if known.any() and known_2.any():
        apart = difference(time[known], mine[known], times[known_2], theirs[known_2])
        apart = apart[np.isfinite(apart)] * factor
    if not len(apart):
        return f'difference of the {name}', 'none: no time in common'
    return (f'difference of the {name}', f'RMS {np.sqrt(np.mean(apart**2)):.4g} {unit}, '
            f'at most {np.abs(apart).max():.4g} {unit}')


def _both(values: list[float], unit: str) -> str:
    """Return the value of each run; what a step never reached is a dash."""
    return ' / '.join('-' if np.isnan(value) else f'{value:.4g}' for value in values) + f' {unit}'
