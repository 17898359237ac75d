# SPDX-License-Identifier: Apache-2.0
"""One run of a sweep: parameters and a drive in, figures of merit or a reason out."""

import math
import time
from typing import NamedTuple

from hydra_actuator.actuator import Actuator, SolverError
from hydra_actuator.channels import Channels
from hydra_actuator.offline import Ahead
from hydra_actuator.one_compiler import compile_once
from hydra_actuator.parameters import ParameterError, Parameters
from hydra_actuator.signals import Signal
from hydra_actuator.sweep.merit import NAMES
from hydra_actuator.sweep.small_signal import small_signal
import numpy as np

DONE, REFUSED, STOPPED, NOT_A_NUMBER, LOST = 'done', 'refused', 'stopped', 'nan', 'lost'
# May be NaN in a run that is sound.
OPTIONAL = {'bandwidth', 'resonance', 'resonance_gain', 'velocity_gain', 'peak_supply_flow',
            'supply_power'}


class Drive(NamedTuple):
    """
    What moves the actuator, and how it is looked at.

    signal: the command; duration [s]; start [s]: from when on figures count; rate [Hz]: how
    often it is looked at.
    """

    signal: Signal
    duration: float
    start: float
    rate: float


class Outcome(NamedTuple):
    """What became of run `run`: status, why it failed, figures by name."""

    run: int
    status: str
    reason: str
    figures: dict[str, float]


def run_one(run: int, base: dict, changes: dict, drive: Drive) -> Outcome:
    """Return the outcome of a run; base, changes: parameters that differ from the defaults."""
    try:
        parameters = Parameters({**base, **changes})
        compile_once(parameters)
        actuator = Actuator(parameters)
        began = time.thread_time()
        figures = {**small_signal(parameters), **_simulated(actuator, drive)}
    except ParameterError as error:
        return Outcome(run, REFUSED, str(error), {})
    except SolverError as error:
        kind = NOT_A_NUMBER if str(error).startswith('NaN') else STOPPED
        return Outcome(run, kind, str(error), {})
    figures['run_time'] = time.thread_time() - began
    for name in NAMES:
        if name not in OPTIONAL and not math.isfinite(figures[name]):
            return Outcome(run, NOT_A_NUMBER, f'{name} is {figures[name]}', {})
    return Outcome(run, DONE, '', figures)


def _simulated(actuator: Actuator, drive: Drive) -> dict[str, float]:
    """Drive an actuator and return what is read off its rows and fields."""
    dt = actuator.step_time
    steps = max(1, math.ceil(drive.duration / dt - 1e-6))
    every = max(1, round(1.0 / (drive.rate * dt)))
    first = drive.start / dt - 1e-6
    field = np.empty((len(actuator.field_labels), 2), np.float32)
    rows, highest, step = [], -math.inf, 0
    ahead = Ahead(drive.signal, dt, steps)
    while step < steps:
        until = min(step + every, steps)
        code = actuator.follow((*ahead.between(step, until), True), until - step)
        if code:
            raise SolverError(actuator.status_message(code))
        step = until
        if step >= first:
            actuator.read_field(field)
            highest = max(highest, float(np.fmax.reduce(field[:, 0])))
            rows.append(actuator.row.copy())
    return {'peak_pressure': highest, 'stop_hits': actuator.tally.stop_hits,
            **_read_off(np.array(rows), actuator)}


def _read_off(rows: np.ndarray, actuator: Actuator) -> dict[str, float]:
    channels, p = actuator.channels, actuator.parameters
    position, velocity = rows[:, Channels.POSITION], rows[:, Channels.VELOCITY]
    flow, power = math.nan, math.nan
    if 'O' in channels.section_names:
        k = channels.section_names.index('O')
        gauge = rows[:, channels.pressure][:, k] - p['ambient_pressure']
        pumped = (rows[:, channels.flow_velocity][:, k]
                  * 0.25 * math.pi * p['supply_line.diameter'] ** 2)
        flow, power = float(pumped.max()), float(np.mean(gauge * pumped))
    return {
        'lowest_pressure': float(rows[:, channels.lowest_pressure].min()),
        'cavity_volume': float(rows[:, channels.cavity_volume].max()),
        'travel': float(np.ptp(position)), 'rms_position': float(np.std(position)),
        'final_position': float(position[-1]),
        'peak_velocity': float(np.abs(velocity).max()),
        'rms_velocity': float(np.sqrt(np.mean(velocity**2))),
        'peak_effort': float(np.abs(rows[:, Channels.EFFORT]).max()),
        'peak_supply_flow': flow, 'supply_power': power,
        'largest_mach': float(rows[:, Channels.MACH].max())}
