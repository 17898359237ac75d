# SPDX-License-Identifier: Apache-2.0
"""A made-up run with a known shape: stations, field and piston follow plain formulas."""

import json
from pathlib import Path

from hydra_actuator.analysis.series import Command, Field, Report, Series
from hydra_actuator.analysis.streamline import DOMAINS, piston_faces
from hydra_actuator.channels import Channels, STATIONS
from hydra_actuator.recording import messages
from hydra_actuator.recording.tick import FieldEncoder, TickEncoder
from hydra_actuator.recording.topics import ActuatorTopics
from hydra_actuator.recording.writer import RecordingWriter
import numpy as np
import pytest

FREQUENCY = 50.0
STATION_POSITIONS = np.array([0, 0.6, 0.6, 0.8, 0.8, 1, 1, 1.2, 1.2, 1.4, 1.4, 2.0])


def level(domain: str, time):
    """Return the pressure [Pa] of a domain: the same all along it."""
    swing = 5e6 * np.sin(2 * np.pi * FREQUENCY * np.asarray(time))
    return {
        'supply_line': 21e6 + 0 * swing, 'line_1': 11e6 + swing, 'chamber_1': 11e6 + swing,
        'chamber_2': 11e6 - swing, 'line_2': 11e6 - swing, 'return_line': 2.5e6 + 0 * swing,
    }[domain]


def made_field(time: np.ndarray, piston: np.ndarray, spacing: float = 0.02) -> Field:
    """Return a field on an even mesh; what the piston has left behind is NaN."""
    ends = [(0, 0.6), (0.6, 0.8), (0.8, 1.1), (0.9, 1.2), (1.2, 1.4), (1.4, 2.0)]
    places, labels = [], []
    for domain, (first, last) in zip(DOMAINS, ends):
        nodes = list(np.linspace(first, last, round((last - first) / spacing) + 1))
        nodes += [1.0] * (domain == 'chamber_1')
        nodes = [1.0] * (domain == 'chamber_2') + nodes
        places += nodes
        labels += [domain] * len(nodes)
    places, labels = np.array(places), tuple(labels)
    faces = piston_faces(labels)
    pressure = np.stack([level(domain, time) for domain in labels], axis=1)
    face = 1.0 + piston[:, None]
    moving = np.isin(np.arange(len(places)), faces)
    labelled = np.array(labels)
    behind = ((labelled == 'chamber_1') & ~moving & (places > face)) | (
        (labelled == 'chamber_2') & ~moving & (places < face))
    pressure[behind] = np.nan
    velocity = np.where(behind, np.nan, 0.1)
    return Field(time, places, labels, pressure, velocity, faces, 'the field')


