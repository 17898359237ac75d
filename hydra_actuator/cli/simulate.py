# SPDX-License-Identifier: Apache-2.0
"""The verb `simulate`: an offline run into a recording."""

import argparse
import math

from hydra_actuator.cli.output import refuse_output
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
    drive.add_argument('--replay', metavar='RECORDING',
                       help='repeat a run from what was applied, with its own parameters unless '
                            '--config is given, and say whether its states are bit-identical')
    parser.add_argument('--hold', action='store_true',
                        help='hold each row of the CSV until the next')
    parser.add_argument('--amplitude', type=float, metavar='A',
                        help='of the built-in commands, 1 is full spool (default 1)')
    parser.add_argument('--duration', type=float, metavar='T',
                        help='[s]; default: the CSV to its end, else 1')
    parser.add_argument('--rate', type=float, metavar='HZ',
                        help='of states and pressures, at most one per step')
    parser.add_argument('-o', '--output', metavar='OUT',
                        help='directory of the new recording')


def run(arguments: argparse.Namespace) -> int:
    """Run the verb; return the exit code."""
    if arguments.replay is not None:
        return _replay(arguments)
    _check(arguments)
    from hydra_actuator.parameters import load_parameters
    from hydra_actuator.signals import read_table
    parameters = load_parameters(*arguments.config)
    table = read_table(arguments.command, arguments.hold) if arguments.command else None
    duration = arguments.duration
    if duration is None:
        duration = table.duration if table is not None else DEFAULT_DURATION
    if duration == 0.0:
        raise InputError(f'{arguments.command} ends at time 0 s: say --duration')
    from hydra_actuator.simulate import simulate
    with ProgressBar('simulate') as progress:
        result = simulate(parameters, table or _built_in(arguments, duration), duration,
                          arguments.output, arguments.rate, progress)
    print(f'{duration:g} s simulated, recorded in {result.recording}')
    return 0


def _replay(arguments: argparse.Namespace) -> int:
    """Repeat a run; 0 if every bit is the same, else 1."""
    for name in ('duration', 'rate', 'amplitude', 'hold'):
        if getattr(arguments, name):
            raise InputError(f'--{name} does not go with --replay, which repeats a run as it was')
    if arguments.output is not None:
        refuse_output(arguments.output)
    from hydra_actuator.parameters import load_parameters
    from hydra_actuator.replay import Replay
    other = load_parameters(*arguments.config) if arguments.config else None
    run = Replay(arguments.replay, other)
    command = None if arguments.output is None else run.command
    with ProgressBar('replay') as progress:
        verdict = run.compare(progress)
    if not verdict.compared:
        raise InputError(f'{arguments.replay} holds no states')
    if command is not None:
        from hydra_actuator.simulate import simulate
        simulate(run.parameters, command, command.duration, arguments.output)
    if verdict.identical:
        print(f'{verdict.compared} states of {arguments.replay}: bit-identical')
        return 0
    print(f'{verdict.differing} of {verdict.compared} states of {arguments.replay} differ, '
          f'the first {verdict.first}')
    return 1


def _check(arguments: argparse.Namespace) -> None:
    if arguments.output is None:
        raise InputError('-o/--output is missing: the directory of the new recording')
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
    refuse_output(arguments.output)


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
