# SPDX-License-Identifier: Apache-2.0
"""The publishers of the actuator's state: made together, destroyed together."""

from hydra_actuator.parameters import Parameters
from hydra_actuator.recording.topics import ActuatorTopics
from hydra_actuator.ros.outputs import Publish
from rclpy.node import Node
from rclpy.qos_overriding_options import QoSOverridingOptions
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import FluidPressure, JointState
from std_msgs.msg import Float32MultiArray, Float64MultiArray

DEPTH = 10


class Publishers:
    """
    Publishers of state, by topic, reliable and volatile unless overridden.

    `publish` maps full names of topics, as remapped, to functions that take a message's bytes.
    """

    def __init__(self, node: Node):
        self.publish: dict[str, Publish] = {}
        self._node = node
        self._publishers = []
        self._clock = ''

    def create(
        self, parameters: Parameters, topics: ActuatorTopics, clock: bool = False
    ) -> None:
        """
        Create what the parameters want, and write the full names into `topics`.

        clock: whether /clock goes out, whatever the parameters say.
        """
        topics.joint_states = self._create(JointState, 'joint_states')
        topics.true_joint_states = self._create(JointState, '~/true_joint_states')
        topics.sections = self._create(Float64MultiArray, '~/sections')
        if parameters['fluid.cavitation']:
            topics.cavities = self._create(Float64MultiArray, '~/cavities')
        topics.applied = self._create(Float64MultiArray, '~/applied')
        for name in topics.pressure:
            topics.pressure[name] = self._create(FluidPressure, f'~/pressure/{name}')
        if parameters['publish.field']:
            topics.field = self._create(Float32MultiArray, '~/field')
        if clock or parameters['publish.clock']:
            topics.clock = self._clock = self._create(Clock, '/clock')

    def rivals(self) -> int:
        """Return how many others publish the same /clock; 0 if none is published here."""
        return self._node.count_publishers(self._clock) - 1 if self._clock else 0

    def destroy(self) -> None:
        """Give all publishers up."""
        for publisher in self._publishers:
            self._node.destroy_publisher(publisher)
        self._publishers.clear()
        self.publish.clear()
        self._clock = ''

    def _create(self, message_type, topic: str) -> str:
        """Create a publisher and return its topic's full name."""
        publisher = self._node.create_publisher(
            message_type, topic, DEPTH,
            qos_overriding_options=QoSOverridingOptions.with_default_policies())
        self._publishers.append(publisher)
        self.publish[publisher.topic_name] = publisher.publish
        return publisher.topic_name
