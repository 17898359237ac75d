# SPDX-License-Identifier: Apache-2.0
"""
The main job, alone: a node in a process of its own, driven over DDS from this one, recorded.

    start the node -> wait for its first joint state -> sine on ~/spool_command, listening
    -> stop the node with SIGINT -> look at the recording and at what was heard
"""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
import ctypes
from dataclasses import dataclass, field
import os
from pathlib import Path
import re
import signal
import subprocess
import sys
import tempfile
import time

from hydra_actuator.errors import Failure
from hydra_actuator.ros.domain import loopback_environment, own_domain

FREQUENCY = 50.0
# The first start on a machine compiles the solver.
START_PATIENCE = 240.0
STOP_PATIENCE = 5.0
# A command that comes in stairs of a millisecond, now and then of several, hits an ideal spool
# like a hammer, and the tank's side goes below vacuum; a fast servo-valve (full stroke in 2.5 ms)
# takes the sine as it is meant.
VALVE = {'valve.natural_frequency': 200.0, 'valve.slew_rate': 0.2}
# Asked for; where it is not granted the node runs as it is.
PRIORITY = {'timing.thread_priority': 20}
_PR_SET_PDEATHSIG = 1

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
    with own_domain() as domain:
        environment = loopback_environment(domain)
        os.environ.clear()
        os.environ.update(environment)
        with tempfile.TemporaryFile() as log, _node(output, log) as node:
            run = _drive(node, log, duration, progress)
            run.exit_code = _stop(node)
            run.recording = _recording(_text(log))
            return run


@contextmanager
def _node(output: Path, log) -> Iterator[subprocess.Popen]:
    """Run the node until it is stopped, or at the latest until this context ends."""
    settings = {**VALVE, **PRIORITY}
    assigned = [part for name, value in settings.items() for part in ('-p', f'{name}:={value}')]
    command = [
        sys.executable, '-m', 'hydra_actuator', 'node', '--ros-args', *assigned,
        '-p', f'recording.directory:="{output.absolute()}"', '-p', 'recording.enabled:=true',
        '-p', 'autostart:=true',
    ]
    # In a session of its own: Ctrl-C is for us, and we stop the node in order.
    node = subprocess.Popen(
        command, stdin=subprocess.DEVNULL, stdout=log, stderr=log, start_new_session=True,
        preexec_fn=_end_with_parent)
    try:
        yield node
    finally:
        _stop(node)


def _end_with_parent() -> None:
    """Have the kernel end the node if this process is killed."""
    ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, signal.SIGTERM)


def _stop(node: subprocess.Popen) -> int:
    """Stop the node as Ctrl-C would, by force if it does not answer; return its exit code."""
    if node.poll() is None:
        node.send_signal(signal.SIGINT)
        try:
            node.wait(STOP_PATIENCE)
        except subprocess.TimeoutExpired:
            node.kill()
    return node.wait()


def _drive(node: subprocess.Popen, log, duration: float, progress: Progress) -> DemoRun:
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
                      node, log, begin + START_PATIENCE)
            run = DemoRun(Path(), 0, 0, time.monotonic() - begin)
            sender.start()
            _watch(node, log, duration, progress)
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


def _wait_for(arrived: Callable[[], object], node, log, deadline: float) -> None:
    """Wait until something has arrived; Failure if the node ends or the time is over."""
    while not arrived():
        _check_alive(node, log)
        if time.monotonic() > deadline:
            raise Failure(f'no joint state within {START_PATIENCE:.0f} s; {_last_line(log)}')
        time.sleep(0.05)


def _watch(node, log, duration: float, progress: Progress) -> None:
    """Wait for the end of the run, showing how far it is."""
    begin = time.monotonic()
    while (elapsed := time.monotonic() - begin) < duration:
        progress(elapsed / duration)
        _check_alive(node, log)
        time.sleep(min(0.1, duration - elapsed))


def _check_alive(node, log) -> None:
    if node.poll() is not None:
        raise Failure(f'the node ended with code {node.returncode}; {_last_line(log)}')


def _text(log) -> str:
    """Return what the node has printed."""
    log.seek(0)
    return log.read().decode('utf-8', 'replace')


def _last_line(log) -> str:
    lines = _text(log).strip().splitlines()
    return f'it said: {lines[-1]}' if lines else 'it said nothing'


def _recording(text: str) -> Path:
    """Return the recording that the node said it writes."""
    found = re.search(r'recording to (.+)$', text, re.MULTILINE)
    if found is None:
        raise Failure('the node recorded nothing')
    return Path(found.group(1))
