# SPDX-License-Identifier: Apache-2.0
"""
An offline run, as fast as it goes: the node's solver, the node's recording.

Time starts at 0 and the initial state is the first record. An output instant between two steps
is the next step, with its own stamp. Commands are evaluated at every step.
"""

from collections.abc import Callable
from dataclasses import dataclass
import math
from pathlib import Path

from hydra_actuator.actuator import Actuator, SolverError
from hydra_actuator.channels import Channels
from hydra_actuator.parameters import Parameters
from hydra_actuator.recording.messages import float64
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
    """Rows (T, channels.width) of an offline run, their channels, and its recording if any."""

    rows: np.ndarray
    channels: Channels
    recording: Path | None


class OutputClock:
    """The steps at which something that is due `rate` times a second is written."""

    def __init__(self, rate: float, step_time: float) -> None:
        """Start at step 0; a rate of 0 Hz is never."""
        self._interval = 1.0 / (rate * step_time) if rate > 0.0 else math.inf
        self._count = 0
        self.next_step = 0 if rate > 0.0 else NEVER

    def due(self, step: int) -> bool:
        """Return whether an output is due at a step, and move on to the next if so."""
        if step < self.next_step:
            return False
        self._count += 1
        self.next_step = math.ceil(self._count * self._interval - 1e-6)
        return True


def simulate(parameters: Parameters | None = None, command: Signal | None = None,
             duration: float = 1.0, output: str | Path | None = None, rate: float | None = None,
             progress: Callable[[float], None] | None = None) -> Simulation:
    """
    Run an actuator for `duration` [s] and return its rows.

    command: a signal of hydra_actuator.signals, or None for zero; output: directory of a new
    recording; rate [Hz]: of states and pressures, else as parameters say; progress: called with
    the share done. Raises SolverError where the method breaks (what was recorded until then is
    kept), RecordingError for an output that exists.
    """
    actuator = Actuator(parameters)
    run = _Run(actuator, Hold() if command is None else command, rate)
    steps = math.ceil(duration / actuator.step_time - 1e-6)
    if output is None:
        run.to(steps, progress)
        return Simulation(np.array(run.rows), actuator.channels, None)
    topics = ActuatorTopics(NODE, actuator.channels.section_names)
    with RecordingWriter(output, topics.all(), _run_data(actuator)) as writer:
        run.write_to(writer, topics)
        run.to(steps, progress)
    return Simulation(np.array(run.rows), actuator.channels, Path(output))


class _Run:
    """The loop over output instants."""

    def __init__(self, actuator: Actuator, command: Signal, rate: float | None) -> None:
        p = actuator.parameters
        self.rows: list[np.ndarray] = []
        self._actuator, self._command = actuator, command
        self._step = 0
        self._writer: RecordingWriter | None = None
        rates = (p['publish.rate'] if rate is None else rate,
                 p['publish.pressure_rate'] if rate is None else rate,
                 p['publish.sections_rate'], p['recording.field_rate'])
        self._states, self._pressures, self._sections, self._fields = (
            OutputClock(frequency, actuator.step_time) for frequency in rates)

    def write_to(self, writer: RecordingWriter, topics: ActuatorTopics) -> None:
        """Record from now on."""
        actuator, p = self._actuator, self._actuator.parameters
        joints = [p['command.piston_joint'], *_valve_joints(p)]
        self._writer, self._topics = writer, topics
        self._tick = TickEncoder(actuator.channels, joints, topics)
        self._applied = AppliedEncoder(p['valve.spools'])
        self._field = np.empty((len(actuator.field_labels), 2), np.float32)
        self._field_encoder = FieldEncoder(len(self._field))

    def to(self, last_step: int, progress: Callable[[float], None] | None) -> None:
        """Run to a step, outputs on the way included."""
        self._output()
        clocks = (self._states, self._pressures, self._sections, self._fields)
        while self._step < last_step:
            until = min(last_step, self._step + self._actuator.steps_per_period,
                        *(clock.next_step for clock in clocks))
            self._advance(until)
            self._output()
            if progress is not None:
                progress(self._step / last_step)

    def _advance(self, until: int) -> None:
        times = np.arange(self._step + 1, until + 1) * self._actuator.step_time
        commands = self._command(times)
        code = self._actuator.follow((times, commands, True), until - self._step)
        if code:
            raise SolverError(self._actuator.status_message(code))
        self._step = until

    def _output(self) -> None:
        actuator, step = self._actuator, self._step
        states, pressures = self._states.due(step), self._pressures.due(step)
        sections, field = self._sections.due(step), self._fields.due(step)
        if states:
            self.rows.append(actuator.row.copy())
        if self._writer is None:
            return
        stamp = round(actuator.time * 1e9)
        row = actuator.row.tolist()
        topics, messages = self._topics, []
        if states:
            messages.append((topics.joint_states, self._tick.joint_state(row, stamp)))
            messages += self._command_messages(stamp)
        if pressures:
            messages += self._tick.pressures(row, stamp)
        if sections:
            messages.append((topics.sections, self._tick.sections(row, stamp)))
        if field:
            actuator.read_field(self._field)
            messages.append(
                (topics.field, self._field_encoder.encode(actuator.time, self._field)))
        self._writer.write_batch([(topic, stamp, stamp, data) for topic, data in messages])

    def _command_messages(self, stamp: int) -> list[tuple[str, bytes]]:
        command = self._command(np.array([self._actuator.time]))[0]
        spools = command[:self._actuator.channels.spools].tolist()
        return [
            (self._topics.spool_command, float64(spools[0])),
            (self._topics.load_force, float64(float(command[2]))),
            (self._topics.applied,
             self._applied.encode(self._actuator.tick, spools, float(command[2])))]


def _run_data(actuator: Actuator) -> dict[str, str]:
    return run_data('simulate', actuator.parameters.as_yaml(), actuator.section_positions,
                    actuator.field_positions, actuator.field_labels)


def _valve_joints(p: Parameters) -> list[str]:
    first = p['command.valve_joint']
    return [first] if p['valve.spools'] == 1 else [first, f'{first}_2']
