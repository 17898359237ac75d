# SPDX-License-Identifier: Apache-2.0
"""
Look at a running actuator now and then: the newest state, sections, diagnostics and events.

Messages are taken only when somebody looks, the newest of each topic: at 1 kHz nearly all of them
are dropped unread, and a look costs next to nothing. Changes nothing at the node but one more
listener.
"""

from collections import deque
import time

from diagnostic_msgs.msg import DiagnosticArray
from hydra_actuator.errors import Failure
from hydra_actuator.ros.live_view import EVENTS, HISTORY, Snapshot, Status, view
from hydra_actuator.ros.reception import HiddenGroup
import rclpy
from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy
from rclpy.signals import SignalHandlerOptions
from rich.console import Console
from rich.live import Live as Screen
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64MultiArray

PATIENCE = 5.0          # [s] for a node to be heard, where one view is all
SILENT = 0.5            # [s] without a state after which it is asked who is there
NEWEST = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
ALL = QoSProfile(depth=50)
MARK = '/applied'       # the topic by which an actuator is known


class Live:
    """Takes what an actuator says; `look` returns how it stands."""

    def __init__(self, node: Node, actuator: str = '/actuator') -> None:
        """Listen as a node; actuator: fully qualified name of the actuator's node."""
        group = HiddenGroup()
        self._node = node
        self._history: deque[float] = deque(maxlen=HISTORY)
        self._events: deque[tuple[float, int, str]] = deque(maxlen=EVENTS)
        self._heard = float('-inf')

        def listen(kind, topic, profile):
            return node.create_subscription(
                kind, topic, lambda message: None, profile, callback_group=group)
        self._states = listen(JointState, f'{actuator.rpartition("/")[0]}/joint_states', NEWEST)
        self._sections = listen(Float64MultiArray, f'{actuator}/sections', NEWEST)
        self._diagnostics = listen(DiagnosticArray, '/diagnostics', ALL)
        self._said = listen(DiagnosticArray, f'{actuator}/events', ALL)
        domain = node.context.get_domain_id()
        self._snapshot = Snapshot(
            actuator, f'joint states on {self._states.topic_name}, ROS domain {domain}',
            history=self._history, events=self._events)

    def look(self) -> Snapshot:
        """Return the newest of everything."""
        snapshot = self._snapshot
        state = _newest(self._states, JointState)
        if state is not None:
            self._heard = time.monotonic()
            self._take_state(state)
        sections = _newest(self._sections, Float64MultiArray)
        if sections is not None:
            snapshot.sections = sections_of(sections)
            snapshot.top = max(snapshot.top, *(pressure for _, pressure, _ in snapshot.sections))
        while (said := _take(self._diagnostics, DiagnosticArray)) is not None:
            for status in said.status:
                node, _, part = status.name.partition(': ')
                if node == snapshot.node:
                    snapshot.statuses[part] = Status(
                        _level(status), status.message,
                        {value.key: value.value for value in status.values})
        while (said := _take(self._said, DiagnosticArray)) is not None:
            self._events.extend((_seconds(said), _level(status), status.message)
                                for status in said.status)
        snapshot.age = time.monotonic() - self._heard
        if snapshot.age > SILENT:
            self._look_around()
        return snapshot

    def _take_state(self, state: JointState) -> None:
        snapshot = self._snapshot
        snapshot.stamp = _seconds(state)
        snapshot.position, *spools = state.position
        snapshot.spools = tuple(spools)
        snapshot.velocity, snapshot.effort = state.velocity[0], state.effort[0]
        snapshot.present = True
        self._history.append(snapshot.position)

    def _look_around(self) -> None:
        """See who publishes what is listened to, and which actuators there are."""
        snapshot, node = self._snapshot, self._node
        snapshot.present = node.count_publishers(f'{snapshot.node}{MARK}') > 0
        snapshot.others = tuple(
            topic.removesuffix(MARK) for topic, _ in node.get_topic_names_and_types()
            if topic.endswith(MARK) and node.count_publishers(topic))


def show(actuator: str, rate: float, once: bool) -> None:
    """
    Show an actuator in the terminal at a rate [Hz] until Ctrl-C, or once.

    Raises Failure where one view is all and nothing is heard within PATIENCE.
    """
    rclpy.init(args=[], signal_handler_options=SignalHandlerOptions.NO)
    try:
        node = rclpy.create_node('watch', start_parameter_services=False)
        live, console = Live(node, actuator), Console()
        if once:
            console.print(view(_first(live)))
            return
        with Screen(console=console, screen=True, auto_refresh=False) as screen:
            while True:
                screen.update(view(live.look()), refresh=True)
                time.sleep(1.0 / rate)
    finally:
        rclpy.try_shutdown()


def _first(live: Live) -> Snapshot:
    """Return a snapshot with all that a node says every second, or what came in time."""
    end = time.monotonic() + PATIENCE
    snapshot = live.look()
    while time.monotonic() < end and not (
            snapshot.position is not None and snapshot.sections and snapshot.statuses):
        time.sleep(0.05)
        snapshot = live.look()
    if snapshot.position is None:
        others = [name for name in snapshot.others if name != snapshot.node]
        here = f'; actuators here: {", ".join(others)}' if others else ''
        raise Failure(f'{snapshot.node}: no {snapshot.sought}, within {PATIENCE:g} s{here}')
    return snapshot


def sections_of(message: Float64MultiArray) -> tuple[tuple[str, float, float], ...]:
    """Return (name, pressure [Pa], velocity [m/s]) of every section of a message of ~/sections."""
    names = message.layout.dim[0].label.split(',')
    values = message.data[message.layout.data_offset:]
    return tuple(zip(names, values[0::2], values[1::2]))


def _seconds(message) -> float:
    """Return the stamp [s] of a message."""
    return message.header.stamp.sec + message.header.stamp.nanosec * 1e-9


def _level(status) -> int:
    """Return the level of a status."""
    return int.from_bytes(status.level, 'big')


def _take(subscription, kind):
    """Return the next message of a subscription, or None."""
    with subscription.handle:
        taken = subscription.handle.take_message(kind, False)
    return None if taken is None else taken[0]


def _newest(subscription, kind):
    """Return the last of the messages that wait, or None."""
    newest = None
    while (message := _take(subscription, kind)) is not None:
        newest = message
    return newest
