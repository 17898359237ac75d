# SPDX-License-Identifier: Apache-2.0
"""
The same controller in a ROS node of its own, on a timer, against a node in real time.

What the machine does beside it acts on the loop: the gain is low and the limits are wide. A test
of figures belongs into lockstep; this one shows that the parts fit together.
"""

import time

from hydra_actuator.testing import step_metrics
from position_controller import PositionController
import rclpy
from rclpy.node import Node
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64

TARGET = 0.01
PERIOD = 0.01
DURATION = 3.0
PATIENCE = 60.0
# A command that is held for a fifth of a second moves the piston by 9 mm.
GAIN = 3.0
# Python need not hear a thousand states a second.
ACTUATOR = {
    'timing.mode': 'realtime', 'solver.cells': 100, 'publish.rate': 100.0,
    'publish.pressure_rate': 0.0, 'publish.sections_rate': 0.0,
}


class ControllerNode(Node):
    """Hears the piston's position, commands the valve, keeps what it heard since it does."""

    def __init__(self, controller):
        super().__init__('position_controller')
        self.time, self.position = [], []
        self._controller = controller
        self._measured = None
        self._commands = self.create_publisher(Float64, 'actuator/spool_command', 1)
        self.create_subscription(JointState, 'joint_states', self._hear, 10)
        self.create_timer(PERIOD, self._tick)

    def _hear(self, state):
        self._measured = state.position[0]
        if self.time or self._ready:
            self.time.append(state.header.stamp.sec + 1e-9 * state.header.stamp.nanosec)
            self.position.append(self._measured)

    def _tick(self):
        if self.time:
            command = self._controller.command(self._measured)
            self._commands.publish(Float64(data=command))

    @property
    def _ready(self):
        return self._commands.get_subscription_count() > 0


def test_the_controller_reaches_the_target_in_real_time(start_actuator):
    start_actuator(ACTUATOR)
    rclpy.init()
    try:
        node = ControllerNode(PositionController(TARGET, PERIOD, GAIN))
        end = time.monotonic() + PATIENCE
        while not node.time or node.time[-1] - node.time[0] < DURATION:
            assert time.monotonic() < end, 'the actuator is not heard'
            rclpy.spin_once(node, timeout_sec=0.1)
        node.destroy_node()
    finally:
        rclpy.try_shutdown()
    metrics = step_metrics(node.time, node.position, TARGET)
    assert 0.2 < metrics.rise_time < 1.5
    assert metrics.overshoot < 0.5
    assert abs(metrics.steady_error) < 0.05 * TARGET
