# SPDX-License-Identifier: Apache-2.0
"""
The command topics: each message is read, recorded as it came, judged, held or dropped whole.

What no reader could read, or is larger than any command, is not recorded, only counted. Messages
are read by the package's own CDR: it is strict, bounded by the message's size, three times faster
than rclpy's, and prints nothing.
"""

from collections import Counter
from collections.abc import Callable
import struct

from hydra_actuator.recording.cdr import CdrError
from hydra_actuator.recording.messages import decode, FLOAT64_ARRAY, JOINT_STATE
from hydra_actuator.recording.topics import ActuatorTopics
from hydra_actuator.ros.commanders import Commanders, publishers_of
from hydra_actuator.ros.commands import CommandDesk, RejectedCommandError
from hydra_actuator.ros.reception import Reception
from hydra_actuator.ros.setpoint import Setpoint
from rclpy.node import Node
from rclpy.qos import HistoryPolicy, QoSProfile, ReliabilityPolicy
from rclpy.qos_overriding_options import QoSOverridingOptions
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64, Float64MultiArray

# Best effort matches every publisher; of several commands within a tick, the last one counts.
COMMAND_QOS = QoSProfile(
    history=HistoryPolicy.KEEP_LAST, depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)

# In lockstep each message is a tick, so none may be lost, nor replaced by the next.
LOCKSTEP_QOS = QoSProfile(
    history=HistoryPolicy.KEEP_LAST, depth=100, reliability=ReliabilityPolicy.RELIABLE)

LOAD = '~/load_force'

# No command is larger [byte]; what is, is not read.
LARGEST = 64 * 1024

Keep = Callable[[str, int, int, bytes], None]
SECOND = 1_000_000_000


class Inbox:
    """Receives commands from `start` to `stop`; `commanders` knows who sends them."""

    def __init__(
        self, node: Node, desk: CommandDesk, setpoint: Setpoint, keep: Keep,
        log_time: Callable[[int], int], qos: QoSProfile = COMMAND_QOS,
    ):
        """
        Take where commands are judged, held and recorded, and how they are received.

        log_time: gives the node's time [ns] at a time of the system.
        """
        self._logger = node.get_logger()
        self.desk = desk
        self._setpoint = setpoint
        self._keep = keep
        self._log_time = log_time
        self._qos = qos
        self._names: dict[str, str] = {}
        self._taken: Counter[str] = Counter()
        self.commanders = Commanders(self._names, self._taken, LOAD, publishers_of(node))
        self._reception = Reception(node, self._on_error)
        self.start = self._reception.start
        self.stop = self._reception.stop
        self.destroy = self._reception.destroy

    def subscribe(self, topics: ActuatorTopics) -> None:
        """Subscribe, and write the topics' full names, as remapped, into `topics`."""
        subscribe = self._subscribe
        topics.spool_command = subscribe(
            Float64, '~/spool_command', self._float64, self._spool_command)
        topics.commands = subscribe(
            Float64MultiArray, '~/commands', self._reader(FLOAT64_ARRAY), self._commands)
        topics.joint_commands = subscribe(
            JointState, 'joint_commands', self._reader(JOINT_STATE), self._joint_commands)
        topics.load_force = subscribe(Float64, LOAD, self._float64, self._load_force)

    def _subscribe(self, message_type, topic: str, read: Callable, obey: Callable) -> str:
        def receive(data: bytes, received: int, sent: int) -> None:
            self._taken[topic] += 1
            try:
                if len(data) > LARGEST:
                    raise self.desk.too_large(len(data), LARGEST)
                message = read(data)
                stamp = self._log_time(received)
                self._keep(full_name, stamp, sent, data)
                obey(message, stamp)
            except RejectedCommandError as rejection:
                self._logger.warning(
                    f'{topic}: message dropped: {rejection}', throttle_duration_sec=1.0)

        full_name = self._names[topic] = self._reception.subscribe(
            message_type, topic, receive, qos_profile=self._qos,
            qos_overriding_options=QoSOverridingOptions.with_default_policies())
        return full_name

    def _spool_command(self, value: float, _: int) -> None:
        self._setpoint.accept(self.desk.spool_command(value))

    def _commands(self, message: dict, _: int) -> None:
        self._setpoint.accept(self.desk.commands(message['data']))

    def _joint_commands(self, message: dict, now: int) -> None:
        stamp = message['header']['stamp']
        sent = stamp['sec'] * SECOND + stamp['nanosec']
        spools = self.desk.joint_commands(
            message['name'], message['position'], (now - sent) / SECOND if sent else 0.0)
        if spools is not None:
            self._setpoint.accept(spools)

    def _load_force(self, value: float, _: int) -> None:
        self._setpoint.accept_load(self.desk.load_force(value))

    def _float64(self, data: bytes) -> float:
        """Return the value of a Float64: plain CDR of either byte order."""
        if len(data) < 12 or data[0] != 0 or data[1] > 1:
            raise self.desk.unreadable(f'{len(data)} bytes are no Float64')
        return struct.unpack_from('<d' if data[1] else '>d', data, 4)[0]

    def _reader(self, message_type: str) -> Callable[[bytes], dict]:
        """Return a function that reads a message into a dictionary."""
        def read(data: bytes) -> dict:
            try:
                return decode(message_type, data)
            except CdrError as error:
                raise self.desk.unreadable(str(error)) from None
        return read

    def _on_error(self, error: BaseException) -> None:
        self._logger.error(
            f'a command could not be taken: {error!r}', throttle_duration_sec=1.0)
