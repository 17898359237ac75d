# SPDX-License-Identifier: Apache-2.0
"""The verb `simulate`: an offline run into a recording."""

import argparse

from hydra_actuator.cli.drive import add_drive, check_drive, drive
from hydra_actuator.cli.output import refuse_output
from hydra_actuator.cli.progress import ProgressBar
from hydra_actuator.errors import InputError

SUMMARY = 'an offline run, as fast as possible, into a recording'


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of the verb."""
    parser.add_argument('--config', action='append', default=[], metavar='F',
                        help='ROS parameter file; later files win')
    drive = add_drive(parser)
    drive.add_argument('--replay', metavar='RECORDING',
                       help='repeat a run from what was applied, with its own parameters unless '
                            '--config is given, and say whether its states are bit-identical')
    parser.add_argument('--batch', metavar='RUNS.csv',
                        help='a run per row, all cores at once, into OUT/NAME: header '
                             'name,PARAMETER,...')
    parser.add_argument('--rate', type=float, metavar='HZ',
                        help='of states and pressures, at most one per step')
    parser.add_argument('-o', '--output', metavar='OUT',
                        help='directory of the new recording')


def run(arguments: argparse.Namespace) -> int:
    """Run the verb; return the exit code."""
    if arguments.replay is not None:
        return _replay(arguments)
    _check(arguments)
    if arguments.batch is not None:
        return _batch(arguments)
    from hydra_actuator.parameters import load_parameters
    parameters = load_parameters(*arguments.config)
    signal, duration = drive(arguments)
    from hydra_actuator.simulate import simulate
    with ProgressBar('simulate') as progress:
        result = simulate(parameters, signal, duration,
                          arguments.output, arguments.rate, progress)
    print(f'{duration:g} s simulated, recorded in {result.recording}')
    return 0


def _replay(arguments: argparse.Namespace) -> int:
    """Repeat a run; 0 if every bit is the same, else 1."""
    for name in ('duration', 'rate', 'amplitude', 'hold', 'batch'):
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


def _batch(arguments: argparse.Namespace) -> int:
    """Run a batch; 0 if every run came to its end, else 1."""
    from pathlib import Path

    from hydra_actuator.batch import read_batch, simulate_batch
    runs = read_batch(arguments.batch, *arguments.config)
    signal, duration = drive(arguments)
    with ProgressBar('simulate') as progress:
        told = simulate_batch(runs, (signal, duration, arguments.rate), Path(arguments.output),
                              progress=progress)
    failed = {name: reason for name, reason in told.items() if reason}
    print(f'{len(told) - len(failed)} runs of {duration:g} s simulated, {len(failed)} failed, '
          f'recorded below {arguments.output}')
    for name, reason in failed.items():
        print(f'  {name}: {reason}')
    return 1 if failed else 0


def _check(arguments: argparse.Namespace) -> None:
    if arguments.output is None:
        raise InputError('-o/--output is missing: the directory of the new recording')
    check_drive(arguments)
    refuse_output(arguments.output)
