# SPDX-License-Identifier: Apache-2.0
"""The command topics: each message is recorded as it came, judged, held or dropped whole."""

from collections.abc import Callable
import struct

from hydra_actuator.recording.topics import ActuatorTopics
from hydra_actuator.ros.commands import CommandDesk, RejectedCommandError
from hydra_actuator.ros.reception import Reception
from hydra_actuator.ros.setpoint import Setpoint
from rclpy.node import Node
from rclpy.qos import HistoryPolicy, QoSProfile, ReliabilityPolicy
from rclpy.qos_overriding_options import QoSOverridingOptions
from rclpy.serialization import deserialize_message
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64, Float64MultiArray

# Best effort matches every publisher; of several commands within a tick, the last one counts.
COMMAND_QOS = QoSProfile(
    history=HistoryPolicy.KEEP_LAST, depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)

Keep = Callable[[str, int, int, bytes], None]


class Inbox:
    """Receives commands from `start` to `stop`."""

    def __init__(self, node: Node, desk: CommandDesk, setpoint: Setpoint, keep: Keep):
        """Take where commands are judged, held and recorded."""
        self._logger = node.get_logger()
        self._desk = desk
        self._setpoint = setpoint
        self._keep = keep
        self._reception = Reception(node, self._on_error)
        self.start = self._reception.start
        self.stop = self._reception.stop
        self.destroy = self._reception.destroy

    def subscribe(self, topics: ActuatorTopics) -> None:
        """Subscribe, and write the topics' full names, as remapped, into `topics`."""
        topics.spool_command = self._subscribe(Float64, '~/spool_command', self._spool_command)
        topics.commands = self._subscribe(Float64MultiArray, '~/commands', self._commands)
        topics.joint_commands = self._subscribe(
            JointState, 'joint_commands', self._joint_commands)
        topics.load_force = self._subscribe(Float64, '~/load_force', self._load_force)

    def _subscribe(self, message_type, topic: str, obey: Callable[[bytes], None]) -> str:
        def receive(data: bytes, received: int, sent: int) -> None:
            self._keep(full_name, received, sent, data)
            try:
                obey(data)
            except RejectedCommandError as rejection:
                self._logger.warning(
                    f'{topic}: message dropped: {rejection}', throttle_duration_sec=1.0)

        full_name = self._reception.subscribe(
            message_type, topic, receive, qos_profile=COMMAND_QOS,
            qos_overriding_options=QoSOverridingOptions.with_default_policies())
        return full_name

    def _spool_command(self, data: bytes) -> None:
        self._setpoint.accept(self._desk.spool_command(self._float64(data)))

    def _commands(self, data: bytes) -> None:
        message = self._message(data, Float64MultiArray)
        self._setpoint.accept(self._desk.commands(message.data.tolist()))

    def _joint_commands(self, data: bytes) -> None:
        message = self._message(data, JointState)
        spools = self._desk.joint_commands(message.name, message.position.tolist())
        if spools is not None:
            self._setpoint.accept(spools)

    def _load_force(self, data: bytes) -> None:
        self._setpoint.accept_load(self._desk.load_force(self._float64(data)))

    def _float64(self, data: bytes) -> float:
        """Return the value of a Float64: CDR of either byte order."""
        if len(data) < 12:
            raise self._desk.unreadable(f'{len(data)} bytes')
        return struct.unpack_from('<d' if data[1] & 1 else '>d', data, 4)[0]

    def _message(self, data: bytes, message_type):
        try:
            return deserialize_message(data, message_type)
        except Exception as error:
            raise self._desk.unreadable(str(error)) from None

    def _on_error(self, error: BaseException) -> None:
        self._logger.error(
            f'a command could not be taken: {error!r}', throttle_duration_sec=1.0)
