# SPDX-License-Identifier: Apache-2.0
"""A recording of made-up rows, written as the node and the offline run write theirs."""

from collections.abc import Callable
import json
from pathlib import Path

from hydra_actuator.channels import Channels
from hydra_actuator.recording import messages
from hydra_actuator.recording.tick import AppliedEncoder, FieldEncoder, TickEncoder
from hydra_actuator.recording.topics import ActuatorTopics
from hydra_actuator.recording.writer import RecordingWriter
import numpy as np
import pytest

START = 1_763_877_600_000_000_000
PERIOD = 1_000_000
SECTIONS = ('O', 'A', 'K')
NODES = 7
CUSTOM_DATA = {
    'parameters': '/**:\n  ros__parameters:\n    supply:\n      pressure: 1.8e7\n',
    'versions': '{"hydra_actuator": "0.1.0"}',
    'source': 'simulate',
    'field_positions': json.dumps([0.1 * node for node in range(NODES)]),
    'field_labels': json.dumps(['supply_line'] * NODES),
    'section_positions': json.dumps([0.0, 0.6, 2.0]),
}


class Made:
    """What was written: the rows, their stamps, the fields, and the directory."""

    def __init__(self, directory: Path, ticks: int, spools: int):
        self.directory = directory
        self.topics = ActuatorTopics('/ns/actuator', SECTIONS)
        self.channels = Channels(SECTIONS, spools)
        random = np.random.default_rng(7)
        self.rows = random.normal(size=(ticks, self.channels.width))
        self.rows[:, self.channels.TIME] = np.arange(ticks) * PERIOD / 1e9
        self.stamps = START + np.arange(ticks) * PERIOD
        self.fields = random.normal(size=(ticks // 5 + 1, NODES, 2)).astype(np.float32)
        self.fields[0, 2] = np.nan

    def messages(self) -> list:
        """Return everything in the order of time, publish time 20 us after log time."""
        names = ('piston_joint', 'valve_joint', 'valve_joint_2')[: 1 + self.channels.spools]
        tick_encoder = TickEncoder(self.channels, names, self.topics)
        applied = AppliedEncoder(self.channels.spools)
        field = FieldEncoder(NODES)
        found = []
        for tick, (row, stamp) in enumerate(zip(self.rows, self.stamps.tolist())):
            batch = tick_encoder.encode(row, stamp)
            batch.append((self.topics.cavities, tick_encoder.cavities(row, stamp)))
            if tick % 10 == 0:
                spools = [tick / 1000.0] * self.channels.spools
                batch.append((self.topics.applied, applied.encode(tick, spools, 5.0 * tick)))
                batch.append((self.topics.spool_command, messages.float64(tick / 1000.0)))
            if tick % 5 == 0:
                batch.append((self.topics.field, field.encode(tick * 1e-3,
                                                              self.fields[tick // 5])))
            found += [(topic, stamp, stamp + 20_000, data) for topic, data in batch]
        level = messages.diagnostic_array(START, [(0, '/ns/actuator: Solver', 'ok', 'x', {})])
        return [(self.topics.diagnostics, START, START, level), *found]


@pytest.fixture
def make_recording(tmp_path) -> Callable[..., Made]:
    """Return a function that writes a recording and returns what is in it."""

    def make(ticks: int = 50, spools: int = 1, name: str = 'run', **options) -> Made:
        made = Made(tmp_path / name, ticks, spools)
        with RecordingWriter(made.directory, made.topics.all(), CUSTOM_DATA, **options) as writer:
            writer.write_batch(made.messages())
        return made

    return make
