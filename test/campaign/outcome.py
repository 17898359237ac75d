# SPDX-License-Identifier: Apache-2.0
"""
What becomes of a set of parameters: it runs, is refused, is stopped, or fails.

ran: all that is published stayed finite and physical to the end of its time.
refused: ParameterError or InputError before the first step.
stopped: sound until it left the method's stated validity (solver.max_mach, a chamber of less than
one cell), which the status names.
failed: NaN, a pressure below vapour pressure with cavitation, or anything else.

A set whose 0.2 s would cost more than its budget of node updates runs for that budget.
"""

from dataclasses import dataclass
import math
import re

from campaign.commands import draw_command
from hydra_actuator.actuator import Actuator
from hydra_actuator.core.observe import NOT_A_NUMBER, SOUND, TOO_FAST
from hydra_actuator.errors import InputError
from hydra_actuator.parameters import Parameters
import numpy as np

DURATION = 0.2
LOOKS, FEWEST_STEPS = 40, 10
ROUNDING = 1e-12
RAN, REFUSED, STOPPED, FAILED = 'ran', 'refused', 'stopped', 'failed'
_NUMBER = re.compile(r'(?<![A-Za-z_])[-+]?\d[\d.]*(e[-+]?\d+)?')


@dataclass(frozen=True)
class Outcome:
    """kind, reason without its numbers, the whole message, share of the 0.2 s that was run."""

    kind: str
    reason: str = ''
    message: str = ''
    share: float = 0.0


def outcome_of(values: dict[str, object], random: np.random.Generator, budget: float) -> Outcome:
    """Return what becomes of a set under a command drawn from `random`; budget: node updates."""
    try:
        parameters = Parameters(values)
        actuator = Actuator(parameters)
    except InputError as error:
        return Outcome(REFUSED, _NUMBER.sub('#', str(error)), str(error))
    # a campaign looks for what nobody thought of
    except Exception as error:
        return Outcome(FAILED, f'{type(error).__name__} at start', repr(error))
    try:
        return run(actuator, random, budget)
    except Exception as error:
        return Outcome(FAILED, type(error).__name__, repr(error))


def run(actuator: Actuator, random: np.random.Generator, budget: float) -> Outcome:
    """Drive an actuator, looking at it from time to time."""
    p = actuator.parameters
    step_time = actuator.step_time
    full = math.ceil(DURATION / step_time)
    nodes = len(actuator.field_labels)
    steps = min(full, max(FEWEST_STEPS, int(budget / nodes)))
    force = p['supply.pressure'] * max(p['cylinder.area_1'], p['cylinder.area_2'])
    schedule = draw_command(steps * step_time, step_time, min(force, 1e9), random)
    done = 0
    with np.errstate(all='ignore'):
        flaw = flaw_of(actuator)
        while not flaw and done < steps:
            count = min(math.ceil(steps / LOOKS), steps - done)
            code = actuator.follow(schedule, count)
            done += count
            if code != SOUND:
                return broken(actuator, code, done / full)
            flaw = flaw_of(actuator)
    if flaw:
        return Outcome(FAILED, flaw, f'{flaw} after {done} steps', done / full)
    return Outcome(RAN, share=done / full)


def broken(actuator: Actuator, code: int, share: float) -> Outcome:
    """Return the outcome of a run that the solver itself has ended."""
    message = actuator.status_message(code)
    if code == NOT_A_NUMBER:
        return Outcome(FAILED, 'NaN', message, share)
    return Outcome(
        STOPPED, 'solver.max_mach' if code == TOO_FAST else 'chamber shorter than a cell',
        message, share)


def flaw_of(actuator: Actuator) -> str:
    """Return what is wrong with what an actuator shows now, or nothing."""
    p, row, channels = actuator.parameters, actuator.row, actuator.channels
    if not np.isfinite(row).all():
        return 'a channel is not finite'
    field = np.empty((len(actuator.field_labels), 2), np.float32)
    actuator.read_field(field)
    if np.isinf(field).any() or (np.isnan(field[:, 0]) != np.isnan(field[:, 1])).any():
        return 'the field is not finite'
    limit = 0.5 * p['cylinder.stroke']
    if abs(row[channels.POSITION]) > limit * (1.0 + ROUNDING):
        return 'the piston is beyond its stops'
    if p['fluid.cavitation']:
        least = p['fluid.vapour_pressure'] - ROUNDING * p['ambient_pressure']
        pressures = np.append(row[channels.pressure], row[channels.lowest_pressure])
        if (pressures < least).any():
            return 'a pressure is below vapour pressure'
        if row[channels.cavity_volume] < 0.0:
            return 'a cavity of negative volume'
    return ''
