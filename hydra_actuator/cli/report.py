# SPDX-License-Identifier: Apache-2.0
"""`hydra_actuator report RECORDING -o report.html`: one self-contained page about a recording."""

import argparse
from pathlib import Path

SUMMARY = 'one self-contained page about a recording'


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add what the verb takes."""
    parser.add_argument('recording', type=Path, metavar='RECORDING',
                        help='a recording directory, or one MCAP file')
    parser.add_argument('-o', '--output', type=Path, required=True, metavar='REPORT.html',
                        help='the page to write; an earlier report there is replaced, '
                             'any other file is refused')


def run(arguments: argparse.Namespace) -> int:
    """Write the page and name it."""
    from hydra_actuator.analysis.report import write_report

    path = write_report(arguments.recording, arguments.output)
    print(f'{path}: {path.stat().st_size / 1e6:.1f} MB')
    return 0
