# SPDX-License-Identifier: Apache-2.0
"""
An offline run, as fast as it goes: the node's solver, the node's recording.

Time starts at 0 and the initial state is the first record. An output instant between two steps
is the next step, with its own stamp; faster outputs than the steps are one per step. The command
is evaluated at every step, whatever the outputs are.

Beside the states, a recording holds the command as it stood at each tick and at each state, when
it had changed since: a command that moves with every step is not kept step by step.
"""

from collections.abc import Callable
from contextlib import ExitStack
from dataclasses import dataclass
from functools import cached_property
import math
from pathlib import Path
from typing import NamedTuple, Protocol

from hydra_actuator.actuator import Actuator, SolverError
from hydra_actuator.channels import Channels
from hydra_actuator.errors import InputError
from hydra_actuator.faults.announcements import Announcement, Announcer, NAME
from hydra_actuator.instruments import Instruments
from hydra_actuator.interruption import Interruption
from hydra_actuator.parameters import Parameters
from hydra_actuator.recording.limits import Limits
from hydra_actuator.recording.messages import diagnostic_array, float64, float64_multi_array
from hydra_actuator.recording.reader import load_recording
from hydra_actuator.recording.run_data import run_data
from hydra_actuator.recording.tick import AppliedEncoder, FieldEncoder, TickEncoder
from hydra_actuator.recording.topics import ActuatorTopics
from hydra_actuator.recording.writer import RecordingWriter
from hydra_actuator.signals import Hold, Signal
import numpy as np

NODE = '/actuator'
NEVER = 1 << 62


@dataclass(frozen=True)
class Simulation:
    """What an offline run gave: its recording, or the rows themselves if none was asked for."""

    channels: Channels
    recording: Path | None
    kept_rows: np.ndarray | None = None

    @cached_property
    def rows(self) -> np.ndarray:
        """
        Rows (T, channels.width), one per state.

        A recording is read for them when they are first asked for. What it does not hold is NaN:
        the Mach number, and flow velocities where the sections have another rate.
        """
        if self.kept_rows is not None:
            return self.kept_rows
        return load_recording(self.recording).rows


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


def simulate(parameters: Parameters | None = None, command: Signal | None = None,
             duration: float = 1.0, output: str | Path | None = None, rate: float | None = None,
             progress: Callable[[float], None] | None = None) -> Simulation:
    """
    Run an actuator for `duration` [s].

    command: a signal of hydra_actuator.signals, or None for zero; output: directory of a new
    recording, with which a run of any length takes no more memory; rate [Hz]: of states and
    pressures, else as parameters say; progress: called with the share done.

    Raises SolverError where the method breaks, KeyboardInterrupt on Ctrl-C: what was recorded
    until then is closed and whole. Raises InputError for what cannot be run, ParameterError and
    RecordingError among it, before anything is written.
    """
    if not 0.0 <= duration < math.inf:
        raise InputError(f'duration {duration!r} is not a time of zero or more seconds')
    if rate is not None and not 0.0 < rate < math.inf:
        raise InputError(f'rate {rate!r} is not a positive frequency in Hz')
    with Interruption() as interruption, ExitStack() as closing:
        actuator = Actuator(parameters)
        run = _Run(actuator, Hold() if command is None else command, rate)
        steps = math.ceil(duration / actuator.step_time - 1e-6)
        interruption.hold()
        sink = _Rows() if output is None else _Recording(actuator, run.instruments, output)
        closing.callback(sink.close)
        for step in run.outputs(steps, sink):
            interruption.raise_if_asked()
            if progress is not None:
                progress(step / steps)
    if output is not None:
        return Simulation(actuator.channels, Path(output))
    rows = np.array(sink.rows).reshape(-1, actuator.channels.width)
    return Simulation(actuator.channels, None, rows)


class _Due(NamedTuple):
    """What is to be written at an instant."""

    tick: bool
    states: bool
    pressures: bool
    sections: bool
    field: bool


class _Sink(Protocol):
    """Where outputs go: the row as it is read, the command [spool 1, spool 2, load force]."""

    def take(self, due: _Due, reading: list[float], command: list[float]) -> None: ...
    def announce(self, news: list[Announcement]) -> None: ...
    def close(self) -> None: ...


