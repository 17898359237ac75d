# SPDX-License-Identifier: Apache-2.0
"""Where the outputs of an offline run go: into memory, or into a recording."""

from pathlib import Path

from hydra_actuator.actuator import Actuator
from hydra_actuator.faults.announcements import Announcement, NAME
from hydra_actuator.instruments import Instruments
from hydra_actuator.offline import Due
from hydra_actuator.recording.limits import Limits
from hydra_actuator.recording.messages import diagnostic_array, float64, float64_multi_array
from hydra_actuator.recording.run_data import run_data
from hydra_actuator.recording.tick import AppliedEncoder, FieldEncoder, TickEncoder
from hydra_actuator.recording.topics import ActuatorTopics
from hydra_actuator.recording.writer import RecordingWriter
import numpy as np

NODE = '/actuator'


class Rows:
    """Keeps the states in memory."""

    def __init__(self) -> None:
        """Begin empty."""
        self.rows: list[list[float]] = []

    def take(self, due: Due, reading: list[float], command: list[float]) -> None:
        """Keep the row if a state is due."""
        if due.states:
            self.rows.append(reading)

    def announce(self, news: list[Announcement]) -> None:
        """Keep nothing of it."""

    def close(self) -> None:
        """Do nothing."""


class RunRecording:
    """Writes everything into a recording."""

    def __init__(self, actuator: Actuator, instruments: Instruments, output: str | Path) -> None:
        """Begin a recording in a new directory; RecordingError where that cannot be."""
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

    def take(self, due: Due, reading: list[float], command: list[float]) -> None:
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