def made_run(duration: float = 1.0, field_rate: float = 1000.0) -> Series:
    """Return a run at 1 kHz whose piston moves at 50 Hz."""
    time = np.arange(round(duration * 1000) + 1) / 1000
    angle = 2 * np.pi * FREQUENCY * time
    position = 0.012 * np.sin(angle)
    frames = np.arange(round(duration * field_rate) + 1) / field_rate
    reports = tuple(
        Report(float(k), '/actuator: Real time', 0, 'in time',
               {'ticks': str(k * 1000), 'overruns': str(k), 'lateness_p50': '60',
                'lateness_p99': '140', 'lateness_max': '900'})
        for k in range(1, 4)
    )
    return Series(
        name='made_run', time=time, position=position, velocity=np.gradient(position, time),
        spool=5e-4 * np.sin(angle)[:, None], load_force=np.zeros(len(time)),
        section_names=STATIONS, section_positions=STATION_POSITIONS,
        pressure=np.stack([level(DOMAINS[k // 2], time) for k in range(12)], axis=1),
        flow_velocity=np.full((len(time), 12), 0.1),
        stamps=(1_700_000_000_000_000_000 + np.arange(len(time)) * 1_000_000),
        field=made_field(frames, np.interp(frames, time, position)),
        commands=(Command('/actuator/spool_command', time, np.sin(angle)[:, None]),),
        diagnostics=reports, send_delay=np.full(len(time), 1e-4),
        parameters={'valve.stroke': 5e-4, 'tank.pressure': 2.4e6},
        versions={'hydra_actuator': '0.1.0'}, source='node',
    )


def as_recording(run: Series, directory: Path, **options) -> Path:
    """Write a run as the node would, options as the writer's, and return its directory."""
    topics = ActuatorTopics('/actuator', run.section_names)
    custom_data = {
        'parameters': '/**:\n  ros__parameters:\n    valve: {stroke: 5.0e-4}\n'
                      '    tank: {pressure: 2.4e6}\n',
        'versions': json.dumps(run.versions), 'source': run.source,
        'section_positions': json.dumps(run.section_positions.tolist()),
        'field_positions': json.dumps(run.field.positions.tolist()),
        'field_labels': json.dumps(run.field.labels),
    }
    start, delay = int(run.stamps[0]), round(run.send_delay[0] * 1e9)
    found = [(topic, stamp, stamp + delay, message)
             for stamp, row in zip(run.stamps.tolist(), _rows(run))
             for topic, message in row]
    if run.cavities is not None:
        found += _cavities(run, topics)
    found += [(topics.spool_command, start + round(t * 1e9), start + round(t * 1e9),
               messages.float64(value)) for t, (value,) in
              zip(run.commands[0].time, run.commands[0].values)]
    encode = FieldEncoder(len(run.field.positions)).encode
    for t, pressure, velocity in zip(run.field.time, run.field.pressure, run.field.velocity):
        stamp = start + round(t * 1e9)
        frame = np.stack([pressure, velocity], axis=1).astype(np.float32)
        found.append((topics.field, stamp, stamp, encode(float(t), frame)))
    for report in run.diagnostics:
        stamp = start + round(report.time * 1e9)
        status = (report.level, report.name, report.message, 'hydra_actuator', report.values)
        found.append((topics.diagnostics, stamp, stamp,
                      messages.diagnostic_array(stamp, [status])))
    with RecordingWriter(directory, topics.all(), custom_data, **options) as writer:
        writer.write_batch(sorted(found, key=lambda message: message[1]))
    return directory


def _cavities(run: Series, topics: ActuatorTopics) -> list:
    """Return the messages about cavities, one per state."""
    channels, found = Channels(run.section_names, 1), []
    encoder = TickEncoder(channels, ('piston_joint', 'valve_joint'), topics)
    row = channels.empty_row()
    for tick, stamp in enumerate(run.stamps.tolist()):
        for name in ('open', 'opened', 'collapsed'):
            row[getattr(channels, f'cavities_{name}')] = getattr(run.cavities, name)[tick]
        row[channels.cavity_volume] = run.cavities.volume[tick]
        row[channels.domain_cavities] = run.cavities.of_domain[tick]
        found.append((topics.cavities, stamp, stamp, encoder.cavities(row.tolist(), stamp)))
    return found


def _rows(run: Series):
    """Yield the messages of each state."""
    channels = Channels(run.section_names, 1)
    encoder = TickEncoder(channels, ('piston_joint', 'valve_joint'),
                          ActuatorTopics('/actuator', run.section_names))
    row = channels.empty_row()
    for tick, stamp in enumerate(run.stamps.tolist()):
        row[channels.POSITION], row[channels.VELOCITY] = run.position[tick], run.velocity[tick]
        row[channels.SPOOL_1] = row[channels.SPOOL_2] = run.spool[tick, 0]
        row[channels.pressure] = run.pressure[tick]
        row[channels.flow_velocity] = run.flow_velocity[tick]
        yield encoder.encode(row, stamp)


@pytest.fixture
def record(tmp_path):
    """Return a function that writes a run as a recording and returns its directory."""
    return lambda run, name='made_run', **options: as_recording(run, tmp_path / name, **options)


@pytest.fixture
def make_run():
    """Return the maker of runs: (duration [s], rate of the field [Hz]) to Series."""
    return made_run


@pytest.fixture
def run() -> Series:
    """Return a run of one second with everything in it."""
    return made_run()
