# SPDX-License-Identifier: Apache-2.0
"""
The other side of the topics: sends a sine of commands, and listens to what comes back.

Both in threads of their own on bytes, so that this side costs the machine little. What is
listened to is a choice of the topics: every listener costs both sides.
"""

import math
import struct
import threading
import time

from hydra_actuator.channels import STATIONS
from hydra_actuator.recording.messages import float64
from hydra_actuator.ros.reception import Reception
from rclpy.node import Node
from rclpy.qos import QoSProfile
from sensor_msgs.msg import FluidPressure, JointState
from std_msgs.msg import Float64, Float64MultiArray

PERIOD = 1e-3
PRESSURES = ('A', 'E', 'J')

_STAMP = struct.Struct('<iI')


class Heard:
    """The stamps [ns] and receive times [ns] of the messages of one topic."""

    def __init__(self, stamp_of):
        self.stamps: list[int] = []
        self.received: list[int] = []
        self._stamp_of = stamp_of

    def receive(self, data: bytes, received: int, sent: int) -> None:
        """Take a message."""
        self.stamps.append(self._stamp_of(data))
        self.received.append(received)

    def gaps(self, period_ns: int) -> int:
        """Return how many instants of the grid are missing between the first and the last."""
        stamps = sorted(set(self.stamps))
        if len(stamps) < 2:
            return 0
        return round((stamps[-1] - stamps[0]) / period_ns) + 1 - len(stamps)


class Listener:
    """Hears joint states, sections and some pressures of an actuator."""

    def __init__(self, node: Node, actuator: str = '/actuator'):
        self.errors: list[BaseException] = []
        self.heard = {
            'joint_states': Heard(_header_stamp),
            'sections': Heard(_sections_stamp),
            **{f'pressure/{name}': Heard(_header_stamp) for name in PRESSURES},
        }
        self._reception = Reception(node, self.errors.append)
        namespace = actuator.rpartition('/')[0]
        qos = QoSProfile(depth=1000)
        for name, heard in self.heard.items():
            message_type = FluidPressure if name.startswith('pressure') else Float64MultiArray
            topic = f'{actuator}/{name}'
            if name == 'joint_states':
                message_type, topic = JointState, f'{namespace}/{name}'
            self._reception.subscribe(message_type, topic, heard.receive, qos_profile=qos)
        self.start = self._reception.start
        self.stop = self._reception.stop


class SineSender:
    """Sends amplitude sin(2 pi f t) as spool command, once a period on absolute deadlines."""

    def __init__(self, node: Node, frequency: float, topic: str = '/actuator/spool_command'):
        """Take the frequency [Hz]; full stroke."""
        self.sent = 0
        self._frequency = frequency
        self._publisher = node.create_publisher(Float64, topic, QoSProfile(depth=1))
        self._stopping = False
        self._thread = threading.Thread(target=self._run, name='sine', daemon=True)

    @property
    def heard_by(self) -> int:
        """How many subscriptions have been found."""
        return self._publisher.get_subscription_count()

    def start(self) -> None:
        """Begin to send."""
        self._thread.start()

    def stop(self) -> None:
        """End the sine with a centred spool; nothing if it has not begun."""
        self._stopping = True
        if not self._thread.is_alive():
            return
        self._thread.join()
        self._publisher.publish(float64(0.0))

    def _run(self) -> None:
        begin = time.monotonic()
        while not self._stopping:
            self.sent += 1
            wait = begin + self.sent * PERIOD - time.monotonic()
            if wait > 0.0:
                time.sleep(wait)
            phase = 2.0 * math.pi * self._frequency * (time.monotonic() - begin)
            self._publisher.publish(float64(math.sin(phase)))


def _header_stamp(data: bytes) -> int:
    """Return the stamp [ns] of a message that begins with a header."""
    seconds, nanoseconds = _STAMP.unpack_from(data, 4)
    return seconds * 1_000_000_000 + nanoseconds


def _sections_stamp(data: bytes) -> int:
    """Return the stamp [ns] of a sections array of all stations: its first value."""
    seconds, = struct.unpack_from('<d', data, len(data) - 8 * (1 + 2 * len(STATIONS)))
    return round(seconds * 1e6) * 1000
