# SPDX-License-Identifier: Apache-2.0
"""What measurements of nodes in processes of their own share: domain, transitions, figures."""

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
import time

from hydra_actuator.errors import Failure
from hydra_actuator.recording.reader import load_recording, Recording
from hydra_actuator.ros.child import ChildNode
from hydra_actuator.ros.domain import alone
from lifecycle_msgs.msg import Transition
from lifecycle_msgs.srv import ChangeState
import rclpy
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions

# The first start on a machine compiles the solver; several starts share its processors.
PATIENCE = 240.0

Progress = Callable[[float], None]


@contextmanager
def ground() -> Iterator[None]:
    """Have rclpy ready on a domain of its own, whose environment is this process's meanwhile."""
    with alone():
        rclpy.init(args=[], signal_handler_options=SignalHandlerOptions.NO)
        try:
            yield
        finally:
            rclpy.try_shutdown()


def recording_into(output: Path, configs: list[str]) -> list[str]:
    """Return the ROS arguments of a node that waits for transitions and records into a folder."""
    return [
        *(part for path in configs for part in ('--params-file', str(path))),
        '-p', 'autostart:=false', '-p', 'recording.enabled:=true',
        '-p', f'recording.directory:="{output.absolute()}"']


def change_all(driver: Node, children: Mapping[str, ChildNode], transition: int) -> None:
    """
    Have nodes, by their fully qualified names, make a transition at once.

    Raises Failure if one ends, refuses, or does not answer within PATIENCE.
    """
    clients = {name: driver.create_client(ChangeState, f'{name}/change_state')
               for name in children}
    deadline = time.monotonic() + PATIENCE
    _wait_for(lambda: all(one.service_is_ready() for one in clients.values()),
              lambda: time.sleep(0.02), children, deadline)
    request = ChangeState.Request(transition=Transition(id=transition))
    futures = {name: client.call_async(request) for name, client in clients.items()}
    _wait_for(lambda: all(future.done() for future in futures.values()),
              lambda: rclpy.spin_once(driver, timeout_sec=0.02), children, deadline)
    for name, future in futures.items():
        if not future.result().success:
            raise Failure(f'{name} refused transition {transition}; {children[name].last_line}')
    for client in clients.values():
        driver.destroy_client(client)


def last_values(recording: Path, part: str) -> dict[str, str]:
    """Return the last values of a part's status in a recording, none if it has no such."""
    told = statuses_over_time(load_recording(recording), part)
    return told[-1][1] if told else {}


def statuses_over_time(recording: Recording, part: str) -> list[tuple[int, dict[str, str]]]:
    """Return log time [ns] and values of each status of a part that has some."""
    return [
        (message['log_ns'], {one['key']: one['value'] for one in status['values']})
        for message in recording.diagnostics for status in message['status']
        if status['name'].endswith(f': {part}') and status['values']]


def _wait_for(
    reached: Callable[[], bool], idle: Callable[[], None], children: Mapping[str, ChildNode],
    deadline: float,
) -> None:
    while not reached():
        for child in children.values():
            child.check()
        if time.monotonic() > deadline:
            words = '; '.join(f'{name}: {one.last_line}' for name, one in children.items())
            raise Failure(f'no answer within {PATIENCE:.0f} s; {words}')
        idle()
