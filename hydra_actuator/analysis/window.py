# SPDX-License-Identifier: Apache-2.0
"""
Which part of a run the pictures show first.

A periodic run shows its last three periods; another one the surroundings of its largest pressure
step. Waves are shown where the frames are closer than a quarter of the travel time through all
domains; otherwise they would only alias.
"""

import dataclasses
from dataclasses import dataclass

from hydra_actuator.analysis.frames import blocks_of
from hydra_actuator.analysis.series import Field, Series
import numpy as np

PERIODS_SHOWN = 3
FEWEST_PERIODS = 6            # in the record of a periodic run
LONGEST_WINDOW = 0.1          # [s] of a run that is not periodic
MOVING = 0.2                  # share of the highest speed above which the piston moves
PURE = 0.6                    # share of the power in the dominant line of a periodic run
FRAMES_PER_PERIOD = 16        # below this a field looks torn between frames
TRAVELS_SHOWN = 8             # travel times through all domains in the wave window
STEEP = 0.7                   # a change of this share of the largest starts the wave window
USUAL_WAVE_SPEED = 1300.0     # [m/s] where the recording has no parameters


@dataclass(frozen=True)
class Window:
    """A part of the run: start and end [s], and the dominant frequency [Hz] or 0."""

    start: float
    end: float
    frequency: float = 0.0


def dominant_frequency(time: np.ndarray, values: np.ndarray) -> float:
    """
    Return the frequency [Hz] of evenly sampled values if one line carries most power, else 0.

    Slower than six periods in the record is drift and does not count. Hann window, peak
    placed by its two greatest bins.
    """
    if len(values) < 32 or not np.all(np.isfinite(values)) or np.ptp(values) == 0:
        return 0.0
    interval = (time[-1] - time[0]) / (len(time) - 1)
    # A few hundred thousand samples are plenty and keep the transform short.
    values = values[-2**18:] - np.mean(values[-2**18:])
    power = np.abs(np.fft.rfft(values * np.hanning(len(values)))) ** 2
    drift = power[FEWEST_PERIODS - 1]
    power[:FEWEST_PERIODS] = 0.0
    peak = int(power.argmax())
    share = power[max(peak - 2, 0):peak + 3].sum() / max(power.sum(), 1e-300)
    if peak < FEWEST_PERIODS or peak + 1 >= len(power) or share < PURE:
        return 0.0
    if peak == FEWEST_PERIODS and drift > power[peak]:
        return 0.0              # the tail of something slower
    low, mid, high = np.sqrt(power[peak - 1:peak + 2])
    ratio = max(low, high) / mid
    # The two greatest bins of a Hann window give the place of a lone line exactly.
    shift = np.copysign((2 * ratio - 1) / (ratio + 1), high - low)
    return float((peak + shift) / (len(values) * interval))


def active_span(series: Series) -> tuple[float, float]:
    """Return from when to when [s] the piston moved: idle before and after is left out."""
    speed = np.abs(np.nan_to_num(series.velocity))
    moving = np.flatnonzero(speed > MOVING * speed.max())
    if not len(moving):
        return float(series.time[0]), float(series.time[-1])
    return float(series.time[moving[0]]), float(series.time[moving[-1]])


def motion_frequency(series: Series) -> float:
    """Return the frequency [Hz] of the piston while it moved; 0 if it has none."""
    start, end = active_span(series)
    part = slice(*np.searchsorted(series.time, [start, end + 1e-9]))
    return dominant_frequency(series.time[part], series.position[part])


def window_of(series: Series) -> Window:
    """Return the part of the run that is shown first."""
    start, end = float(series.time[0]), float(series.time[-1])
    frequency = motion_frequency(series)
    if frequency:
        _, moved = active_span(series)
        # A motion that stops before the run does is shown without its last period, the stopping.
        last = end if end - moved < 1 / frequency else moved - 1 / frequency
        return Window(max(start, last - PERIODS_SHOWN / frequency), last, frequency)
    if end - start <= LONGEST_WINDOW:
        return Window(start, end)
    first = min(max(largest_step(series) - 0.2 * LONGEST_WINDOW, start), end - LONGEST_WINDOW)
    return Window(first, first + LONGEST_WINDOW)


def common_window(series: Series, other: Series) -> Window:
    """Return the part of a run that is shown first beside another, within the time of both."""
    shown, end = window_of(series), float(other.time[-1] - other.time[0])
    ticks = int(np.searchsorted(series.time, end + 1e-9))
    if shown.end <= end + 1e-9 or ticks < 2:
        return shown
    return window_of(dataclasses.replace(series, **{
        name: getattr(series, name)[:ticks] for name in (
            'time', 'position', 'velocity', 'pressure')}))


def largest_step(series: Series) -> float:
    """Return the time [s] of the largest pressure change between two ticks."""
    known = np.isfinite(series.pressure).all(axis=1)
    if series.pressure.shape[1] == 0 or np.sum(known) < 2:
        return float(series.time[0])
    step = np.zeros(np.sum(known) - 1)
    for column in series.pressure.T:
        np.maximum(step, np.abs(np.diff(column[known])), out=step)
    return float(series.time[known][int(step.argmax())])


def wave_speed(series: Series) -> float:
    """Return the wave speed [m/s] of the fluid, walls rigid."""
    density = series.parameters.get('fluid.density')
    modulus = series.parameters.get('fluid.bulk_modulus')
    return float(np.sqrt(modulus / density)) if density and modulus else USUAL_WAVE_SPEED


def wave_window(series: Series, field: Field, shown: Window) -> Window | None:
    """Return a window of a few wave travels, or None if the frames are too far apart for waves."""
    travel = float(np.ptp(field.positions)) / wave_speed(series)
    if travel == 0 or field.interval > 0.25 * travel:
        return None
    span = TRAVELS_SHOWN * travel
    middle = _steepest(field.between(shown.start, shown.end))
    start = min(max(middle - 0.25 * span, float(field.time[0])), float(field.time[-1]) - span)
    start = max(start, float(field.time[0]))
    return Window(start, min(start + span, float(field.time[-1])), shown.frequency)


def best_field(full: Field | None, stations: Field | None, shown: Window) -> Field | None:
    """Return the field unless its frames are too few in a period and the stations have more."""
    if full is None or len(full.time) < 2:
        return stations
    if stations is None:
        return full
    span = 1 / shown.frequency if shown.frequency else shown.end - shown.start
    enough = full.interval * FRAMES_PER_PERIOD <= span
    return full if enough or full.interval <= 1.5 * stations.interval else stations


def whole_run_buckets(field: Field, shown: Window, most: int) -> int:
    """Return in how many buckets to show a whole run: of about whole periods, if it has some."""
    periods = round((field.time[-1] - field.time[0]) * shown.frequency)
    if periods < 2:
        return most
    return max(periods // -(-periods // most), 1)


def _steepest(field: Field) -> float:
    """Return the time [s] of the first of the largest pressure changes between two frames."""
    if len(field.time) < 2:
        return float(field.time[0]) if len(field.time) else 0.0
    changes, last = [], None
    for block in blocks_of(field.pressure):
        rows = block if last is None else np.concatenate([last, block])
        changes.append(np.nan_to_num(np.abs(np.diff(rows, axis=0))).max(axis=1, initial=0.0))
        last = rows[-1:].copy()
    change = np.concatenate(changes)
    return float(field.time[int(np.argmax(change >= STEEP * change.max()))])
