# SPDX-License-Identifier: Apache-2.0
"""
A recording as arrays over time.

    recording = load_recording('recordings/actuator_20250101_120000')
    recording.time, recording.rows[:, recording.channels.POSITION]
    recording.dataset.pressure.sel(station='A')

Opening reads no message; each array is made when it is first asked for. Unfinished recordings
open too, up to where they were cut off, and so does a lone MCAP file.

Rows are put together again by `rows`; time counts from the first joint state.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
import json
from pathlib import Path
from typing import TYPE_CHECKING

from hydra_actuator.channels import Channels
from hydra_actuator.recording import labelled, messages
from hydra_actuator.recording.errors import RecordingError
from hydra_actuator.recording.frames import FieldReader, frames_of
from hydra_actuator.recording.metadata import FILE_NAME, mcap_files, read_metadata
from hydra_actuator.recording.opening import CUSTOM_DATA
from hydra_actuator.recording.rows import StateTopics
from hydra_actuator.recording.scan import scan, ScannedFile
from hydra_actuator.recording.series import Series
import numpy as np

if TYPE_CHECKING:
    import xarray

COMMANDS = ('/spool_command', '/commands', '/joint_commands', '/load_force')


@dataclass(frozen=True)
class TopicSummary:
    """A topic's message type and how many messages the recording holds of it."""

    type: str
    count: int


class Recording:
    """What `load_recording` returns; attributes are read from the files when first used."""

    def __init__(self, path: Path, files: list[ScannedFile], custom_data: Mapping[str, str]):
        self.path = path
        self.custom_data = dict(custom_data)
        self.files = [file.path for file in files]
        self.finished = all(file.finished for file in files)
        self._series = _series(files)
        self.topics = {
            name: TopicSummary(series.type, len(series)) for name, series in self._series.items()
        }

    @cached_property
    def start_ns(self) -> int:
        """Log time of the earliest message [ns]; 0 if there is none."""
        return min((int(s.stamps.min()) for s in self._series.values() if len(s)), default=0)

    @cached_property
    def end_ns(self) -> int:
        """Log time of the latest message [ns]; 0 if there is none."""
        return max((int(s.stamps.max()) for s in self._series.values() if len(s)), default=0)

    def messages(self, topic: str) -> Iterator[dict]:
        """Yield the messages of a topic as dictionaries."""
        return self.series(topic).decoded()

    def series(self, topic: str) -> Series:
        """Return the messages of a topic with their times; RecordingError for an unknown one."""
        if topic not in self._series:
            raise RecordingError(f'{self.path} has no topic {topic}')
        return self._series[topic]

    @cached_property
    def channels(self) -> Channels:
        """The columns of `rows`, by the sections and spools that were recorded."""
        try:
            return self._state.channels()
        except ValueError as error:
            raise RecordingError(f'{self.path}: {error}') from None

    @cached_property
    def joint_names(self) -> list[str]:
        """The piston's joint, then one per spool."""
        return self._state.joints.first()['name'] if len(self._state.joints) else []

    @cached_property
    def row_stamps(self) -> np.ndarray:
        """Stamp of each row [ns], int64."""
        return self._state.joints.stamps

    @cached_property
    def time(self) -> np.ndarray:
        """Time of each row [s] since the first."""
        stamps = self.row_stamps
        return (stamps - stamps[:1]) / 1e9

    @cached_property
    def rows(self) -> np.ndarray:
        """Observation rows, shape (instants, channels.width)."""
        return self._state.rows(self.channels)

    def columns(self, wanted: Sequence[int]) -> np.ndarray:
        """Return these columns of `rows` alone, shape (instants, columns), and keep none."""
        return self._state.rows(self.channels, wanted)

    @cached_property
    def commands(self) -> dict[str, tuple[np.ndarray, np.ndarray]]:
        """By topic: receive times [ns], and the values of each message as a row."""
        return {
            name: (series.stamps, series.numbers()) for name, series in self._series.items()
            if name.endswith(COMMANDS) and len(series)
        }

    @cached_property
    def applied(self) -> tuple[np.ndarray, np.ndarray]:
        """Stamps [ns], and [tick, spool commands, load force] as the solver took them."""
        series = self._state.applied
        return series.stamps, series.numbers()

    @cached_property
    def cavities(self) -> tuple[np.ndarray, np.ndarray]:
        """Stamps [ns], and values in the order of `channels.cavity_names()`; none without gas."""
        series = self._one('/cavities', messages.FLOAT64_ARRAY)
        width = len(self.channels.cavity_names())
        return series.stamps, series.numbers()[:, 1:] if len(series) else np.empty((0, width))

    @cached_property
    def field(self) -> np.ndarray:
        """Absolute pressure [Pa] and velocity [m/s], float32, shape (frames, nodes, 2)."""
        return frames_of(self._field.numbers())

    @cached_property
    def field_reader(self) -> FieldReader:
        """The frames of `field`, some at a time; it outlives the recording."""
        return FieldReader(self._field)

    @cached_property
    def field_stamps(self) -> np.ndarray:
        """Stamp of each frame [ns], int64."""
        return self._field.stamps

    @cached_property
    def field_time(self) -> np.ndarray:
        """Time of each frame [s], counted like `time`."""
        stamps = self.field_stamps
        origin = self.row_stamps[:1] if len(self.row_stamps) else stamps[:1]
        return (stamps - origin) / 1e9

    @cached_property
    def field_positions(self) -> np.ndarray:
        """Place of each node of the field along the streamline [m]."""
        return np.array(self._json('field_positions'), float)

    @cached_property
    def field_labels(self) -> list[str]:
        """Domain of each node of the field."""
        return list(self._json('field_labels'))

    @cached_property
    def section_positions(self) -> np.ndarray:
        """Place of each section along the streamline [m]."""
        return np.array(self._json('section_positions'), float)

    @cached_property
    def dataset(self) -> 'xarray.Dataset':
        """The states as labelled arrays over time and station; needs xarray. See `labelled`."""
        return labelled.states(self)

    @cached_property
    def field_dataset(self) -> 'xarray.Dataset':
        """The field as labelled arrays over time and node; needs xarray. See `labelled`."""
        return labelled.field(self)

    @cached_property
    def diagnostics(self) -> list[dict]:
        """All messages of /diagnostics and of the events, in the order of their log times."""
        found = []
        for name, series in self._series.items():
            if series.type == messages.DIAGNOSTICS and len(series):
                stamps = series.stamps.tolist()
                found += [
                    (stamp, {'topic': name, 'log_ns': stamp, **message})
                    for stamp, message in zip(stamps, series.decoded())
                ]
        return [message for _, message in sorted(found, key=lambda pair: pair[0])]

    @cached_property
    def _field(self) -> Series:
        return self._one('/field', messages.FLOAT32_ARRAY)

    @cached_property
    def _state(self) -> StateTopics:
        return StateTopics(
            self._one('/joint_states', messages.JOINT_STATE),
            self._one('/sections', messages.FLOAT64_ARRAY),
            self._one('/applied', messages.FLOAT64_ARRAY),
            self._one('/cavities', messages.FLOAT64_ARRAY),
            {name.rpartition('/')[2]: series for name, series in self._series.items()
             if series.type == messages.FLUID_PRESSURE},
        )

    def _one(self, ending: str, type_name: str) -> Series:
        """Return the topic of this name ending and type, or an empty series."""
        for name, series in self._series.items():
            if name.endswith(ending) and series.type == type_name:
                return series
        return Series(ending, type_name, '')

    def _json(self, key: str) -> list:
        try:
            return json.loads(self.custom_data.get(key, '[]'))
        except ValueError:
            raise RecordingError(f'{self.path}: its {key} are not readable') from None


