# SPDX-License-Identifier: Apache-2.0
"""What the verb `bench` measures over DDS: punctuality, recorder, how many nodes."""

import argparse
from importlib.util import find_spec
import os
from pathlib import Path
import statistics
import tempfile

from hydra_actuator.cli.progress import ProgressBar
from hydra_actuator.errors import InputError

MOST_NODES = 64
SHORTEST_RECORDING = 3.0        # [s]


def need_ros() -> None:
    """Raise InputError where there is no ROS."""
    if find_spec('rclpy') is None:
        raise InputError('rclpy is not installed: source a ROS 2 setup, or make venv')


def print_real_time(arguments: argparse.Namespace, parameters) -> int:
    """Print the table of how late ticks are, and how soon commands are answered."""
    need_ros()
    from hydra_actuator.ros.punctuality import lines, measure

    print(f'{len(os.sched_getaffinity(0))} cores, load average {os.getloadavg()[0]:.1f} before; '
          f'{arguments.duration:g} s each; microseconds, p50 / p99 / p99.9 / max; missed of ticks',
          flush=True)
    with tempfile.TemporaryDirectory() as folder, ProgressBar('bench') as progress:
        for case in measure(
            arguments.duration, arguments.config, parameters, Path(folder), progress
        ):
            progress.clear()
            print('\n'.join(lines(case)), flush=True)
    return 0


def print_recorder(arguments: argparse.Namespace) -> int:
    """Print what became of the messages of a node; the exit code says whether none was dropped."""
    if arguments.duration < SHORTEST_RECORDING:
        raise InputError(f'--duration {arguments.duration:g} s is below {SHORTEST_RECORDING:g} s, '
                         'which a recorder needs to tell of itself')
    need_ros()
    from hydra_actuator.ros.recording_rate import lines, measure_recorder

    print(f'{len(os.sched_getaffinity(0))} cores, load average {os.getloadavg()[0]:.1f} before',
          flush=True)
    with tempfile.TemporaryDirectory() as folder, ProgressBar('bench') as progress:
        found = measure_recorder(arguments.duration, arguments.config, Path(folder), progress)
    print('\n'.join(lines(found)))
    return 1 if found.dropped else 0


def print_nodes(arguments: argparse.Namespace) -> int:
    """Print the table of what each count of nodes reaches."""
    if not 1 <= arguments.nodes <= MOST_NODES:
        raise InputError(f'--nodes {arguments.nodes}: 1 to {MOST_NODES}')
    need_ros()
    from hydra_actuator.ros.fleet import measure_fleets, MOST_MISSED

    print(f'{len(os.sched_getaffinity(0))} cores, load average {os.getloadavg()[0]:.1f} before; '
          f'{arguments.duration:g} s each; holds: every node missed fewer than '
          f'{100.0 * MOST_MISSED:g} % of its ticks')
    print(f'{"nodes":>5}{"missed, worst":>15}{"real time, least":>18}{"p99 late, worst":>17}'
          f'{"CPU per node":>14}{"heard, least":>14}', flush=True)
    with tempfile.TemporaryDirectory() as folder, ProgressBar('bench') as progress:
        for nodes in measure_fleets(
            arguments.nodes, arguments.duration, arguments.config, Path(folder), progress
        ):
            verdict = 'holds' if all(node.holds for node in nodes) else 'does not hold'
            print(f'{len(nodes):5}{max(node.missed for node in nodes):15.2%}'
                  f'{min(node.real_time_factor for node in nodes):18.5f}'
                  f'{1e6 * max(node.lateness for node in nodes):14.0f} us'
                  f'{statistics.mean(node.share for node in nodes):14.1%}'
                  f'{min(node.heard for node in nodes):14.1%}  {verdict}', flush=True)
    return 0
