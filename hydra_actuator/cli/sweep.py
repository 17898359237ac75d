# SPDX-License-Identifier: Apache-2.0
"""The verb `sweep`: many simulations over parameters, on Dask."""

import argparse
from collections import Counter
import math
from pathlib import Path

from hydra_actuator.cli.drive import add_drive, check_drive, drive
from hydra_actuator.cli.progress import ProgressBar
from hydra_actuator.errors import InputError

SUMMARY = 'many simulations over parameters, on Dask: local, or a cluster'
DEFAULT_RATE = 10000.0
MOST_WORKERS = 1024
NEEDED = ('distributed', 'netCDF4', 'pandas', 'pyarrow', 'SALib', 'scipy', 'xarray')
REASONS_SHOWN = 5


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of the verb."""
    parser.add_argument('--config', action='append', default=[], metavar='F',
                        help='ROS parameter file; later files win')
    parser.add_argument('--vary', action='append', default=[], metavar='NAME=LOW:HIGH[:log]',
                        help='a parameter over a range, or NAME=V1,V2,... over values; '
                             'NAME+NAME=... moves several together; once for each factor')
    parser.add_argument('--method', default='sobol', choices=('grid', 'random', 'lhs', 'sobol'),
                        help='how the runs are spread (default sobol, best with 2^n of them)')
    parser.add_argument('--samples', type=int, default=128, metavar='N',
                        help='runs; with grid, points along each range (default 128)')
    parser.add_argument('--seed', type=int, default=0, help='of random, lhs and sobol (default 0)')
    add_drive(parser)
    parser.add_argument('--from', dest='start', type=float, default=0.0, metavar='T',
                        help='from when on figures count [s] (default 0)')
    parser.add_argument('--rate', type=float, metavar='HZ',
                        help='how often the actuator is looked at (default 10000)')
    parser.add_argument('--workers', type=int, metavar='N',
                        help='processes on this machine (default: one per core)')
    parser.add_argument('--scheduler', metavar='ADDRESS',
                        help='a running Dask scheduler, as tcp://HOST:8786')
    parser.add_argument('--again', action='store_true', help='do failed runs again, too')
    parser.add_argument('-o', '--output', metavar='DIR', required=True,
                        help='directory of the sweep; one that was interrupted goes on')


def run(arguments: argparse.Namespace) -> int:
    """Run the verb; return the exit code."""
    _check(arguments)
    from hydra_actuator.sweep.execution import sweep, Where

    plan, directory = _plan(arguments), Path(arguments.output)
    where = Where(arguments.scheduler, arguments.workers)
    try:
        with ProgressBar('sweep') as progress:
            outcomes = sweep(plan, directory, where, arguments.again, progress)
    except KeyboardInterrupt:
        from hydra_actuator.sweep.journal import read_journal
        print(f'{len(read_journal(directory))} of {len(plan.samples)} runs are in {directory}; '
              'the same command goes on')
        raise
    _tell(outcomes, directory)
    return 0


def _check(arguments: argparse.Namespace) -> None:
    check_drive(arguments)
    if not 0.0 <= arguments.start < math.inf:
        raise InputError(f'--from {arguments.start:g} is not a time of zero or more seconds')
    if not 0 <= arguments.seed < 2**32:
        raise InputError(f'--seed {arguments.seed} is not within 0 to 4294967295')
    if arguments.workers is not None and not 1 <= arguments.workers <= MOST_WORKERS:
        raise InputError(f'--workers {arguments.workers} is not within 1 to {MOST_WORKERS}')
    if arguments.workers is not None and arguments.scheduler is not None:
        raise InputError('--workers goes without --scheduler, which has its own')
    from importlib.util import find_spec
    missing = [name for name in NEEDED if find_spec(name) is None]
    if missing:
        raise InputError(f'sweep needs {", ".join(missing)}: pip install hydra_actuator[sweep]')


def _plan(arguments: argparse.Namespace):
    """Return the plan that the arguments describe."""
    from hydra_actuator.parameters import load_parameters
    from hydra_actuator.sweep.design import sample
    from hydra_actuator.sweep.factor import read_factor, refuse_overlap
    from hydra_actuator.sweep.plan import Plan
    from hydra_actuator.sweep.run import Drive

    base = load_parameters(*arguments.config)
    factors = tuple(read_factor(text, base) for text in arguments.vary)
    refuse_overlap(factors)
    signal, duration = drive(arguments)
    if arguments.start >= duration:
        raise InputError(f'--from {arguments.start:g} s is not before the end at {duration:g} s')
    samples = sample(arguments.method, factors, arguments.samples, arguments.seed)
    rate = arguments.rate or DEFAULT_RATE
    return Plan(base, factors, arguments.method, arguments.samples, arguments.seed,
                Drive(signal, duration, arguments.start, rate), _text(arguments, signal),
                tuple(map(tuple, samples)))


def _text(arguments: argparse.Namespace, signal) -> str:
    """Return the drive in words; a file by its name and a hash of what it holds."""
    if arguments.command is None:
        return repr(signal)
    import hashlib
    digest = hashlib.sha256(Path(arguments.command).read_bytes()).hexdigest()[:16]
    held = ', held' if arguments.hold else ''
    return f'{Path(arguments.command).name} ({digest}){held}'


def _tell(outcomes: dict, directory: Path) -> None:
    """Print how many runs are done, and how many failed, by kind, with some reasons."""
    from hydra_actuator.sweep.run import DONE
    failed = [one for one in outcomes.values() if one.status != DONE]
    print(f'{len(outcomes) - len(failed)} runs done, {len(failed)} failed, in {directory}')
    counts = Counter(one.status for one in failed)
    for kind, count in counts.items():
        reasons = [one for one in failed if one.status == kind][:REASONS_SHOWN]
        print(f'{kind}: {count}')
        for one in reasons:
            print(f'  run {one.run}: {one.reason}')