def load_recording(path: str | Path) -> Recording:
    """Open a recording directory or a lone MCAP file; RecordingError if it is neither."""
    path = Path(path)
    if path.is_file():
        files = [scan(path)]
        return Recording(path, files, files[0].metadata.get(CUSTOM_DATA, {}))
    if not path.is_dir():
        raise RecordingError(f'{path} does not exist')
    if not (path / FILE_NAME).exists():
        raise RecordingError(f'{path} is not a recording: it has no {FILE_NAME}')
    metadata = read_metadata(path)
    names = metadata.get('relative_file_paths') or []
    if metadata.get('storage_identifier') != 'mcap' or not names:
        raise RecordingError(f'{path} holds no MCAP files')
    # A file begun just before the writer died may not be in the list yet.
    names += [file.name for file in mcap_files(path) if file.name not in names]
    files = [scan(path / name) for name in names]
    return Recording(path, files, metadata.get('custom_data') or {})


def _series(files: list[ScannedFile]) -> dict[str, Series]:
    """Return the topics of all files, each joined over them."""
    found: dict[str, Series] = {}
    for file in files:
        for number, channel in file.channels.items():
            try:
                schema = file.schemas[channel.schema_id]
                series = Series(channel.topic, schema.name, schema.data.decode())
            except (KeyError, UnicodeDecodeError):
                raise RecordingError(
                    f'{file.path} is damaged: {channel.topic} has no readable schema') from None
            series = found.setdefault(channel.topic, series)
            for block in file.blocks:
                series.add(block, number)
    return found
