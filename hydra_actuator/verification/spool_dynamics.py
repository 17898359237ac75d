# SPDX-License-Identifier: Apache-2.0
"""
The spool's own dynamics: step and sine against the second-order formula; slew and stroke limits.

    x'' + 2 zeta omega x' + omega^2 x = omega^2 x_command

A command holds its value of a step's end over that whole step, so a sine is seen half a step
early and smoothed by the hold: H(i omega) sinc(omega dt/2) exp(i omega dt/2).
"""

from functools import cache
import math

from hydra_actuator.actuator import Actuator, SolverError
from hydra_actuator.analysis.palette import GREEN, INK, PURPLE
from hydra_actuator.parameters import Parameters
from hydra_actuator.verification.case import Case, Row
from hydra_actuator.verification.drawing import EXACT_LINE, MILLI, SOLVER, SOLVER_POINT
from hydra_actuator.verification.harmonics import first_harmonic
import numpy as np

NATURAL, DAMPING = 120.0, 0.4
STROKE = 5e-4
SLEW = 0.05
STEP_TIME, SINE_TIME = 0.02, 0.1
SINES = (20.0, 120.0, 400.0)
DYNAMIC = {'valve.natural_frequency': NATURAL, 'valve.damping_ratio': DAMPING}


def spool_trace(changes: dict, command, duration: float) -> tuple[np.ndarray, np.ndarray, float]:
    """Return times [s], spool [m] after every step under command(times), and the step time."""
    actuator = Actuator(Parameters().replace({'valve.stroke': STROKE, **changes}))
    dt = actuator.step_time
    count = round(duration / dt)
    times = np.arange(1, count + 1) * dt
    commands = np.zeros((count, 3))
    commands[:, 0] = commands[:, 1] = command(times)
    spool = np.empty(count)
    for k in range(count):
        code = actuator.follow((times[k:k + 1], commands[k:k + 1], True), 1)
        if code:
            raise SolverError(actuator.status_message(code))
        spool[k] = actuator.row[actuator.channels.SPOOL_1]
    return times, spool, dt


def step_formula(times: np.ndarray) -> np.ndarray:
    """Return the step response of the second-order spool [-]."""
    omega = 2.0 * math.pi * NATURAL
    swing = omega * math.sqrt(1.0 - DAMPING ** 2)
    return 1.0 - np.exp(-DAMPING * omega * times) * (
        np.cos(swing * times) + DAMPING * omega / swing * np.sin(swing * times))


def wanted_at(frequency: np.ndarray, step_time: float) -> np.ndarray:
    """Return the exact response [-] at frequencies [Hz] to a sine that is held over each step."""
    omega, ratio = 2.0 * math.pi * frequency, 1j * frequency / NATURAL
    return (1.0 / (1.0 + 2.0 * DAMPING * ratio + ratio ** 2)
            * np.sinc(0.5 * omega * step_time / math.pi) * np.exp(0.5j * omega * step_time))


@cache
def sine_response(frequency: float) -> tuple[complex, float]:
    """Return the solver's response [-] to a sine of a tenth of the stroke, and the step time."""
    times, spool, dt = spool_trace(
        DYNAMIC, lambda t: 0.1 * np.sin(2.0 * math.pi * frequency * t), SINE_TIME)
    last = times > 0.5 * SINE_TIME
    omega = 2.0 * math.pi * frequency
    return first_harmonic(times[last], spool[last], omega) / (0.1 * STROKE), dt


