# SPDX-License-Identifier: Apache-2.0
"""`hydra_actuator watch`: a live view of a running node in the terminal."""

from argparse import ArgumentParser, Namespace
from importlib.util import find_spec
import math
import signal
import sys

from hydra_actuator.errors import InputError

SUMMARY = 'a live view of a running node in the terminal'


def add_arguments(parser: ArgumentParser) -> None:
    """Declare the command line."""
    parser.add_argument('node', nargs='?', default='/actuator', metavar='NODE',
                        help='fully qualified name of the node (default /actuator)')
    parser.add_argument('--rate', type=float, default=10.0, metavar='HZ',
                        help='how often the view is drawn (default 10)')
    parser.add_argument('--once', action='store_true',
                        help='print one view and end; also without a terminal')


def run(arguments: Namespace) -> int:
    """Draw until Ctrl-C, or once."""
    if not 0.1 <= arguments.rate <= 60.0 or not math.isfinite(arguments.rate):
        raise InputError(f'--rate {arguments.rate:g} is not within 0.1 to 60')
    if not arguments.node.startswith('/'):
        raise InputError(f'{arguments.node} is no fully qualified name: it begins with a /')
    if not arguments.once and not sys.stdout.isatty():
        raise InputError('a live view needs a terminal; --once prints one view')
    if find_spec('rclpy') is None:
        raise InputError('rclpy is not installed: source a ROS 2 setup, or make venv')
    if find_spec('rich') is None:
        raise InputError("watch needs rich: pip install 'hydra_actuator[watch]'")
    from hydra_actuator.ros.live import show

    for number in (signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, _end)
    show(arguments.node, arguments.rate, arguments.once)
    return 0


def _end(number: int, _frame) -> None:
    """End in order, so that the terminal is left as it was."""
    raise SystemExit(128 + number)
