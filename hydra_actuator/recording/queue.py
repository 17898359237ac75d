# SPDX-License-Identifier: Apache-2.0
"""
A writer behind one thread and a bounded queue, for producers that must not wait.

Putting a message costs a list append under a lock that is never held while anything is written.
When the disk is slower than the messages for so long that the queue is full, whole messages are
dropped and counted by topic. A writing error disturbs no producer: it is kept in `error`, and what
comes counts as dropped, until the sink can go on after a RecordingFailure.
"""

from collections import Counter
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
import threading
import time
from typing import Protocol

from hydra_actuator.recording.errors import RecordingFailure
from hydra_actuator.recording.segment import Message

# Every message counts for this much more than its bytes: tuple, list entry, integers.
_OVERHEAD = 150
# How often a sink that has failed is asked to go on [s].
_RETRY = 0.25


class SinkStatistics(Protocol):
    """What a sink has kept, by topic: after a failure that is less than it was given."""

    @property
    def messages(self) -> Mapping[str, int]: ...


class Sink(Protocol):
    """What stands behind the queue, such as a RecordingWriter; used by one thread only."""

    @property
    def statistics(self) -> 'SinkStatistics': ...
    def write_batch(self, messages: Iterable[Message]) -> None: ...
    def flush_if_due(self) -> None: ...
    def resume(self) -> None: ...
    def close(self) -> None: ...


@dataclass(frozen=True)
class QueueStatistics:
    """
    Messages written and dropped by topic, and the bytes waiting, now and at most.

    failures: how often writing broke off; resumed: how often it went on; processor_time [s]: that
    the writing thread has had.
    """

    written: Mapping[str, int]
    dropped: Mapping[str, int]
    waiting_bytes: int
    most_waiting_bytes: int
    failures: int = 0
    resumed: int = 0
    processor_time: float = 0.0


class QueuedWriter:
    """Takes messages from any thread at once and writes them from its own."""

    def __init__(self, sink: Sink, capacity: int = 64 * 1024 * 1024, poll_period: float = 0.01):
        """Take over a sink, closed with the queue; `capacity` [byte], `poll_period` [s]."""
        self.error: Exception | None = None
        self.on_resume: Callable[[], None] = lambda: None
        self._sink = sink
        self._capacity = capacity
        self._poll_period = poll_period
        self._lock = threading.Lock()
        self._waiting: list[Message] = []
        self._waiting_bytes = 0
        self._in_hand_bytes = 0
        self._most_bytes = 0
        self._dropped: Counter[str] = Counter()
        self._written: Counter[str] = Counter()
        self._handed: Counter[str] = Counter()
        self._lost: Counter[str] = Counter()
        self._failures = self._resumed = 0
        self._retry = 0.0
        self._processor_time = 0.0
        self._wake = threading.Event()
        self._closing = False
        self._thread = threading.Thread(target=self._run, name='recorder', daemon=True)
        self._thread.start()

    def __enter__(self) -> 'QueuedWriter':
        return self

    def __exit__(self, *_) -> None:
        self.close()

    @property
    def statistics(self) -> QueueStatistics:
        """The counts so far."""
        with self._lock:
            return QueueStatistics(
                dict(self._written), dict(self._dropped + self._lost),
                self._waiting_bytes + self._in_hand_bytes, self._most_bytes,
                self._failures, self._resumed, self._processor_time,
            )

    def put(self, topic: str, log_ns: int, publish_ns: int, data: bytes) -> bool:
        """Queue one message; False if it was dropped. Never waits, never raises."""
        return self.put_batch([(topic, log_ns, publish_ns, data)]) == 0

    def put_batch(self, messages: list[Message]) -> int:
        """Queue messages and return how many were dropped. Never waits, never raises."""
        size = sum([len(message[3]) for message in messages]) + _OVERHEAD * len(messages)
        with self._lock:
            held = self._waiting_bytes + self._in_hand_bytes + size
            if held <= self._capacity and not self._closing and self.error is None:
                self._waiting += messages
                self._waiting_bytes += size
                self._most_bytes = max(self._most_bytes, held)
                return 0
            return self._put_what_fits(messages)

    def close(self, timeout: float | None = None) -> bool:
        """
        Write what waits, close the sink, end the thread; False if `timeout` [s] was too short.

        Messages put from now on are dropped. An error while closing is in `error`.
        """
        with self._lock:
            self._closing = True
        self._wake.set()
        self._thread.join(timeout)
        return not self._thread.is_alive()

    def _put_what_fits(self, messages: list[Message]) -> int:
        """Queue one by one what the queue still holds; the lock is held."""
        dropped = 0
        for message in messages:
            size = len(message[3]) + _OVERHEAD
            held = self._waiting_bytes + self._in_hand_bytes + size
            if held > self._capacity or self._closing or self.error is not None:
                self._dropped[message[0]] += 1
                dropped += 1
                continue
            self._waiting.append(message)
            self._waiting_bytes += size
            self._most_bytes = max(self._most_bytes, held)
        return dropped

    def _run(self) -> None:
        """Write batch after batch until closed; the thread's whole life."""
        try:
            while not self._closing:
                self._wake.wait(self._poll_period)
                if self.error is not None:
                    self._go_on_if_possible()
                self._write_waiting()
            self._write_waiting()
        finally:
            if not self._attempt(self._sink.close):
                self._recount()

    def _write_waiting(self) -> None:
        """Hand everything that waits to the sink."""
        with self._lock:
            batch, self._waiting = self._waiting, []
            self._in_hand_bytes, self._waiting_bytes = self._waiting_bytes, 0
        before = self.error
        done = before is None and self._attempt(self._sink.write_batch, batch)
        if done:
            done = self._attempt(self._sink.flush_if_due)
        count = Counter([message[0] for message in batch])
        spent = time.thread_time()
        with self._lock:
            self._processor_time = spent
            self._in_hand_bytes = 0
            self._handed.update(count)
            if done:
                self._written.update(count)
            elif before is not None:
                self._lost.update(count)
        if not done and before is None:
            self._recount()

    def _go_on_if_possible(self) -> None:
        """Have a sink that has failed try again, now and then."""
        if not isinstance(self.error, RecordingFailure) or time.monotonic() < self._retry:
            return
        self._retry = time.monotonic() + _RETRY
        try:
            self._sink.resume()
        except RecordingFailure:
            return
        except Exception as error:
            self.error = error
            return
        self._resumed += 1
        self.error = None
        self.on_resume()

    def _recount(self) -> None:
        """After a failure: what the sink was given and has not kept is lost."""
        kept = Counter(self._sink.statistics.messages)
        with self._lock:
            self._written = +kept
            self._lost = self._handed - kept

    def _attempt(self, action, *arguments) -> bool:
        """Do something with the sink; the first error is kept, for this thread has no caller."""
        try:
            action(*arguments)
        except Exception as error:
            if self.error is None:
                self.error = error
                self._failures += 1
                self._retry = time.monotonic() + _RETRY
            return False
        return True