def spool_dynamics() -> list[Row]:
    """Compare step, sines, slewing and the stroke's limit."""
    name = 'spool_dynamics'
    times, spool, _ = spool_trace(DYNAMIC, lambda t: np.full(t.shape, 0.2), STEP_TIME)
    rows = [Row(name, 'step of a fifth, largest distance from the formula', '-', 0.0,
                float(np.abs(spool / (0.2 * STROKE) - step_formula(times)).max()), 1e-10, False,
                'rounding of some thousand steps'),
            Row(name, 'its overshoot', '-',
                1.0 + math.exp(-math.pi * DAMPING / math.sqrt(1.0 - DAMPING ** 2)),
                float(spool.max() / (0.2 * STROKE)), 1e-5, True, 'steps beside the peak')]
    for f in SINES:
        got, dt = sine_response(f)
        wanted = complex(wanted_at(f, dt))
        rows += [Row(name, f'gain at {f:g} Hz', '-', abs(wanted), abs(got), 1e-5, True,
                     'transient left after 50 ms, images of the held command'),
                 Row(name, f'phase at {f:g} Hz', 'rad', float(np.angle(wanted)),
                     float(np.angle(got)), 1e-5, False, 'as the gain')]
    return rows + _limits(name)


def _limits(name: str) -> list[Row]:
    """Return rows about the limits of speed and stroke."""
    def full(times: np.ndarray) -> np.ndarray:
        return np.ones(times.shape)

    times, spool, dt = spool_trace({'valve.slew_rate': SLEW}, full, STEP_TIME)
    arrival = float(times[np.argmax(spool >= STROKE * (1.0 - 1e-12))])
    _, limited, dt = spool_trace({**DYNAMIC, 'valve.slew_rate': SLEW}, full, STEP_TIME)
    _, clamped, _ = spool_trace(DYNAMIC, full, STEP_TIME)
    speed = np.abs(np.diff(limited, prepend=0.0)).max() / dt
    straight = spool[times < STROKE / SLEW] - SLEW * times[times < STROKE / SLEW]
    return [
        Row(name, 'slewing over the whole stroke takes', 's', STROKE / SLEW, arrival, 1.01 * dt,
            False, 'one step'),
        Row(name, 'slewing, largest distance from a straight line', 'm', 0.0,
            float(np.abs(straight).max()), 1e-15, False, 'rounding'),
        Row(name, 'largest speed with dynamics and slew limit', 'm/s', SLEW, float(speed), 1e-9,
            True, 'rounding of a difference; reached, never exceeded'),
        Row(name, 'travel beyond the stroke, underdamped full step', 'm', 0.0,
            float(max(0.0, np.abs(clamped).max() - STROKE)), 0.0, False, 'never exceeded'),
        Row(name, 'travel of the underdamped full step', 'm', STROKE, float(clamped.max()), 1e-12,
            True, 'it does run into the stroke')]


def draw(figure) -> None:
    """Draw the step, its limited kin, and the frequency response."""
    left, right = figure.subplots(1, 2)
    times, spool, _ = spool_trace(DYNAMIC, lambda t: np.full(t.shape, 0.2), STEP_TIME)
    left.plot(MILLI * times, 0.2 * step_formula(times), **EXACT_LINE)
    left.plot(MILLI * times, spool / STROKE, **{**SOLVER, 'label': 'solver, a step of a fifth'})
    for colour, changes, label in (
            (GREEN, DYNAMIC, 'full step: the stroke ends it'),
            (PURPLE, {'valve.slew_rate': SLEW}, f'ideal spool, {SLEW:g} m/s at most'),
            (INK, {**DYNAMIC, 'valve.slew_rate': SLEW}, 'both')):
        times, spool, _ = spool_trace(changes, lambda t: np.ones(t.shape), STEP_TIME)
        left.plot(MILLI * times, spool / STROKE, color=colour, linewidth=1.2, label=label)
    left.set_xlabel('time [ms]')
    left.set_ylabel('spool over its stroke')
    frequency = np.geomspace(5.0, 1000.0, 300)
    _, dt = sine_response(SINES[0])
    right.loglog(frequency, np.abs(wanted_at(frequency, dt)), **EXACT_LINE)
    right.loglog(SINES, [abs(sine_response(f)[0]) for f in SINES], **SOLVER_POINT)
    right.set_xlabel('frequency [Hz]')
    right.set_ylabel('gain, spool over command')
    for axes in (left, right):
        axes.grid(True)
        axes.legend()


CASES = {'spool_dynamics': Case(
    spool_dynamics, 'step, sine, slew and stroke limits of the spool', figure=draw)}
