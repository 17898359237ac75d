# SPDX-License-Identifier: Apache-2.0
"""The verb `response`: the plant linear about an operating point, and the valve about null."""

import argparse
import math
import os
from pathlib import Path

from hydra_actuator.cli.progress import ProgressBar
from hydra_actuator.errors import InputError

SUMMARY = 'frequency response about an operating point, null curves of the valve'
DEFAULT_OUTPUT = 'response'


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of the verb."""
    parser.add_argument('--config', action='append', default=[], metavar='F',
                        help='ROS parameter file; later files win')
    parser.add_argument('--spool', type=float, nargs='+', default=[0.0], metavar='X',
                        help='where the valve is held, -1 to 1, one per spool (default 0)')
    parser.add_argument('--load', type=float, default=0.0, metavar='N',
                        help='load force, positive opposes positive motion (default 0)')
    parser.add_argument('--position', type=float, metavar='M',
                        help='of the piston [m]; default: where the spring holds it, else as '
                             'initial.position says')
    parser.add_argument('--from', dest='low', type=float, default=1.0, metavar='HZ',
                        help='lowest frequency (default 1)')
    parser.add_argument('--to', dest='high', type=float, default=1000.0, metavar='HZ',
                        help='highest frequency (default 1000)')
    parser.add_argument('--points', type=int, default=600, metavar='N',
                        help='frequencies of the curves (default 600)')
    parser.add_argument('-o', '--output-dir', default=DEFAULT_OUTPUT, metavar='DIR',
                        help='where pictures and response.csv go, those of an earlier run are '
                             f'replaced (default {DEFAULT_OUTPUT})')
    parser.add_argument('--solver', action=argparse.BooleanOptionalAction, default=True,
                        help='drive the nonlinear solver too (default), or not')


def run(arguments: argparse.Namespace) -> int:
    """Run the verb; return the exit code."""
    _check(arguments)
    _need_packages()
    from hydra_actuator.parameters import load_parameters
    from hydra_actuator.response.figures import write_figures
    from hydra_actuator.response.operating_point import find_operating_point
    from hydra_actuator.response.study import frequency_grid, study
    from hydra_actuator.response.table import table, write_csv
    parameters = load_parameters(*arguments.config)
    frequencies = frequency_grid(arguments.low, arguments.high, arguments.points)
    spool = arguments.spool
    if len(spool) not in (1, parameters['valve.spools']):
        raise InputError(f'--spool takes one number per spool, at most '
                         f'{parameters["valve.spools"]} here')
    directory = _directory(arguments.output_dir)
    point = find_operating_point(parameters, spool[0] if len(spool) == 1 else tuple(spool),
                                 arguments.load, arguments.position)
    with ProgressBar('response') as progress:
        result = study(point, frequencies, arguments.solver, progress)
    print('\n'.join(table(result)))
    try:
        directory.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(f'{directory} cannot be made: {error.strerror}') from error
    write_csv(result, directory / 'response.csv')
    written = write_figures(result, directory)
    print(f'written to {directory}: response.csv, {", ".join(path.name for path in written)}')
    return 0


def _check(arguments: argparse.Namespace) -> None:
    for x in arguments.spool:
        if not -1.0 <= x <= 1.0:
            raise InputError(f'--spool {x:g} is not within -1 to 1')
    for name in ('load', 'position'):
        value = getattr(arguments, name)
        if value is not None and not math.isfinite(value):
            raise InputError(f'--{name} {value:g} is not a finite number')
    if not 0.0 < arguments.low < arguments.high < math.inf:
        raise InputError(f'--from {arguments.low:g} --to {arguments.high:g} is no range of '
                         'frequencies above 0')
    if not 3 <= arguments.points <= 100000:
        raise InputError(f'--points {arguments.points} is not within 3 to 100000')


def _need_packages() -> None:
    """Raise InputError where a package of the extra `response` is missing."""
    from importlib.util import find_spec
    missing = [name for name in ('scipy', 'control', 'matplotlib') if find_spec(name) is None]
    if missing:
        raise InputError(f'response needs {", ".join(missing)}: '
                         'pip install hydra_actuator[response]')


def _directory(output: str) -> Path:
    """Return the directory; raises InputError before long work where it cannot be one."""
    path = Path(os.path.abspath(output))
    nearest = next(p for p in (path, *path.parents) if os.path.lexists(p))
    if not nearest.is_dir():
        raise InputError(f'{path} cannot be a directory: {nearest} is none')
    if not os.access(nearest, os.W_OK | os.X_OK):
        raise InputError(f'{path} cannot be written: {nearest} is not writable')
    return path
