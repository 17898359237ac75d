# SPDX-License-Identifier: Apache-2.0
"""
/diagnostics and ~/events: published, and recorded with the same bytes.

Diagnostics go out once a second, and at once when a level changes, from a thread of their own:
they are there in every lifecycle state, and while the executor is busy configuring.
"""

from collections.abc import Callable, Mapping
import threading
import time

from diagnostic_msgs.msg import DiagnosticArray
from hydra_actuator.recording.messages import diagnostic_array
from hydra_actuator.ros.statuses import Status
from rclpy.node import Node

PERIOD = 1.0
# Levels are looked at this often [s].
_LOOK = 0.05

Keep = Callable[[str, int, int, bytes], None]


class Reports:
    """The two topics on which the node speaks about itself."""

    def __init__(self, node: Node):
        self.keep: Keep = lambda *message: None
        self.notice: Callable[[int, str, str], None] = lambda *event: None
        self.log_time: Callable[[int], int] = lambda system_time: system_time
        self._prefix = node.get_fully_qualified_name()
        self._diagnostics = node.create_publisher(DiagnosticArray, '/diagnostics', 10)
        self._events = node.create_publisher(DiagnosticArray, '~/events', 10)
        self.topics = {
            'diagnostics': self._diagnostics.topic_name, 'events': self._events.topic_name}

    def diagnostics(self, statuses: list[Status]) -> None:
        """Publish and record the state of all parts."""
        self._send(self._diagnostics, statuses)

    def event(
        self, level: int, name: str, message: str, values: Mapping[str, str] | None = None
    ) -> None:
        """Publish and record one event at once."""
        self._send(self._events, [Status(name, level, message, values or {})])
        self.notice(level, name, message)

    def _send(self, publisher, statuses: list[Status]) -> None:
        now = time.time_ns()
        stamp = self.log_time(now)
        data = diagnostic_array(stamp, [
            (one.level, f'{self._prefix}: {one.name}', one.message, self._prefix, one.values)
            for one in statuses])
        publisher.publish(data)
        self.keep(publisher.topic_name, stamp, now, data)


class DiagnosticsThread:
    """Asks for the statuses and sends them, from `start` to `stop`."""

    def __init__(
        self, reports: Reports, statuses: Callable[[], list[Status]],
        on_error: Callable[[BaseException], None],
    ):
        self._reports = reports
        self._statuses = statuses
        self._on_error = on_error
        self._stopping = threading.Event()
        self._thread = threading.Thread(target=self._run, name='diagnostics', daemon=True)
        self._sending = threading.Lock()
        self._levels: list[int] = []
        self._sent = float('-inf')

    def start(self) -> None:
        """Begin, with a message at once."""
        self._thread.start()

    def stop(self) -> None:
        """End the thread."""
        self._stopping.set()
        self._thread.join()

    def send(self) -> None:
        """Send now, from any thread: the state has changed."""
        with self._sending:
            statuses = self._statuses()
            self._levels = [one.level for one in statuses]
            self._sent = time.monotonic()
            self._reports.diagnostics(statuses)

    def _run(self) -> None:
        while True:
            try:
                if self._due():
                    self.send()
            except Exception as error:
                self._on_error(error)
            if self._stopping.wait(_LOOK):
                return

    def _due(self) -> bool:
        if time.monotonic() - self._sent >= PERIOD:
            return True
        return [one.level for one in self._statuses()] != self._levels
