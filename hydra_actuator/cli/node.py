# SPDX-License-Identifier: Apache-2.0
"""`hydra_actuator node --ros-args ...`: the actuator as a ROS 2 node."""

import argparse

from hydra_actuator.errors import InputError

SUMMARY = 'the actuator as a ROS 2 node; takes --ros-args'
ROS_ARGUMENTS = True


def prepare() -> None:
    """Take SIGINT and SIGTERM before anything heavy is imported."""
    from hydra_actuator.ros.stopping import take_signals

    take_signals()


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add nothing: parameters and remappings come by --ros-args."""
    parser.epilog = (
        'for instance: --ros-args --params-file config/actuator.yaml -p valve.stroke:=0.0004')


def run(arguments: argparse.Namespace) -> int:
    """Run the node until a signal."""
    from importlib.util import find_spec

    if find_spec('rclpy') is None:
        raise InputError('rclpy is not installed: source a ROS 2 setup, or make venv')
    from hydra_actuator.ros.main import main

    return main(arguments.ros_arguments)
