# SPDX-License-Identifier: Apache-2.0
"""
A blocked line driven at its open end: where it resonates and how high, with unsteady friction.

    p(0, t) a short pulse |--------------| blocked;  |p(L)/p(0)| by Fourier transform of both

Exactly 1/cosh(s T g), see hydra_actuator.verification.friction_laplace; without friction the
peaks are at odd quarters of c/L and infinite. The pulse is of 1 Pa: linear.
"""

from functools import cache
import math

from hydra_actuator.core.model import Domain, Junction
from hydra_actuator.core.oil import Oil
from hydra_actuator.core.records import CLOSED, PRESSURE
from hydra_actuator.verification.case import Case, Row
from hydra_actuator.verification.chains import LoneChain, mesh_of
from hydra_actuator.verification.drawing import (
    EXACT_LINE,
    EXACT_POINT,
    SIMPLER,
    SOLVER,
    SOLVER_POINT,
)
from hydra_actuator.verification.friction_laplace import blocked_response
import numpy as np

DENSITY, BULK_MODULUS, VISCOSITY = 870.0, 1.5e9, 46e-6
SPEED = math.sqrt(BULK_MODULUS / DENSITY)
LENGTH, RADIUS = 2.0, 0.005
CELLS = 200
PEAKS = ((159.236, 20.361), (483.911, 11.976), (809.705, 9.324), (1135.962, 7.899))  # (Hz, -)
PULSE = 1e-4        # [s], its spectrum is down to 0.6 at the fourth peak
DURATION = 0.4      # [s], the first mode has died away to 3e-6
WINDOW = 0.02       # around a peak, of its frequency
FREQUENCY_TOLERANCE = 3e-4
FREQUENCY_REASON = 'the six fitted terms alone are 0.02 % off'
HEIGHT_TOLERANCE = 0.01
HEIGHT_REASON = 'the six fitted terms alone are 0.6 % off, 200 cells lose 0.5 % at the fourth'


def blocked_line() -> list[Row]:
    """Measure frequency and height of the first four peaks."""
    time, driven, blocked = pulse_response()
    rows = []
    for k, (frequency, height) in enumerate(PEAKS, start=1):
        got_frequency, got_height = peak_near(frequency, time, driven, blocked)
        rows += [
            Row('friction_blocked', f'frequency of peak {k}', 'Hz', frequency, got_frequency,
                FREQUENCY_TOLERANCE, True, FREQUENCY_REASON),
            Row('friction_blocked', f'height of peak {k}', '-', height, got_height,
                HEIGHT_TOLERANCE, True, HEIGHT_REASON),
        ]
    return rows


@cache
def pulse_response(friction: str = 'unsteady',
                   cells: int = CELLS) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return (time [s], p(0), p(L) [Pa]) of a line whose open end sees a pulse."""
    chain = LoneChain(
        [Domain('line', LENGTH, math.pi * RADIUS ** 2, SPEED, friction=friction)],
        [Junction(PRESSURE, (0,)), Junction(CLOSED, (1,))],
        mesh_of(LENGTH, cells, wave_speed=SPEED), Oil(DENSITY, VISCOSITY))
    step_time = chain.model.step_time
    steps, every = math.ceil(DURATION / step_time), max(1, cells // 50)
    times = step_time * np.arange(math.ceil(10.0 * PULSE / step_time))
    pulse = np.exp(-((times - 5.0 * PULSE) / PULSE) ** 2)
    trace = []
    for _ in range(steps // every):
        chain.follow(times, pulse[:, np.newaxis], every)
        trace.append((chain.time, chain.end_pressure(0), chain.end_pressure(1)))
    time, driven, blocked = np.array(trace).T
    return time, driven, blocked


def peak_near(frequency: float, time, driven, blocked) -> tuple[float, float]:
    """Return frequency [Hz] and height of the largest |p(L)/p(0)| around a frequency [Hz]."""
    width, count = WINDOW * frequency, 41
    for _ in range(3):
        frequencies = frequency + np.linspace(-width, width, count)
        response = response_at(frequencies, time, driven, blocked)
        best = int(np.argmax(response))
        frequency, width = frequencies[best], 2.0 * width / (count - 1)
    return float(frequency), float(response[best])


def response_at(frequencies, time, driven, blocked) -> np.ndarray:
    """Return |p(L)/p(0)| at frequencies [Hz] of a pulse's traces."""
    waves = np.exp(-2j * np.pi * np.outer(frequencies, time))
    return np.abs((waves @ blocked) / (waves @ driven))


def draw_blocked_line(figure) -> None:
    """Draw the response over frequency, and its four peaks near."""
    panels = figure.subplot_mosaic([['all'] * 4, [0, 1, 2, 3]], height_ratios=(3, 2))
    transit, pulse = LENGTH / SPEED, pulse_response()
    dissipation = VISCOSITY * transit / RADIUS ** 2

    def draw(axes, low: float, high: float, points: int) -> None:
        peaks = [frequency for frequency, _ in PEAKS if low < frequency < high]
        frequencies = np.sort(np.append(np.linspace(low, high, points), peaks))
        exact = blocked_response(frequencies * transit, dissipation)
        axes.plot(frequencies, exact, **{**EXACT_LINE, 'label': 'exact, by Laplace transform'})
        axes.plot(frequencies, response_at(frequencies, *pulse), **SOLVER)
        axes.set_xlabel('frequency [Hz]')
        axes.grid(True)

    axes = panels['all']
    draw(axes, 5.0, 1300.0, 400)
    for k in range(4):
        place = 0.25 * (2 * k + 1) / transit
        axes.axvline(place, **{**SIMPLER, 'label': '_' if k else 'resonance without friction'})
    axes.set_ylabel('|p(L) / p(0)|')
    axes.legend(ncols=3, loc='lower right', bbox_to_anchor=(1.0, 1.0), borderpad=0)
    for k, (frequency, height) in enumerate(PEAKS):
        draw(panels[k], 0.94 * frequency, 1.06 * frequency, 60)
        panels[k].plot(frequency, height, **EXACT_POINT)
        got, high = peak_near(frequency, *pulse)
        panels[k].plot(got, high, **SOLVER_POINT)
        panels[k].set_title(f'peak {k + 1}: exact {frequency:.2f} Hz, {height:.3f}\n'
                            f'solver {got:.2f} Hz, {high:.3f}', loc='left', fontsize=8)


CASES = {
    'friction_blocked': Case(blocked_line, 'resonances of a blocked line, unsteady friction',
                             figure=draw_blocked_line),
}
