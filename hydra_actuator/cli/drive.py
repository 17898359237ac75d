# SPDX-License-Identifier: Apache-2.0
"""The arguments that say what moves an actuator offline: a file, or a built-in command."""

import argparse
import math

from hydra_actuator.errors import InputError

DEFAULT_DURATION = 1.0


def add_drive(parser: argparse.ArgumentParser):
    """Declare the arguments; return the group of those that exclude each other."""
    drive = parser.add_mutually_exclusive_group()
    drive.add_argument('--command', metavar='C.csv',
                       help='CSV with header time,spool[,load_force], linear between rows')
    drive.add_argument('--sine', type=float, metavar='HZ', help='sine command')
    drive.add_argument('--step', action='store_true', help='step command at time 0')
    drive.add_argument('--chirp', type=float, nargs=2, metavar=('HZ', 'HZ'),
                       help='sine command sweeping between two frequencies')
    parser.add_argument('--hold', action='store_true',
                        help='hold each row of the CSV until the next')
    parser.add_argument('--amplitude', type=float, metavar='A',
                        help='of the built-in commands, 1 is full spool (default 1)')
    parser.add_argument('--duration', type=float, metavar='T',
                        help='[s]; default: the CSV to its end, else 1')
    return drive


def check_drive(arguments: argparse.Namespace) -> None:
    """Raise InputError for numbers that are none, and arguments that do not go together."""
    for name in ('duration', 'rate', 'sine'):
        value = getattr(arguments, name)
        if value is not None and not 0.0 < value < math.inf:
            raise InputError(f'--{name} {value:g} is not a positive number')
    for frequency in arguments.chirp or ():
        if not 0.0 <= frequency < math.inf:
            raise InputError(f'--chirp {frequency:g} is not a frequency in Hz')
    amplitude = arguments.amplitude
    if amplitude is not None and not -1.0 <= amplitude <= 1.0:
        raise InputError(f'--amplitude {amplitude:g} is not within -1 to 1')
    if amplitude is not None and not (arguments.sine or arguments.step or arguments.chirp):
        raise InputError('--amplitude goes with --sine, --step or --chirp')
    if arguments.hold and not arguments.command:
        raise InputError('--hold goes with --command')


def drive(arguments: argparse.Namespace):
    """Return (signal, duration [s]) of checked arguments."""
    from hydra_actuator.signals import read_table

    table = read_table(arguments.command, arguments.hold) if arguments.command else None
    duration = arguments.duration
    if duration is None:
        duration = table.duration if table is not None else DEFAULT_DURATION
    if duration == 0.0:
        raise InputError(f'{arguments.command} ends at time 0 s: say --duration')
    return table or _built_in(arguments, duration), duration


def _built_in(arguments: argparse.Namespace, duration: float):
    from hydra_actuator.signals import Chirp, Hold, Sine, Step
    amplitude = 1.0 if arguments.amplitude is None else arguments.amplitude
    if arguments.sine is not None:
        return Sine(arguments.sine, amplitude)
    if arguments.step:
        return Step(amplitude)
    if arguments.chirp:
        return Chirp(*arguments.chirp, duration, amplitude)
    return Hold()
