# SPDX-License-Identifier: Apache-2.0
"""The verb `simulate`: an offline run into a recording."""

import argparse
import math
import os

from hydra_actuator.cli.progress import ProgressBar
from hydra_actuator.errors import InputError

SUMMARY = 'an offline run, as fast as possible, into a recording'
DEFAULT_DURATION = 1.0


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of the verb."""
    parser.add_argument('--config', action='append', default=[], metavar='F',
                        help='ROS parameter file; later files win')
    drive = parser.add_mutually_exclusive_group()
    drive.add_argument('--command', metavar='C.csv',
                       help='CSV with header time,spool[,load_force], linear between rows')
    drive.add_argument('--sine', type=float, metavar='HZ', help='sine command')
    drive.add_argument('--step', action='store_true', help='step command at time 0')
    drive.add_argument('--chirp', type=float, nargs=2, metavar=('HZ', 'HZ'),
                       help='sine command sweeping between two frequencies')
    parser.add_argument('--hold', action='store_true',
                        help='hold each row of the CSV until the next')
    parser.add_argument('--amplitude', type=float, default=1.0, metavar='A',
                        help='of the built-in commands, 1 is full spool (default 1)')
    parser.add_argument('--duration', type=float, metavar='T',
                        help='[s]; default: the CSV to its end, else 1')
    parser.add_argument('--rate', type=float, metavar='HZ', help='of states and pressures')
    parser.add_argument('-o', '--output', required=True, metavar='OUT',
                        help='directory of the new recording')


def run(arguments: argparse.Namespace) -> int:
    """Run the verb; return the exit code."""
    _check(arguments)
    from hydra_actuator.parameters import load_parameters
    from hydra_actuator.signals import read_table
    parameters = load_parameters(*arguments.config)
    table = read_table(arguments.command, arguments.hold) if arguments.command else None
    duration = arguments.duration
    if duration is None:
        duration = table.duration if table is not None else DEFAULT_DURATION
    from hydra_actuator.simulate import simulate
    with ProgressBar('simulate') as progress:
        result = simulate(parameters, table or _built_in(arguments, duration), duration,
                          arguments.output, arguments.rate, progress)
    print(f'{duration:g} s simulated, recorded in {result.recording}')
    return 0


def _check(arguments: argparse.Namespace) -> None:
    for name in ('duration', 'rate', 'sine'):
        value = getattr(arguments, name)
        if value is not None and not 0.0 < value < math.inf:
            raise InputError(f'--{name} {value:g} is not a positive number')
    if arguments.chirp and not all(0.0 <= f < math.inf for f in arguments.chirp):
        raise InputError(f'--chirp {arguments.chirp} are not two frequencies in Hz')
    if not -1.0 <= arguments.amplitude <= 1.0:
        raise InputError(f'--amplitude {arguments.amplitude:g} is not within -1 to 1')
    if arguments.hold and not arguments.command:
        raise InputError('--hold goes with --command')
    if os.path.lexists(arguments.output):
        raise InputError(f'{arguments.output} exists already, and nothing is overwritten')


def _built_in(arguments: argparse.Namespace, duration: float):
    from hydra_actuator.signals import Chirp, Hold, Sine, Step
    if arguments.sine is not None:
        return Sine(arguments.sine, arguments.amplitude)
    if arguments.step:
        return Step(arguments.amplitude)
    if arguments.chirp:
        return Chirp(*arguments.chirp, duration, arguments.amplitude)
    return Hold()
