# SPDX-License-Identifier: Apache-2.0
"""The verb `bench`: speed of the solver on this machine."""

import argparse
import math
import statistics

from hydra_actuator.cli.progress import ProgressBar
from hydra_actuator.errors import InputError

SUMMARY = 'speed of the solver'


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of the verb."""
    parser.add_argument('--config', action='append', default=[], metavar='F',
                        help='ROS parameter file; default: the reference size')
    parser.add_argument('--duration', type=float, default=5.0, metavar='T',
                        help='simulated time to measure over [s] (default 5)')
    parser.add_argument('--options', action='store_true',
                        help='what each option of the physics costs, as a ratio in one run')


def run(arguments: argparse.Namespace) -> int:
    """Run the verb; return the exit code."""
    if not 0.2 <= arguments.duration < math.inf:
        raise InputError(f'--duration {arguments.duration:g} s is below 0.2 s')
    from hydra_actuator.parameters import load_parameters
    parameters = load_parameters(*arguments.config)
    if arguments.options:
        return _options(parameters if arguments.config else None, arguments.duration)
    from hydra_actuator.benchmark import measure_speed
    speed = measure_speed(parameters, arguments.duration)
    print(f'{speed.nodes} nodes, {1.0 / speed.step_time:,.0f} steps per simulated second, '
          f'{parameters["solver.iterations"]} iterations, {parameters["solver.interpolation"]}, '
          'one core')
    print(f'{"":<24}{"fastest":>12}{"median":>12}{"slowest":>12}')
    print(_row('step [us]', speed.times * 1e6))
    print(_row('bare sweep [us]', speed.bare_times * 1e6))
    factors = [speed.real_time_factor(quantile) for quantile in (0.0, 0.5, 1.0)]
    print(f'{"times real time":<24}' + ''.join(f'{factor:12.2f}' for factor in factors))
    updates = speed.nodes / float(speed.times[len(speed.times) // 2]) / 1e6
    print(f'million node updates per second: {updates:.0f} (median)')
    print(f'step over bare sweep: {speed.ratio_to_bare_sweep:.2f} (medians of one run)')
    return 0


def _row(name: str, times) -> str:
    return f'{name:<24}{times[0]:12.3f}{times[len(times) // 2]:12.3f}{times[-1]:12.3f}'


def _options(parameters, duration: float) -> int:
    """Print the table of what each option costs; `parameters` None is the paper's model."""
    from hydra_actuator.benchmark import measure_options
    with ProgressBar('bench') as progress:
        times = measure_options(parameters, duration, progress)
    plain = times['as configured']
    print(f'{"":<32}{"step [us], median":>20}{"times as configured":>22}')
    for name, column in times.items():
        ratio = statistics.median(column / plain)
        print(f'{name:<32}{statistics.median(column) * 1e6:20.2f}{ratio:22.2f}')
    return 0