class _Run:
    """The steps from one output instant to the next, with the commands on the way."""

    def __init__(self, actuator: Actuator, command: Signal, rate: float | None) -> None:
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
        actuator.row[Channels.LOAD_FORCE] = self._now[2]

    def outputs(self, last_step: int, sink: _Sink):
        """Run to a step, hand what is due to the sink, and yield each step where that was so."""
        step = 0
        self._output(step, sink)
        while step < last_step:
            until = min(last_step, *(clock.next_step for clock in self._clocks))
            self._advance(step, until)
            step = until
            self._output(step, sink)
            yield step

    def _advance(self, step: int, until: int) -> None:
        times = np.arange(step + 1, until + 1) * self._actuator.step_time
        commands = self._commands(times)
        code = self._actuator.follow((times, commands, True), until - step)
        if code:
            raise SolverError(self._actuator.status_message(code))
        self._now = commands[-1].tolist()

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

    def _output(self, step: int, sink: _Sink) -> None:
        faults, due = self._actuator.faults, _Due(*(clock.due(step) for clock in self._clocks))
        if faults.edition != self._edition:
            self._edition = faults.edition
            self.instruments.set(self._actuator.parameters, faults.active, faults.enabled)
            sink.announce(self._announcer.news(faults.active))
        sink.take(due, self.instruments.read(self._actuator.row.tolist()), self._now)


class _Rows:
    """Keeps the states in memory."""

    def __init__(self) -> None:
        self.rows: list[list[float]] = []

    def take(self, due: _Due, reading: list[float], command: list[float]) -> None:
        """Keep the row if a state is due."""
        if due.states:
            self.rows.append(reading)

    def announce(self, news: list[Announcement]) -> None:
        """Keep nothing of it."""

    def close(self) -> None:
        """Do nothing."""


class _Recording:
    """Writes everything into a recording."""

    def __init__(self, actuator: Actuator, instruments: Instruments, output: str | Path) -> None:
        p, channels = actuator.parameters, actuator.channels
        self._actuator, self._instruments = actuator, instruments
        topics = ActuatorTopics(NODE, channels.section_names)
        self._topics, self._spools = topics, channels.spools
        self._boils = p['fluid.cavitation']
        joint = p['command.valve_joint']
        joints = [p['command.piston_joint'], joint, f'{joint}_2'][:1 + channels.spools]
        self._tick = TickEncoder(channels, joints, topics)
        self._applied = AppliedEncoder(channels.spools)
        self._field = np.empty((len(actuator.field_labels), 2), np.float32)
        self._field_encoder = FieldEncoder(len(self._field))
        self._command: list[float] = []
        about = run_data('simulate', p.as_yaml(), actuator.section_positions,
                         actuator.field_positions, actuator.field_labels)
        self._writer = RecordingWriter(output, topics.all(), about, p['recording.flush_period'],
                                       compression=p['recording.compression'],
                                       limits=Limits.of(p))
        self.close = self._writer.close

    def take(self, due: _Due, reading: list[float], command: list[float]) -> None:
        """Write what is due, and the command if it has changed."""
        actuator, instruments, topics = self._actuator, self._instruments, self._topics
        time, row = actuator.time, actuator.row.tolist()
        stamp = round(time * 1e9)
        messages: list[tuple[str, bytes]] = []
        if (due.tick or due.states) and command != self._command:
            messages += self._command_messages(actuator.tick, command)
        if due.states:
            messages.append((topics.joint_states, self._tick.joint_state(reading, stamp)))
            if instruments.acting:
                messages.append((topics.true_joint_states, self._tick.joint_state(row, stamp)))
        if due.pressures:
            messages += self._tick.pressures(reading, stamp, instruments.variance)
        if due.sections:
            messages.append((topics.sections, self._tick.sections(row, stamp)))
        if due.sections and self._boils:
            messages.append((topics.cavities, self._tick.cavities(row, stamp)))
        if due.field:
            actuator.read_field(self._field)
            messages.append((topics.field, self._field_encoder.encode(time, self._field)))
        self._writer.write_batch([(topic, stamp, stamp, data) for topic, data in messages])

    def announce(self, news: list[Announcement]) -> None:
        """Write an event for each fault that has begun, changed or ended."""
        stamp = round(self._actuator.time * 1e9)
        self._writer.write_batch([
            (self._topics.events, stamp, stamp, diagnostic_array(
                stamp, [(level, f'{NODE}: {NAME}', message, NODE, values)]))
            for level, message, values in news])

    def _command_messages(self, tick: int, command: list[float]) -> list[tuple[str, bytes]]:
        """Return what is applied, and those of the commands that are other than before."""
        topics, before = self._topics, self._command
        self._command = command
        spools, load_force = command[:self._spools], command[2]
        messages = [(topics.applied, self._applied.encode(tick, spools, load_force))]
        if spools != before[:self._spools]:
            messages.append((topics.spool_command, float64(spools[0])) if len(spools) == 1 else
                            (topics.commands, float64_multi_array(spools)))
        if [load_force] != before[2:]:
            messages.append((topics.load_force, float64(load_force)))
        return messages
