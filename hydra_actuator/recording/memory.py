# SPDX-License-Identifier: Apache-2.0
"""
The last seconds of what would be recorded, in memory.

Kept by log time, so that simulated seconds count where time is simulated. If they need more
memory than there may be, fewer are kept.
"""

from collections import deque
from dataclasses import dataclass
import threading

from hydra_actuator.recording.segment import Message

# Every message counts for this much more than its bytes: tuple, list entry, integers.
_OVERHEAD = 150


@dataclass(frozen=True)
class Kept:
    """How many messages are kept, their bytes in memory, and the log time they span [s]."""

    messages: int
    bytes: int
    span: float


class Memory:
    """Messages of the last `duration` [s], at most `capacity` [byte]; for any thread."""

    def __init__(self, duration: float, capacity: int = 512 * 1024 * 1024):
        self._duration_ns = round(duration * 1e9)
        self._capacity = capacity
        self._lock = threading.Lock()
        self._batches: deque[tuple[int, int, list[Message]]] = deque()
        self._newest = 0
        self._bytes = self._count = 0

    @property
    def kept(self) -> Kept:
        """What is in here now."""
        with self._lock:
            oldest = self._batches[0][0] if self._batches else self._newest
            return Kept(self._count, self._bytes, (self._newest - oldest) / 1e9)

    def put_batch(self, messages: list[Message]) -> None:
        """Keep messages (topic, log time, publish time, bytes), and forget what is too old."""
        if not messages:
            return
        newest = max([message[1] for message in messages])
        size = sum([len(message[3]) for message in messages]) + _OVERHEAD * len(messages)
        with self._lock:
            self._batches.append((newest, size, messages))
            self._bytes += size
            self._count += len(messages)
            self._newest = max(self._newest, newest)
            first = self._newest - self._duration_ns
            while self._batches[0][0] < first or self._bytes > self._capacity:
                _, size, messages = self._batches.popleft()
                self._bytes -= size
                self._count -= len(messages)
                if not self._batches:
                    break

    def messages(self) -> list[Message]:
        """Return the messages of the last seconds, in the order in which they came."""
        with self._lock:
            batches, first = list(self._batches), self._newest - self._duration_ns
        return [message for _, _, batch in batches for message in batch if message[1] >= first]

    def clear(self) -> None:
        """Forget all: time begins anew."""
        with self._lock:
            self._batches.clear()
            self._newest = self._bytes = self._count = 0
