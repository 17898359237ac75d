# SPDX-License-Identifier: Apache-2.0
"""
What is put beside a node to measure it: a bare sleeper, a busy core, a flood, steps of command.

Sleeper and busy core are processes of their own, so that they share nothing with the node but the
machine. The sleeper is what the machine allows: a loop on the same deadlines that does nothing.
"""

from collections.abc import Iterator
from contextlib import contextmanager
import multiprocessing
import struct
import threading
import time

from hydra_actuator.parameters import Parameters
from hydra_actuator.realtime.durations import DurationHistogram
from hydra_actuator.realtime.pacer import Pacer
from hydra_actuator.recording.messages import float64
from hydra_actuator.ros.reception import Reception
from hydra_actuator.ros.scheduling import prepare_thread
from rclpy.node import Node
from rclpy.qos import QoSProfile
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64

FLOOD_RATE = 10_000.0
COMMAND = '/actuator/spool_command'
# Between steps of command [s]: no whole number of ticks, so that all phases of a tick occur.
STEP_PERIOD = 0.0137
_PATIENCE = 60.0
_spawn = multiprocessing.get_context('spawn')


@contextmanager
def sleeper(parameters: Parameters) -> Iterator['multiprocessing.Queue']:
    """Run a bare sleeper meanwhile; afterwards its Pacer is what the queue holds."""
    queue, ready, stopping = _spawn.Queue(), _spawn.Event(), _spawn.Event()
    process = _spawn.Process(
        target=_sleep, args=(parameters, queue, ready, stopping), daemon=True)
    process.start()
    try:
        ready.wait(_PATIENCE)
        yield queue
    finally:
        stopping.set()
        process.join(_PATIENCE)


@contextmanager
def busy_core() -> Iterator[None]:
    """Keep a core busy meanwhile."""
    ready, stopping = _spawn.Event(), _spawn.Event()
    process = _spawn.Process(target=_burn, args=(ready, stopping), daemon=True)
    process.start()
    try:
        ready.wait(_PATIENCE)
        yield
    finally:
        stopping.set()
        process.join(_PATIENCE)


def _sleep(parameters: Parameters, queue, ready, stopping) -> None:
    prepare_thread(parameters)
    pacer = Pacer(
        parameters['timing.period'], parameters['timing.overrun_policy'],
        parameters['timing.max_burst'])
    ready.set()
    pacer.start()
    while not pacer.ticks or pacer.ticks % 100 or not stopping.is_set():
        if pacer.wait() is None:
            break
    pacer.stop()
    queue.put((pacer.lateness, pacer.ticks, pacer.missed))


def _burn(ready, stopping) -> None:
    ready.set()
    while not stopping.is_set():
        sum(range(10_000))


class Flood:
    """Sends commands on absolute deadlines at FLOOD_RATE while it is entered."""

    def __init__(self, node: Node):
        self.sent = 0
        self._publisher = node.create_publisher(Float64, COMMAND, QoSProfile(depth=1))
        self._stopping = False
        self._thread = threading.Thread(target=self._run, daemon=True)

    def __enter__(self) -> 'Flood':
        self._thread.start()
        return self

    def __exit__(self, *_) -> None:
        self._stopping = True
        self._thread.join()

    def _run(self) -> None:
        begin = time.monotonic()
        while not self._stopping:
            due = begin + self.sent / FLOOD_RATE
            wait = due - time.monotonic()
            if wait > 0.0:
                time.sleep(wait)
            self._publisher.publish(float64(0.01 * (self.sent % 7)))
            self.sent += 1


class Steps:
    """
    Sends a new command every STEP_PERIOD, and notes when the first state shows it.

    latency: of each command that was seen [ns], from before it is published to when this
    process has the joint state whose spool it set; lost: commands that no state showed.
    """

    def __init__(self, node: Node, stroke: float):
        self.latency = DurationHistogram()
        self.lost = 0
        self._stroke = stroke
        self._publisher = node.create_publisher(Float64, COMMAND, QoSProfile(depth=1))
        self._reception = Reception(node, lambda error: None)
        self._reception.subscribe(
            JointState, '/joint_states', self._receive, qos_profile=QoSProfile(depth=1000))
        self._wanted = None
        self._sent = 0
        self._stopping = False
        self._thread = threading.Thread(target=self._run, daemon=True)

    def __enter__(self) -> 'Steps':
        self._reception.start()
        self._thread.start()
        return self

    def __exit__(self, *_) -> None:
        self._stopping = True
        self._thread.join()
        self._reception.destroy()

    def _run(self) -> None:
        begin, number = time.monotonic(), 0
        while not self._stopping:
            number += 1
            time.sleep(max(0.0, begin + number * STEP_PERIOD - time.monotonic()))
            # No two commands alike, so that a state shows which one it is.
            command = 0.02 * (-1.0) ** number + 1e-6 * (number % 10_000)
            self.lost += self._wanted is not None
            self._sent = time.perf_counter_ns()
            self._wanted = struct.pack('<d', command * self._stroke)
            self._publisher.publish(float64(command))

    def _receive(self, data: bytes, received: int, sent: int) -> None:
        wanted = self._wanted
        if wanted is not None and wanted in data:
            self.latency.add(time.perf_counter_ns() - self._sent)
            self._wanted = None
