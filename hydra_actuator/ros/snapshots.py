# SPDX-License-Identifier: Apache-2.0
"""
The last seconds kept in memory, written when somebody asks and when something goes wrong.

A snapshot that is asked for is written at once. One for an error or a fault is too, unless the
last began less than its own duration ago: then it waits so long, and the two adjoin.
"""

from collections.abc import Callable, Mapping
from pathlib import Path
import queue
import threading
import time

from hydra_actuator.errors import Failure, InputError
from hydra_actuator.faults.announcements import NAME as FAULTS
from hydra_actuator.recording.memory import Memory
from hydra_actuator.recording.segment import Message
from hydra_actuator.recording.writer import RecordingWriter

OK, WARN, ERROR = 0, 1, 2
NAME = 'Recorder'
# So many messages are written in one go; others have their turn in between.
_PIECE = 200
# What holds is said anew this often [s], so that each snapshot has it.
_RESTATE = 1.0

Event = Callable[[int, str, str, Mapping[str, str]], None]


class _Job:
    """A snapshot to be written, and what became of it."""

    def __init__(self, writer: RecordingWriter, messages: list[Message], reason: str):
        self.writer = writer
        self.messages = messages
        self.reason = reason
        self.done = threading.Event()
        self.error = ''


class Snapshots:
    """
    Keeps messages and writes snapshots in a thread of its own, from the start until `close`.

    restate: asks for a message about what has held for long; on_event: told of each snapshot.
    """

    def __init__(self, duration: float, new_writer: Callable[[], RecordingWriter]):
        """Take the duration [s] and what makes the writer of each snapshot."""
        self.restate: Callable[[], None] = lambda: None
        self.on_event: Event = lambda *event: None
        self.memory = Memory(duration)
        self.written = 0
        self.error = ''
        self.path: Path | None = None
        self._duration = duration
        self._new_writer = new_writer
        self._jobs: queue.Queue[_Job] = queue.Queue()
        self._due: tuple[float, str] | None = None
        self._taken = float('-inf')
        self._restated = float('-inf')
        self._lock = threading.Lock()
        self._closing = False
        self._thread = threading.Thread(target=self._run, name='snapshots', daemon=True)
        self._thread.start()

    def take(self, reason: str, patience: float) -> tuple[bool, str]:
        """Write a snapshot; return whether that goes well, as known after `patience` [s]."""
        try:
            job = self._begin(reason)
        except (InputError, Failure) as error:
            return False, str(error)
        if not job.done.wait(patience):
            return True, f'being written: {job.writer.directory}'
        return not job.error, job.error or f'snapshot: {job.writer.directory}'

    def notice(self, level: int, name: str, message: str) -> None:
        """Have a snapshot written if the event is an error or a fault."""
        if name == NAME or not (level >= ERROR or (name == FAULTS and level >= WARN)):
            return
        with self._lock:
            if self._due is None:
                self._due = (self._taken + self._duration, f'{name}: {message}')

    def close(self, timeout: float) -> bool:
        """Write what is due, end the thread; False if `timeout` [s] was too short."""
        self._closing = True
        self._thread.join(timeout)
        self.on_event = lambda *event: None
        return not self._thread.is_alive() and not self.error

    def _begin(self, reason: str) -> _Job:
        messages = self.memory.messages()
        job = _Job(self._new_writer(), messages, reason)
        self._taken = time.monotonic()
        self._jobs.put(job)
        return job

    def _run(self) -> None:
        while True:
            closing = self._closing
            self._begin_if_due(closing)
            try:
                job = self._jobs.get(timeout=0.0 if closing else 0.05)
            except queue.Empty:
                if closing:
                    return
                self._restate_if_due()
                continue
            self._write(job)

    def _begin_if_due(self, now: bool) -> None:
        """Begin the snapshot for an error or a fault, if its time has come."""
        with self._lock:
            if self._due is None or not (now or time.monotonic() >= self._due[0]):
                return
            reason, self._due = self._due[1], None
        try:
            self._begin(reason)
        except (InputError, Failure) as error:
            self._fail(str(error))

    def _restate_if_due(self) -> None:
        if time.monotonic() - self._restated >= min(_RESTATE, 0.4 * self._duration):
            self._restated = time.monotonic()
            self.restate()

    def _write(self, job: _Job) -> None:
        """Write and close a snapshot, and say so."""
        try:
            for first in range(0, len(job.messages), _PIECE):
                job.writer.write_batch(job.messages[first:first + _PIECE])
                time.sleep(0.0)
            job.writer.close()
        except (InputError, Failure) as error:
            job.error = str(error)
            self._fail(job.error)
        else:
            self.error = ''
            self.written += 1
            self.path = job.writer.directory
            self.on_event(OK, NAME, f'snapshot: {self.path}', {
                'reason': job.reason, 'messages': str(len(job.messages))})
        job.done.set()

    def _fail(self, error: str) -> None:
        self.error = error
        self.on_event(ERROR, NAME, f'no snapshot: {error}', {})
