# SPDX-License-Identifier: Apache-2.0
"""
The spool's own dynamics: step and sine against the second-order formula; slew and stroke limits.

    x'' + 2 zeta omega x' + omega^2 x = omega^2 x_command

A command holds its value of a step's end over that whole step, so a sine is seen half a step
early and smoothed by the hold: H(i omega) sinc(omega dt/2) exp(i omega dt/2).
"""

import math

from hydra_actuator.actuator import Actuator, SolverError
from hydra_actuator.parameters import Parameters
from hydra_actuator.verification.case import Case, Row
from hydra_actuator.verification.harmonics import first_harmonic
import numpy as np

NATURAL, DAMPING = 120.0, 0.4
STROKE = 5e-4
SLEW = 0.05
STEP_TIME, SINE_TIME = 0.02, 0.1
SINES = (20.0, 120.0, 400.0)


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


def spool_dynamics() -> list[Row]:
    """Compare step, sines, slewing and the stroke's limit."""
    name = 'spool_dynamics'
    dynamic = {'valve.natural_frequency': NATURAL, 'valve.damping_ratio': DAMPING}
    times, spool, _ = spool_trace(dynamic, lambda t: np.full(t.shape, 0.2), STEP_TIME)
    rows = [Row(name, 'step of a fifth, largest distance from the formula', '-', 0.0,
                float(np.abs(spool / (0.2 * STROKE) - step_formula(times)).max()), 1e-10, False,
                'rounding of some thousand steps'),
            Row(name, 'its overshoot', '-',
                1.0 + math.exp(-math.pi * DAMPING / math.sqrt(1.0 - DAMPING ** 2)),
                float(spool.max() / (0.2 * STROKE)), 1e-5, True, 'steps beside the peak')]
    for f in SINES:
        times, spool, dt = spool_trace(
            dynamic, lambda t, f=f: 0.1 * np.sin(2.0 * math.pi * f * t), SINE_TIME)
        last = times > 0.5 * SINE_TIME
        omega = 2.0 * math.pi * f
        got = first_harmonic(times[last], spool[last], omega) / (0.1 * STROKE)
        ratio = 1j * f / NATURAL
        wanted = (1.0 / (1.0 + 2.0 * DAMPING * ratio + ratio ** 2)
                  * np.sinc(0.5 * omega * dt / math.pi) * np.exp(0.5j * omega * dt))
        rows += [Row(name, f'gain at {f:g} Hz', '-', abs(wanted), abs(got), 1e-5, True,
                     'transient left after 50 ms, images of the held command'),
                 Row(name, f'phase at {f:g} Hz', 'rad', float(np.angle(wanted)),
                     float(np.angle(got)), 1e-5, False, 'as the gain')]
    return rows + _limits(name, dynamic)


def _limits(name: str, dynamic: dict) -> list[Row]:
    """Return rows about the limits of speed and stroke."""
    def full(times: np.ndarray) -> np.ndarray:
        return np.ones(times.shape)

    times, spool, dt = spool_trace({'valve.slew_rate': SLEW}, full, STEP_TIME)
    arrival = float(times[np.argmax(spool >= STROKE * (1.0 - 1e-12))])
    _, limited, dt = spool_trace({**dynamic, 'valve.slew_rate': SLEW}, full, STEP_TIME)
    _, clamped, _ = spool_trace(dynamic, full, STEP_TIME)
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


CASES = {'spool_dynamics': Case(spool_dynamics, 'step, sine, slew and stroke limits of the spool')}
