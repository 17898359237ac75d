# SPDX-License-Identifier: Apache-2.0
"""
The main job, alone: a node in a process of its own, driven over DDS from this one, recorded.

    start the node -> wait for its first joint state -> sine on ~/spool_command, listening
    -> stop the node with SIGINT -> look at the recording and at what was heard
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
import time

from hydra_actuator.errors import Failure
from hydra_actuator.ros.child import ChildNode
from hydra_actuator.ros.domain import alone

FREQUENCY = 50.0
# The first start on a machine compiles the solver.
START_PATIENCE = 240.0
# A command that comes in stairs of a millisecond, now and then of several, hits an ideal spool
# like a hammer, and the tank's side goes below vacuum; a fast servo-valve (full stroke in 2.5 ms)
# takes the sine as it is meant.
VALVE = {'valve.natural_frequency': 200.0, 'valve.slew_rate': 0.2}
# Asked for; where it is not granted the node runs as it is.
PRIORITY = {'timing.thread_priority': 20}

Progress = Callable[[float], None]


@dataclass
class DemoRun:
    """What a run left: its recording, what was sent and heard, and how the node ended."""

    recording: Path
    exit_code: int
    sent: int
    start_time: float
    heard: dict = field(default_factory=dict)
    errors: list = field(default_factory=list)


def run_demo(duration: float, output: Path, progress: Progress) -> DemoRun:
    """
    Run the node and drive it for `duration` [s]; its recording goes into the folder `output`.

    The node runs on the defaults, which are those of config/actuator.yaml, with the spool of a
    fast servo-valve. Raises Failure if the node does not come up.
    """
    with alone():
        with ChildNode(_ros_arguments(output)) as node:
            run = _drive(node, duration, progress)
            run.exit_code = node.stop()
            run.recording = node.recording
            return run


def _ros_arguments(output: Path) -> list[str]:
    settings = {**VALVE, **PRIORITY}
    assigned = [part for name, value in settings.items() for part in ('-p', f'{name}:={value}')]
    return [
        *assigned, '-p', f'recording.directory:="{output.absolute()}"',
        '-p', 'recording.enabled:=true', '-p', 'autostart:=true',
    ]


def _drive(node: ChildNode, duration: float, progress: Progress) -> DemoRun:
    """Send the sine over DDS and listen."""
    from hydra_actuator.ros.driver import Listener, SineSender
    import rclpy
    from rclpy.signals import SignalHandlerOptions

    begin = time.monotonic()
    rclpy.init(args=[], signal_handler_options=SignalHandlerOptions.NO)
    try:
        own = rclpy.create_node('demo_driver', start_parameter_services=False)
        listener, sender = Listener(own), SineSender(own, FREQUENCY)
        listener.start()
        try:
            _wait_for(lambda: listener.heard['joint_states'].stamps and sender.heard_by,
                      node, begin + START_PATIENCE)
            run = DemoRun(Path(), 0, 0, time.monotonic() - begin)
            sender.start()
            _watch(node, duration, progress)
        finally:
            sender.stop()
            # What is under way arrives.
            time.sleep(0.2)
            listener.stop()
        run.sent, run.heard, run.errors = sender.sent, listener.heard, listener.errors
        own.destroy_node()
        return run
    finally:
        rclpy.try_shutdown()


def _wait_for(arrived: Callable[[], object], node: ChildNode, deadline: float) -> None:
    """Wait until something has arrived; Failure if the node ends or the time is over."""
    while not arrived():
        node.check()
        if time.monotonic() > deadline:
            raise Failure(f'no joint state within {START_PATIENCE:.0f} s; {node.last_line}')
        time.sleep(0.05)


def _watch(node: ChildNode, duration: float, progress: Progress) -> None:
    """Wait for the end of the run, showing how far it is."""
    begin = time.monotonic()
    while (elapsed := time.monotonic() - begin) < duration:
        progress(elapsed / duration)
        node.check()
        time.sleep(min(0.1, duration - elapsed))
