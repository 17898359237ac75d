# SPDX-License-Identifier: Apache-2.0
"""
Read a recording into the series that the figures show.

What the recording does not hold stays empty. InputError names what makes it unusable: no such
recording, no states, custom data that does not fit its topics.
"""

import json
from pathlib import Path
from tempfile import TemporaryDirectory

from hydra_actuator.analysis.frames import Frames, PRESSURE, VELOCITY
from hydra_actuator.analysis.series import Cavities, Command, Field, Report, Series
from hydra_actuator.analysis.streamline import piston_faces
from hydra_actuator.errors import InputError
from hydra_actuator.parameters import read_parameter_file
from hydra_actuator.recording.reader import load_recording, Recording
import numpy as np

JOINT_COMMANDS = '/joint_commands'


def series_of(path: str | Path) -> Series:
    """Return the series of a recording; raises InputError."""
    recording = load_recording(path)
    if not len(recording.row_stamps):
        raise InputError(f'{path} holds no joint states: there is nothing to report')
    channels, parameters = recording.channels, recorded_parameters(recording)
    sections, spools = len(channels.section_names), channels.spools
    first = 3 + spools
    rows = recording.columns([
        channels.POSITION, channels.VELOCITY, channels.LOAD_FORCE,
        *range(channels.SPOOL_1, channels.SPOOL_1 + spools),
        *range(channels.pressure.start, channels.flow_velocity.stop)])
    return Series(
        name=recording.path.resolve().name, path=recording.path, time=recording.time,
        position=rows[:, 0], velocity=rows[:, 1], load_force=rows[:, 2], spool=rows[:, 3:first],
        section_names=channels.section_names, section_positions=_section_positions(recording),
        pressure=rows[:, first: first + sections], flow_velocity=rows[:, first + sections:],
        stamps=recording.row_stamps, field=_field(recording),
        commands=_commands(recording, parameters), diagnostics=_reports(recording),
        send_delay=_send_delay(recording), parameters=parameters,
        versions=_json_of(recording, 'versions', {}),
        cavities=_cavities(recording), source=recording.custom_data.get('source', ''),
    )


def recorded_parameters(recording: Recording) -> dict:
    """Return the parameters the recording was made with, by dotted name; {} if it has none."""
    text = recording.custom_data.get('parameters')
    if not text:
        return {}
    with TemporaryDirectory() as directory:
        path = Path(directory) / 'parameters.yaml'
        path.write_text(text, encoding='utf-8')
        try:
            return read_parameter_file(path)
        except InputError as error:
            reason = str(error).removeprefix(f'{path}: ')
        raise InputError(f'{recording.path}: its parameters are not readable: {reason}')


def _json_of(recording: Recording, key: str, missing):
    """Return an entry of the custom data that is JSON."""
    try:
        return json.loads(recording.custom_data[key])
    except KeyError:
        return missing
    except ValueError:
        raise InputError(f'{recording.path}: its {key} are not readable') from None


def _section_positions(recording: Recording) -> np.ndarray:
    """Return x [m] of the sections; empty where the recording does not tell all of them."""
    places = recording.section_positions
    return places if len(places) == len(recording.channels.section_names) else np.empty(0)


def _field(recording: Recording) -> Field | None:
    """Return the field, or None if there is none."""
    time, reader = recording.field_time, recording.field_reader
    if not len(time):
        return None
    places, labels = recording.field_positions, tuple(recording.field_labels)
    if not len(places) == len(labels) == reader.nodes:
        raise InputError(
            f'{recording.path}: its field has {reader.nodes} nodes, but positions for '
            f'{len(places)} and labels for {len(labels)}'
        )
    every = np.arange(len(time))
    pressure, velocity = (Frames(reader, part, every) for part in (PRESSURE, VELOCITY))
    return Field(time, places, labels, pressure, velocity, piston_faces(labels), 'the field')


def _cavities(recording: Recording) -> Cavities | None:
    """Return the cavities over time, or None if there are none in the recording."""
    stamps, values = recording.cavities
    channels = recording.channels
    if not len(stamps):
        return None
    first = channels.cavities.start

    def column(index: int) -> np.ndarray:
        return values[:, index - first]
    return Cavities(
        (stamps - recording.row_stamps[0]) * 1e-9, column(channels.cavity_volume),
        column(channels.cavities_open), column(channels.cavities_opened),
        column(channels.cavities_collapsed), channels.domains,
        values[:, channels.domain_cavities.start - first:],
    )


def _commands(recording: Recording, parameters: dict) -> tuple[Command, ...]:
    """Return the received commands; joint commands as spool positions over the stroke."""
    origin = recording.row_stamps[0]
    found = []
    for topic, (stamps, values) in recording.commands.items():
        if topic.endswith(JOINT_COMMANDS):
            values = _valve_positions(recording, topic, values) / parameters.get('valve.stroke', 1)
        found.append(Command(topic, (stamps - origin) * 1e-9, values))
    return tuple(found)


def _valve_positions(recording: Recording, topic: str, values: np.ndarray) -> np.ndarray:
    """Return the positions [m] that a topic of joint states commands the valve's joints."""
    names = next(recording.messages(topic))['name']
    columns = [names.index(name) for name in recording.joint_names[1:] if name in names]
    return values[:, [k for k in columns if k < values.shape[1]]]


def _reports(recording: Recording) -> tuple[Report, ...]:
    """Return every status of /diagnostics and of the events."""
    origin = int(recording.row_stamps[0])
    return tuple(
        Report(
            (message['log_ns'] - origin) * 1e-9, status['name'], status['level'],
            status['message'], {pair['key']: pair['value'] for pair in status['values']},
        )
        for message in recording.diagnostics for status in message['status']
    )


def _send_delay(recording: Recording) -> np.ndarray:
    """Return how long after its stamp each joint state was sent [s]."""
    for topic, summary in recording.topics.items():
        if topic.endswith('/joint_states') and summary.count == len(recording.row_stamps):
            states = recording.series(topic)
            return (states.publish_stamps - states.stamps) * 1e-9
    return np.empty(0)
