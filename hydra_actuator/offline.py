# SPDX-License-Identifier: Apache-2.0
"""
The steps of an offline run: from one output instant to the next, with the commands on the way.

Who advances the actuator is left to the caller: alone, or side by side with others.
"""

from collections.abc import Generator
import math
from typing import NamedTuple, Protocol

from hydra_actuator.actuator import Actuator, SolverError
from hydra_actuator.channels import Channels
from hydra_actuator.errors import InputError
from hydra_actuator.faults.announcements import Announcement, Announcer
from hydra_actuator.instruments import Instruments
from hydra_actuator.signals import Signal
import numpy as np

NEVER = 1 << 62
# Steps whose commands are evaluated at once.
AHEAD = 4096


class OutputClock:
    """The steps at which something that is due `rate` times a second is written."""

    def __init__(self, rate: float, step_time: float) -> None:
        """Start at step 0; a rate of 0 Hz is never."""
        self._interval = 1.0 / max(rate * step_time, 1.0 / NEVER)
        self._count = 0
        self.next_step = 0 if rate > 0.0 else NEVER

    def due(self, step: int) -> bool:
        """Return whether an output is due at a step, and move on to the next if so."""
        if step < self.next_step:
            return False
        self._count += 1
        instant = math.ceil(self._count * self._interval - 1e-6)
        self.next_step = max(step + 1, instant)
        return True


class Due(NamedTuple):
    """What is to be written at an instant."""

    tick: bool
    states: bool
    pressures: bool
    sections: bool
    field: bool


class Sink(Protocol):
    """Where outputs go: the row as it is read, the command [spool 1, spool 2, load force]."""

    def take(self, due: Due, reading: list[float], command: list[float]) -> None:
        """Take what is due of a state."""

    def announce(self, news: list[Announcement]) -> None:
        """Take note of faults that have begun, changed or ended."""

    def close(self) -> None:
        """End."""


class Stretch(NamedTuple):
    """Steps to do under a schedule, as Actuator.follow takes both."""

    schedule: tuple[np.ndarray, np.ndarray, bool]
    steps: int


class Ahead:
    """Commands of the steps of a run, evaluated for many steps at once."""

    def __init__(self, command: Signal, step_time: float, last_step: int) -> None:
        """Take a command that gives (T, 3) for times (T,) [s], and the run's last step."""
        self._command, self._step_time, self._last = command, step_time, last_step
        self._first, self._times, self._commands = 0, np.empty(0), np.empty((0, 3))

    def between(self, step: int, until: int) -> tuple[np.ndarray, np.ndarray]:
        """Return times [s] and commands of the steps after `step` up to `until`."""
        if until > self._first + len(self._times):
            try:
                self._evaluate(step, min(self._last, max(until, step + AHEAD)))
            except InputError:
                # further on; what comes before it is still to be done
                self._evaluate(step, until)
        part = slice(step - self._first, until - self._first)
        return self._times[part], self._commands[part]

    def _evaluate(self, step: int, until: int) -> None:
        times = np.arange(step + 1, until + 1) * self._step_time
        self._commands = self._command(times)
        self._first, self._times = step, times


def next_stretch(stretches: Generator[Stretch, int, None],
                 code: int | None = None) -> Stretch | None:
    """Give a run the status code of its last stretch; return the next one, None at the end."""
    try:
        return stretches.send(code)
    except StopIteration:
        return None


class Run:
    """An actuator, its commands and its outputs."""

    def __init__(self, actuator: Actuator, command: Signal, rate: float | None) -> None:
        """Begin at step 0; rate [Hz]: of states and pressures, else as parameters say."""
        p = actuator.parameters
        self._actuator, self._command = actuator, command
        self.instruments = Instruments(
            actuator.channels, actuator.step_time, actuator.steps_per_period)
        self._edition = -1
        self._announcer = Announcer()
        own = (p['publish.rate'], p['publish.pressure_rate']) if rate is None else (rate, rate)
        rates = (1.0 / actuator.period, *own, p['publish.sections_rate'],
                 p['recording.field_rate'])
        self._clocks = [OutputClock(one, actuator.step_time) for one in rates]
        self._now = self._commands(np.zeros(1))[0].tolist()
        self.step = 0
        actuator.row[Channels.LOAD_FORCE] = self._now[2]

    def stretches(self, last_step: int, sink: Sink) -> Generator[Stretch, int, None]:
        """
        Yield what is to be done up to a step, take its status code, hand what is due to the sink.

        Raises SolverError for a code that is not sound, InputError for a command out of range.
        """
        ahead = Ahead(self._commands, self._actuator.step_time, last_step)
        self._output(sink)
        while self.step < last_step:
            until = min(last_step, *(clock.next_step for clock in self._clocks))
            times, commands = ahead.between(self.step, until)
            code = yield Stretch((times, commands, True), until - self.step)
            if code:
                raise SolverError(self._actuator.status_message(code))
            self._now = commands[-1].tolist()
            self.step = until
            self._output(sink)

    def _commands(self, times: np.ndarray) -> np.ndarray:
        commands = np.asarray(self._command(times), float)
        if commands.shape != (len(times), 3):
            raise InputError(f'the command gives an array of shape {commands.shape} for '
                             f'{len(times)} times, not {(len(times), 3)}')
        sound = (np.abs(commands[:, :2]) <= 1.0).all(axis=1) & np.isfinite(commands[:, 2])
        for k in np.flatnonzero(~sound):
            raise InputError(f'the command {commands[k].tolist()} at {times[k]:g} s is not two '
                             'spools from -1 to 1 and a finite load')
        return commands

    def _output(self, sink: Sink) -> None:
        faults = self._actuator.faults
        due = Due(*(clock.due(self.step) for clock in self._clocks))
        if faults.edition != self._edition:
            self._edition = faults.edition
            self.instruments.set(self._actuator.parameters, faults.active, faults.enabled)
            sink.announce(self._announcer.news(faults.active))
        sink.take(due, self.instruments.read(self._actuator.row.tolist()), self._now)
