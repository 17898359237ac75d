# SPDX-License-Identifier: Apache-2.0
r"""
The figures by which a step response is judged.

    value
      peak  - - - - - - _-_  ...........................  target + band
    target  - - - - - -/- -\__---______________________
                      /                                   target - band
                     /
    first __________/
              rise: 10 % to 90 %;  settled: inside the band for good

The step goes from the first value to the target, up or down. Instants are found by linear
interpolation between samples.
"""

from dataclasses import dataclass
import math

import numpy as np

# The steady error is the mean over this last part of the record.
TAIL = 0.1


@dataclass(frozen=True)
class StepMetrics:
    """
    Figures of one step response; times count from the first sample.

    rise_time [s]: from 10 % to 90 % of the step; NaN if it never gets there.
    overshoot: how far the peak lies beyond the target, as a part of the step; 0 if it does not.
    settling_time [s]: after it the value stays within the band; NaN if it ends outside.
    steady_error [unit of the value]: target less the mean of the last tenth of the time.
    peak [unit of the value]: the value furthest in the direction of the step.
    """

    rise_time: float
    overshoot: float
    settling_time: float
    steady_error: float
    peak: float


def step_metrics(
    time: np.ndarray, value: np.ndarray, target: float, band: float = 0.02
) -> StepMetrics:
    """
    Return the figures of a response, recorded from the instant of the step on.

    time [s], increasing, and value, both (n,), n >= 2; target: what the value should reach;
    band: half its width, as a part of the step. Raises ValueError for what is no step response.
    """
    time, value = _checked(time, value, target)
    if not 0.0 < band < 1.0:
        raise ValueError(f'band = {band!r} is not a part of the step between 0 and 1')
    step = target - value[0]
    share = (value - value[0]) / step
    begin, end = (_first_at(time, share, level) for level in (0.1, 0.9))
    last = time >= time[-1] - TAIL * (time[-1] - time[0])
    top = int(np.argmax(share))
    return StepMetrics(
        rise_time=end - begin,
        overshoot=max(0.0, float(share[top]) - 1.0),
        settling_time=_settled(time, np.abs(share - 1.0), band) - float(time[0]),
        steady_error=float(target - value[last].mean()),
        peak=float(value[top]))


def _checked(time: object, value: object, target: float) -> tuple[np.ndarray, np.ndarray]:
    time, value = np.asarray(time, float), np.asarray(value, float)
    if time.ndim != 1 or time.shape != value.shape or len(time) < 2:
        raise ValueError(
            f'time {time.shape} and value {value.shape} are not two records of one length, '
            'at least 2')
    if not (np.isfinite(time).all() and np.isfinite(value).all() and math.isfinite(target)):
        raise ValueError('time, value and target must be finite')
    if not (np.diff(time) > 0.0).all():
        raise ValueError('time does not increase throughout')
    if target == value[0]:
        raise ValueError(f'there is no step: the first value is the target, {target!r}')
    return time, value


def _first_at(time: np.ndarray, share: np.ndarray, level: float) -> float:
    """Return when a level is first reached from below, NaN if never."""
    above = np.flatnonzero(share >= level)
    return _crossing(time, share, above[0], level) if len(above) else math.nan


def _settled(time: np.ndarray, distance: np.ndarray, band: float) -> float:
    """Return when the distance from the target last came into the band, NaN if it is outside."""
    outside = np.flatnonzero(distance > band)[-1]
    return math.nan if outside == len(time) - 1 else _crossing(time, distance, outside + 1, band)


def _crossing(time: np.ndarray, y: np.ndarray, k: int, level: float) -> float:
    """Return the instant of a level between samples k - 1 and k."""
    part = (level - y[k - 1]) / (y[k] - y[k - 1])
    return float(time[k - 1] + part * (time[k] - time[k - 1]))
