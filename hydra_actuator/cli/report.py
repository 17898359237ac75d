# SPDX-License-Identifier: Apache-2.0
"""`hydra_actuator report RECORDING [OTHER] -o report.html`: one self-contained page."""

import argparse
from pathlib import Path

from hydra_actuator.cli.plot import add_units, units_of
from hydra_actuator.errors import InputError

SUMMARY = 'one self-contained page about a recording, or a sweep'


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add what the verb takes."""
    parser.add_argument('recording', type=Path, metavar='RECORDING',
                        help='directory of a recording or of a sweep, or one MCAP file')
    parser.add_argument('other', type=Path, nargs='?', metavar='OTHER',
                        help='a second recording, to compare the first one with')
    parser.add_argument('-o', '--output', type=Path, required=True, metavar='REPORT.html',
                        help='the page to write; an earlier report there is replaced, '
                             'any other file is refused')
    add_units(parser)


def run(arguments: argparse.Namespace) -> int:
    """Write the page and name it."""
    if (arguments.recording / 'sweep.json').is_file():
        return _sweep(arguments)
    from hydra_actuator.analysis.report import write_report

    path = write_report(arguments.recording, arguments.output, arguments.other,
                        lambda series: units_of(arguments, series))
    print(f'{path}: {path.stat().st_size / 1e6:.1f} MB')
    return 0


def _sweep(arguments: argparse.Namespace) -> int:
    """Write the page about a sweep, which shows engineers' units and compares with nothing."""
    if arguments.other is not None:
        raise InputError('a sweep is not compared with another: one directory')
    from hydra_actuator.sweep.report import write_report

    path = write_report(arguments.recording, arguments.output)
    print(f'{path}: {path.stat().st_size / 1e6:.1f} MB')
    return 0
