# SPDX-License-Identifier: Apache-2.0
"""`hydra_actuator demo`: the main job, alone, from node to report."""

import argparse
import math
from pathlib import Path
import sys

from hydra_actuator.errors import Failure, InputError

SUMMARY = 'the node in real time, driven over DDS, recorded and reported'


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add what the verb takes."""
    parser.add_argument('--duration', type=float, default=10.0, metavar='T',
                        help='of the sine [s] (default 10)')
    parser.add_argument('-o', '--output', type=Path, default=Path('recordings'), metavar='DIR',
                        help='folder for the recording and report.html (default recordings)')
    parser.add_argument('--no-report', action='store_true', help='leave the report out')


def run(arguments: argparse.Namespace) -> int:
    """Run node and driver, print the summary, write the report; 1 if a check fails."""
    from importlib.util import find_spec

    if not 0.5 <= arguments.duration < math.inf:
        raise InputError(f'--duration {arguments.duration:g}: at least 0.5 s is wanted')
    if find_spec('rclpy') is None:
        raise InputError('rclpy is not installed: source a ROS 2 setup, or make venv')
    from hydra_actuator.cli.progress import ProgressBar
    from hydra_actuator.ros.demo import run_demo
    from hydra_actuator.ros.demo_summary import summarise

    print(f'50 Hz sine at full stroke for {arguments.duration:g} s; the first start on a '
          'machine compiles the solver', flush=True)
    with ProgressBar('demo') as progress:
        left = run_demo(arguments.duration, arguments.output, progress)
    summary = summarise(left)
    print(summary.text())
    print(f'recording: {left.recording}', flush=True)
    if not arguments.no_report:
        from hydra_actuator.analysis.report import write_report

        print(f'report: {write_report(left.recording, arguments.output / "report.html")}')
    for sentence in summary.failed:
        print(f'check failed: {sentence}', file=sys.stderr)
    if summary.failed:
        raise Failure(f'{len(summary.failed)} checks failed')
    return 0
