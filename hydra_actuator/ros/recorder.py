# SPDX-License-Identifier: Apache-2.0
"""
The recording of a node: a directory named by node and time, begun and ended at will.

Messages are handed to a queue with a thread of its own behind it; what comes while nothing is
recorded is let go. In snapshot mode they stay in memory, see `snapshots`.
"""

from collections.abc import Callable, Mapping, Sequence
import os
from pathlib import Path
import shutil
import time

from hydra_actuator.parameters import Parameters
from hydra_actuator.recording.errors import RecordingError
from hydra_actuator.recording.limits import Limits
from hydra_actuator.recording.queue import QueuedWriter, QueueStatistics
from hydra_actuator.recording.segment import Message
from hydra_actuator.recording.topics import Topic
from hydra_actuator.recording.writer import RecordingWriter
from hydra_actuator.ros.snapshots import Event, Snapshots

# A closing file is written within this time [s], or given up.
CLOSING = 1.0


class Recorder:
    """Where messages go that are to be kept."""

    def __init__(
        self, node: str, parameters: Parameters, topics: Sequence[Topic],
        custom_data: Mapping[str, str],
    ):
        """
        Take the fully qualified name of the node, and what its recordings carry.

        restate: asks, in the recorder's thread, for a message on what has held for long;
        on_event: told of each snapshot.
        """
        self.path: Path | None = None
        self.snapshots: Snapshots | None = None
        self.restate: Callable[[], None] = lambda: None
        self.on_event: Event = lambda *event: None
        self._node = node.strip('/').replace('/', '_')
        self._parameters = parameters
        self._topics = topics
        self._custom_data = custom_data
        self._writer: QueuedWriter | None = None

    @property
    def recording(self) -> bool:
        """Tell whether a recording is open, or memory kept for snapshots."""
        return self._writer is not None or self.snapshots is not None

    @property
    def doing(self) -> str:
        """What is done with messages now, in words."""
        if self.snapshots is not None:
            duration = self._parameters['recording.snapshot_duration']
            return f'keeping the last {duration:g} s for snapshots'
        return 'not recording' if self._writer is None else f'recording to {self.path}'

    @property
    def error(self) -> str:
        """Why nothing more is written to the open recording; '' if all is well."""
        writer = self._writer
        return str(writer.error) if writer is not None and writer.error is not None else ''

    @property
    def statistics(self) -> QueueStatistics | None:
        """Counts of the open recording."""
        writer = self._writer
        return None if writer is None else writer.statistics

    @property
    def failures(self) -> int:
        """How often writing to the open recording broke off."""
        statistics = self.statistics
        return 0 if statistics is None else statistics.failures

    @property
    def resumed(self) -> int:
        """How often writing to the open recording went on after a failure."""
        statistics = self.statistics
        return 0 if statistics is None else statistics.resumed

    @property
    def size(self) -> int:
        """Bytes in the files of the last recording."""
        try:
            return sum(entry.stat().st_size for entry in os.scandir(self.path))
        except OSError:
            return 0

    @property
    def free_space(self) -> int:
        """Bytes that the disk has left for the last recording."""
        try:
            return shutil.disk_usage(self.path).free
        except OSError:
            return 0

    def open(self) -> None:
        """Begin a recording, or to keep messages for snapshots; raises RecordingError."""
        if self._parameters['recording.mode'] == 'snapshot':
            snapshots = Snapshots(
                self._parameters['recording.snapshot_duration'], self._named_writer)
            snapshots.restate = lambda: self.restate()
            snapshots.on_event = lambda *event: self.on_event(*event)
            self.snapshots = snapshots
            return
        writer = self._named_writer()
        self.path = writer.directory
        self._writer = QueuedWriter(writer)
        self._writer.on_resume = lambda: self.restate()

    def close(self) -> bool:
        """End the recording; False if it could not be finished in time."""
        writer, self._writer = self._writer, None
        snapshots, self.snapshots = self.snapshots, None
        if snapshots is not None:
            complete = snapshots.close(CLOSING)
            self.path = snapshots.path or Path(self._parameters['recording.directory'])
            return complete
        return _closed(writer)

    def begin_anew(self) -> bool:
        """Go on in a new recording, if one is open; False if the old one is incomplete."""
        if self.snapshots is not None:
            self.snapshots.memory.clear()
        before = self._writer
        if before is None:
            return True
        self.open()
        return _closed(before)

    def snapshot(self) -> tuple[bool, str]:
        """Write what is kept, now; tell whether that goes well, and where or why not."""
        snapshots = self.snapshots
        if snapshots is not None:
            return snapshots.take('asked for', CLOSING)
        mode = self._parameters['recording.mode']
        return False, f'{self.doing}, recording.mode = {mode}: nothing is kept for a snapshot'

    def notice(self, level: int, name: str, message: str) -> None:
        """Hear of an event: an error or a fault is worth a snapshot."""
        snapshots = self.snapshots
        if snapshots is not None:
            snapshots.notice(level, name, message)

    def put(self, topic: str, log_ns: int, publish_ns: int, data: bytes) -> None:
        """Keep one message."""
        self.put_batch([(topic, log_ns, publish_ns, data)])

    def put_batch(self, messages: list[Message]) -> None:
        """Keep messages (topic, log time, publish time, bytes)."""
        writer, snapshots = self._writer, self.snapshots
        if writer is not None:
            writer.put_batch(messages)
        elif snapshots is not None:
            snapshots.memory.put_batch(messages)

    def _named_writer(self) -> RecordingWriter:
        """Open a directory named by node and time."""
        directory = Path(self._parameters['recording.directory']).expanduser()
        return self._new_writer(directory, f'{self._node}_{time.strftime("%Y%m%d_%H%M%S")}')

    def _new_writer(self, directory: Path, name: str) -> RecordingWriter:
        """Open a directory of that name, or the first of name_2, name_3 ... that is free."""
        parameters = self._parameters
        number = 1
        while True:
            path = directory / (name if number == 1 else f'{name}_{number}')
            try:
                return RecordingWriter(
                    path, self._topics, self._custom_data,
                    flush_period=parameters['recording.flush_period'],
                    compression=parameters['recording.compression'],
                    limits=Limits.of(parameters),
                )
            except RecordingError:
                if not path.is_dir():
                    raise
                number += 1


def _closed(writer: QueuedWriter | None) -> bool:
    return writer is None or (writer.close(CLOSING) and writer.error is None)
