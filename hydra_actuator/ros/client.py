# SPDX-License-Identifier: Apache-2.0
"""
The other side of lockstep: send a command, wait for the state it leads to.

    rclpy.init()
    node = rclpy.create_node('controller')
    with LockstepClient(node) as actuator:
        state = actuator.connect()
        for _ in range(1000):
            state = actuator.step(-0.5 * state.position[0] / 0.01)

The actuator has to run with `timing.mode` lockstep and without `timing.free_wheel`, whose states
nobody asked for would be taken for answers. The node need not be spun, and may be: no
executor ever sees the client's subscription. A client of one's own does as well, with any
publisher that is reliable.
"""

from contextlib import contextmanager
import time

from hydra_actuator.errors import Failure
from hydra_actuator.ros.reception import HiddenGroup
from rclpy.impl.implementation_singleton import rclpy_implementation
from rclpy.node import Node
from rclpy.qos import QoSProfile
from rclpy.serialization import deserialize_message
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64MultiArray

# The node shows its initial state once a second until the first command.
_REPETITION = 1.5
_QOS = QoSProfile(depth=100)


class NoAnswerError(Failure):
    """The actuator did not answer in time; the text says what was missing."""


class LockstepClient:
    """
    Advances an actuator in lockstep, one period a command.

    node: of the caller; actuator: fully qualified name of the actuator's node; patience [s]:
    longest wait for anything, a start that compiles included. `state` is the last one it heard.
    """

    def __init__(self, node: Node, actuator: str = '/actuator', patience: float = 240.0):
        self.state: JointState | None = None
        self._node = node
        self._patience = patience
        self._stamp: int | None = None
        self._stepped = False
        namespace = actuator.rpartition('/')[0]
        self._publisher = node.create_publisher(
            Float64MultiArray, f'{actuator}/commands', _QOS)
        self._states = node.create_subscription(
            JointState, f'{namespace}/joint_states', lambda state: None, _QOS, raw=True,
            callback_group=HiddenGroup())

    def __enter__(self) -> 'LockstepClient':
        return self

    def __exit__(self, *_) -> None:
        self.close()

    def connect(self) -> JointState | None:
        """
        Wait until the actuator is there, or has been reset; return its initial state.

        None if it has been commanded before: then it shows no state until the next command.
        Raises NoAnswerError.
        """
        self._stamp, self._stepped = None, False
        end = time.monotonic() + self._patience
        while not (self._publisher.get_subscription_count()
                   and self._node.count_publishers(self._states.topic_name)):
            if time.monotonic() > end:
                raise NoAnswerError(
                    f'no actuator takes {self._publisher.topic_name} within {self._patience:g} s')
            time.sleep(0.01)
        with self._waiting() as next_state:
            newest = state = next_state(time.monotonic() + _REPETITION)
            while state is not None:
                newest, state = state, next_state(0.0)
        return newest

    def step(self, *spools: float) -> JointState:
        """
        Send one command (normalised, one value a spool) and return the state it leads to.

        Raises NoAnswerError, which is also what a command that is dropped leads to.
        """
        command = Float64MultiArray(data=[float(spool) for spool in spools])
        end = time.monotonic() + self._patience
        before = self._stamp
        with self._waiting() as next_state:
            sent = time.monotonic()
            self._publisher.publish(command)
            while True:
                state = next_state(end)
                if state is None:
                    raise NoAnswerError(
                        f'no state after the command {list(spools)} within '
                        f'{self._patience:g} s')
                if self._stamp != before:
                    self._stepped = True
                    return state
                # Still the initial state: the command was sent before the actuator had found
                # this publisher. One that is queued would have been obeyed before a repetition.
                if not self._stepped and time.monotonic() - sent > _REPETITION:
                    sent = time.monotonic()
                    self._publisher.publish(command)

    def close(self) -> None:
        """Give publisher and subscription up."""
        self._node.destroy_publisher(self._publisher)
        self._node.destroy_subscription(self._states)

    @contextmanager
    def _waiting(self):
        """Yield a function that returns the next state, None if there is none until an instant."""
        wait_set = rclpy_implementation.WaitSet(1, 0, 0, 0, 0, 0, self._node.context.handle)

        def next_state(end: float) -> JointState | None:
            while True:
                with self._states.handle:
                    taken = self._states.handle.take_message(JointState, True)
                if taken is not None:
                    state = self.state = deserialize_message(taken[0], JointState)
                    stamp = state.header.stamp
                    self._stamp = stamp.sec * 1_000_000_000 + stamp.nanosec
                    return state
                remaining = end - time.monotonic()
                if remaining <= 0.0:
                    return None
                wait_set.clear_entities()
                wait_set.add_subscription(self._states.handle)
                wait_set.wait(int(remaining * 1e9))

        with wait_set:
            yield next_state
