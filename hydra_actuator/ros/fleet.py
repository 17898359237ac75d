# SPDX-License-Identifier: Apache-2.0
"""
How many actuators one machine holds: nodes side by side, each in a namespace of its own.

    for 1, 2, 4 .. nodes: start all, configure all, activate all, and for some seconds
    command each at 100 Hz over DDS and hear its joint states -> stop all, read their recordings

Figures are those of each node's own status `Real time`, the last one in its recording: what it
counted from its activation on. Publishing and recording are as configured, all by default.
"""

from collections.abc import Iterator
from contextlib import ExitStack
from dataclasses import dataclass
import math
from pathlib import Path
import time

from hydra_actuator.errors import Failure
from hydra_actuator.recording.messages import float64
from hydra_actuator.ros.child import ChildNode
from hydra_actuator.ros.measured import (
    change_all,
    ground,
    last_values,
    Progress,
    recording_into,
)
from hydra_actuator.ros.reception import Reception
from lifecycle_msgs.msg import Transition
import rclpy
from rclpy.qos import QoSProfile
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64

# A count of nodes holds if each missed fewer than this share of its ticks.
MOST_MISSED = 0.005
COMMAND_PERIOD = 0.01
FREQUENCY, AMPLITUDE = 2.0, 0.1


@dataclass(frozen=True)
class NodeFigures:
    """
    What one of several nodes reached.

    missed: share of its ticks; lateness: 99 % of its ticks were less late [s]; share: of one
    core; heard: joint states that came over DDS per tick.
    """

    missed: float
    real_time_factor: float
    lateness: float
    share: float
    heard: float

    @property
    def holds(self) -> bool:
        """Whether it kept its rate."""
        return self.missed < MOST_MISSED


def counts_up_to(most: int) -> list[int]:
    """Return 1, 2, 4 .. below `most`, and `most`."""
    return [2**power for power in range((most - 1).bit_length())] + [most]


def measure_fleets(
    most: int, duration: float, configs: list[str], output: Path, progress: Progress
) -> Iterator[list[NodeFigures]]:
    """
    Yield the figures of each node for 1, 2, 4 .. `most` nodes, `duration` [s] each.

    configs: parameter files of all nodes; output: folder of their recordings. Meanwhile this
    process's ROS environment is theirs. Raises Failure if a node does not come up.
    """
    counts = counts_up_to(most)
    with ground():
        for done, count in enumerate(counts):
            yield _Fleet(count, configs, output).measure(
                duration, lambda share, done=done: progress((done + share) / len(counts)))


class _Fleet:
    """Nodes of one count: their processes, and this side's publishers and subscriptions."""

    def __init__(self, count: int, configs: list[str], output: Path):
        self._names = [f'/of_{count}/number_{k + 1}' for k in range(count)]
        self._configs = configs
        self._output = output
        self._heard = dict.fromkeys(self._names, 0)
        self._errors: list[BaseException] = []

    def measure(self, duration: float, progress: Progress) -> list[NodeFigures]:
        own = rclpy.create_node('fleet_driver', start_parameter_services=False)
        reception = Reception(own, self._errors.append)
        try:
            with ExitStack() as stack:
                children = {
                    f'{name}/actuator': stack.enter_context(ChildNode(self._arguments(name)))
                    for name in self._names}
                change_all(own, children, Transition.TRANSITION_CONFIGURE)
                publishers = self._join(own, reception)
                reception.start()
                change_all(own, children, Transition.TRANSITION_ACTIVATE)
                nodes = list(children.values())
                shares = self._drive(nodes, publishers, duration, progress)
                for child in nodes:
                    child.interrupt()
                codes = [child.stop() for child in nodes]
                recordings = [child.recording for child in nodes]
        finally:
            reception.destroy()
            own.destroy_node()
        if any(codes) or self._errors:
            raise Failure(f'nodes ended with codes {codes}; {self._errors[:1]}')
        return [_figures(path, share, self._heard[name])
                for path, share, name in zip(recordings, shares, self._names)]

    def _arguments(self, namespace: str) -> list[str]:
        return ['-r', f'__ns:={namespace}', *recording_into(self._output, self._configs)]

    def _join(self, own, reception: Reception) -> list:
        """Listen to all joint states; return the publishers of commands."""
        def counter(name: str):
            def count(data: bytes, received: int, sent: int) -> None:
                self._heard[name] += 1
            return count

        for name in self._names:
            reception.subscribe(
                JointState, f'{name}/joint_states', counter(name),
                qos_profile=QoSProfile(depth=1000))
        return [
            own.create_publisher(Float64, f'{name}/actuator/spool_command', QoSProfile(depth=1))
            for name in self._names]

    def _drive(
        self, children: list[ChildNode], publishers: list, duration: float, progress: Progress
    ) -> list[float]:
        """Command all nodes for a while; return the share of a core each of them took."""
        before = [child.processor_time for child in children]
        begin = time.monotonic()
        sent = 0
        while (elapsed := time.monotonic() - begin) < duration:
            command = float64(AMPLITUDE * math.sin(2.0 * math.pi * FREQUENCY * elapsed))
            for publisher in publishers:
                publisher.publish(command)
            sent += 1
            progress(elapsed / duration)
            for child in children:
                child.check()
            time.sleep(max(0.0, begin + sent * COMMAND_PERIOD - time.monotonic()))
        elapsed = time.monotonic() - begin
        return [(child.processor_time - start) / elapsed
                for child, start in zip(children, before)]


def _figures(path: Path, share: float, heard: int) -> NodeFigures:
    """Read what a node has counted from the last status in its recording."""
    values = last_values(path, 'Real time')
    if not values or not int(values['ticks']):
        raise Failure(f'{path} holds no ticks')
    ticks, factor = int(values['ticks']), float(values['real_time_factor'])
    # Ticks over the factor is how many there should have been.
    return NodeFigures(
        int(values['overruns']) * factor / ticks, factor, float(values['lateness_p99']) * 1e-6,
        share, heard / ticks)
