# SPDX-License-Identifier: Apache-2.0
"""
Slaved to /clock: whole periods, as many as /clock allows.

Stamps are /clock's: the first value heard, and whole periods from there. Stopped, it is waited
for. Backwards is a reset, with the value heard as the stamp of the initial state. Forward beyond
`max_burst` periods, the rest is slip: stamps jump by whole periods. 0 means that there is no
clock.
"""

import struct

from hydra_actuator.ros import statuses
from hydra_actuator.ros.clocks.source import Act, ClockSource, Grant, NS, START
from hydra_actuator.ros.clocks.waiting import Waiting
from hydra_actuator.ros.reception import Reception
from hydra_actuator.ros.watch import Watched
from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy
from rosgraph_msgs.msg import Clock

# Matches every publisher; only the newest value counts.
CLOCK_QOS = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)

_BYTE_ORDER = {0: struct.Struct('>iI'), 1: struct.Struct('<iI')}


class Slaved(ClockSource):
    """Grants the ticks that lie behind the value of /clock last `heard`."""

    def __init__(self, period: float, max_burst: int):
        super().__init__(period)
        self.ticks = 0
        self.slipped = 0
        self._max_burst = max_burst
        self._heard = 0
        self._backwards = False
        self._base: int | None = None
        self._index = 0
        self._last_stamp = 0
        self._reception: Reception | None = None
        self._slip = statuses.Recently()
        self._waiting = Waiting('/clock')

    def hear(self, value: int) -> None:
        """Take a value of /clock [ns], from any thread."""
        if not value:
            return
        with self._news:
            self._backwards |= value < self._heard
            self._heard = value
            self._news.notify()

    def connect(self, node: Node) -> None:
        """Listen to /clock."""
        def receive(data: bytes, received: int, sent: int) -> None:
            seconds, nanoseconds = _BYTE_ORDER[data[1] & 1].unpack_from(data, 4)
            self.hear(seconds * NS + nanoseconds)

        self._reception = Reception(node, lambda error: node.get_logger().error(
            f'/clock could not be read: {error!r}', throttle_duration_sec=1.0))
        self._reception.subscribe(Clock, '/clock', receive, qos_profile=CLOCK_QOS)
        self._reception.start()

    def disconnect(self) -> None:
        """Listen no more."""
        if self._reception is not None:
            self._reception.destroy()

    def log_time(self, system_time: int) -> int:
        """Return /clock."""
        return self._heard or START

    def start(self, last_stamp: int) -> int | None:
        """Go on from wherever /clock is when it is next looked at."""
        self._base = None
        self._last_stamp = last_stamp
        return None

    def stop(self) -> None:
        """End the wait."""
        self._waiting.end()

    def wait(self) -> Grant | None:
        """Wait until /clock has passed the end of the next period."""
        with self._news:
            if not self._woken and not self._backwards and self._behind() < 1:
                self._waiting.begin()
                self._news.wait(self._waiting.remaining())
            self._woken = False
            return self._reset() or self._laid() or self._advanced()

    def out_of_turn(self, last_stamp: int) -> Grant:
        """Return a grant one period after the last state."""
        with self._news:
            reset = self._reset_due()
            self.ticks += not reset
            stamp = last_stamp + (0 if reset else round(self._period_ns))
            return Grant(stamp, Act.RESET if reset else Act.SOLVE)

    def status(self) -> statuses.Status:
        """Return how /clock is followed."""
        status = self._waiting.status('follow_clock', {
            'ticks': str(self.ticks), 'slipped': str(self.slipped),
            'clock': f'{self._heard * 1e-9:.9f}'})
        if status.level or not self._slip.grew(self.slipped):
            return status
        return statuses.Status(
            status.name, statuses.WARN,
            f'follow_clock: {self.slipped} periods given up as slip', status.values)

    def watched(self) -> list[Watched]:
        """Return long waits and slip."""
        return [*self._waiting.watched(), Watched(
            'Real time', statuses.WARN, 'ticks given up as slip', lambda: self.slipped)]

    def _behind(self) -> int:
        """Return the whole periods up to /clock that were not granted; 1 for a first state."""
        if self._base is None:
            return int(self._heard > 0)
        return int((self._heard - self._base) / self._period_ns + 1e-9) - self._index

    def _reset(self) -> Grant | None:
        """Return the grant of a reset if /clock went back or somebody asked."""
        if not self._heard or not (self._reset_due() or self._backwards):
            return None
        self._backwards = False
        self._waiting.end()
        self._base, self._index = self._heard, 0
        return Grant(self._base, Act.RESET)

    def _laid(self) -> Grant | None:
        """Lay the grid to /clock; the first state of all is granted there."""
        if self._base is not None or not self._heard:
            return None
        self._waiting.end()
        self._base, self._index = max(self._heard, self._last_stamp), 0
        return None if self._last_stamp else Grant(self._base, Act.RESET)

    def _advanced(self) -> Grant | None:
        behind = self._behind() if self._base is not None else 0
        if behind < 1:
            self._waiting.look()
            return None
        self._waiting.end()
        slip = max(0, behind - self._max_burst)
        self.slipped += slip
        self._index += 1 + slip
        self.ticks += 1
        return Grant(self._base + round(self._index * self._period_ns))
