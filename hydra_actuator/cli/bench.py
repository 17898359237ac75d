# SPDX-License-Identifier: Apache-2.0
"""The verb `bench`: speed of the solver on this machine."""

import argparse
from importlib.util import find_spec
import math
from pathlib import Path
import statistics

from hydra_actuator.cli import bench_ros
from hydra_actuator.cli.progress import ProgressBar
from hydra_actuator.errors import InputError

SUMMARY = 'speed of the solver'


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of the verb."""
    parser.add_argument('--config', action='append', default=[], metavar='F',
                        help='ROS parameter file; default: the reference size')
    parser.add_argument('--duration', type=float, default=5.0, metavar='T',
                        help='simulated time to measure over [s] (default 5)')
    parser.add_argument('--nodes', type=int, metavar='N',
                        help='how many nodes hold their rate side by side: 1, 2, 4 .. N of them, '
                             '--duration seconds each, over DDS')
    parser.add_argument('--real-time', action='store_true',
                        help='lateness of a node alone, flooded and beside a busy core, and how '
                             'soon it answers, --duration seconds each, over DDS')
    parser.add_argument('--batch', action='store_true',
                        help='what a step of an actuator takes alone, and when four advance at '
                             'once on the same core, with the same bits')
    parser.add_argument('--growth', nargs='?', const='', metavar='PICTURE.png',
                        help='how cost grows with cells, simulated time, actuators, threads and '
                             'workers; drawn into a picture if one is named')
    parser.add_argument('--peers', action='store_true',
                        help='other solvers on the work they can do, in the same run, each '
                             'installed into an environment of its own below build/peers')
    parser.add_argument('--recorder', action='store_true',
                        help='what the recorder of a node takes in and writes in --duration '
                             'seconds (600 for the full figure), and what it costs, over DDS')
    parser.add_argument('--options', action='store_true',
                        help='what each option of the physics costs, as a ratio in one run')
    parser.add_argument('--profile', action='store_true',
                        help='where the time of a step goes, and how far it is from a bare loop '
                             'of the same arithmetic and memory traffic')
    parser.add_argument('--startup', action='store_true',
                        help='from import to the first step, and of a node from start until it '
                             'is active, without and with kept kernels')
    parser.add_argument('--guard', metavar='F',
                        help='compare ratios to the bare loop with the last record in F of a '
                             'processor like this; exit code 1 where one is much larger')
    parser.add_argument('--record', action='store_true',
                        help='add what --guard measures to its file')


def run(arguments: argparse.Namespace) -> int:
    """Run the verb; return the exit code."""
    if not 0.2 <= arguments.duration < math.inf:
        raise InputError(f'--duration {arguments.duration:g} s is below 0.2 s')
    from hydra_actuator.parameters import load_parameters
    parameters = load_parameters(*arguments.config)
    if arguments.peers:
        return _peers()
    if arguments.growth is not None:
        return _growth(arguments.growth)
    if arguments.batch:
        return _batch(arguments.duration)
    if arguments.nodes is not None:
        return bench_ros.print_nodes(arguments)
    if arguments.real_time:
        return bench_ros.print_real_time(arguments, parameters)
    if arguments.recorder:
        return bench_ros.print_recorder(arguments)
    if arguments.options:
        return _options(parameters if arguments.config else None, arguments.duration)
    if arguments.profile:
        return _profile(parameters)
    if arguments.startup:
        return _startup()
    if arguments.guard:
        return _guard(Path(arguments.guard), arguments.record)
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


def _profile(parameters) -> int:
    """Print what each stage takes of a step."""
    from hydra_actuator.stages import measure_stages
    stages = measure_stages(parameters)
    total = sum(stages.times.values())
    print(f'{"microseconds, medians of one run":<32}{"alone":>10}{"part":>8}')
    for name, took in sorted(stages.times.items(), key=lambda item: -item[1]):
        print(f'{name:<32}{took * 1e6:10.3f}{took / total:8.1%}')
    print(f'{"sum of stages, each alone":<32}{total * 1e6:10.3f}')
    print(f'{"whole step":<32}{stages.step * 1e6:10.3f}')
    print(f'{"bare loop (the limit)":<32}{stages.limit * 1e6:10.3f}')
    print(f'plain sweep over limit: {stages.bare_sweep / stages.limit:.2f}; '
          f'step over limit: {stages.step / stages.limit:.2f}')
    return 0


def _startup() -> int:
    """Print what a start takes, cold and warm."""
    from hydra_actuator.startup import measure_startup
    cold, warm = measure_startup()
    print(f'{"processor time [s]":<32}{"cold":>10}{"warm":>10}')
    for name, took in cold.times.items():
        print(f'{name:<32}{took:10.2f}{warm.times[name]:10.2f}')
    print(f'{"from start to first step":<32}{cold.total:10.2f}{warm.total:10.2f}')
    print(f'{"the same by the clock [s]":<32}{cold.elapsed:10.2f}{warm.elapsed:10.2f}')
    print(f'{"largest memory [MB]":<32}{cold.memory:10.0f}{warm.memory:10.0f}')
    if find_spec('rclpy') is not None:
        from hydra_actuator.ros.activation import measure_activations
        columns = zip(*measure_activations())
        print(f'{"node: from start to active":<32}' + '{:10.2f}{:10.2f}'.format(*next(columns)))
        print(f'{"the same by the clock [s]":<32}' + '{:10.2f}{:10.2f}'.format(*next(columns)))
    return 0


def _guard(file: Path, record: bool) -> int:
    """Print ratios beside the last ones; return 1 where one has grown too much."""
    from hydra_actuator import guard
    measured = guard.measure()
    before = guard.last(guard.read(file), measured.processor)
    slower = 0
    print(f'{measured.processor}; ratios to the bare loop')
    for name, ratio in measured.ratios.items():
        old = before.ratios.get(name) if before else None
        worse = old is not None and ratio > guard.TOLERANCE * old
        slower += worse
        told = f'{old:8.2f} at {before.commit}' if old is not None else '  no record'
        print(f'{name:<18}{ratio:8.2f}{told}{"  SLOWER" if worse else ""}')
    if record:
        guard.append(file, measured)
    return 1 if slower else 0


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


def _batch(duration: float) -> int:
    """Print what a step takes alone and in fours."""
    from hydra_actuator.benchmark import measure_together
    with ProgressBar('bench') as progress:
        times = measure_together(duration, progress)
    print(f'{"step of one actuator [us]":<32}{"fastest":>10}{"median":>10}')
    for name, column in times.items():
        print(f'{name:<32}{min(column) * 1e6:10.3f}{statistics.median(column) * 1e6:10.3f}')
    for kind in ('solver', 'run'):
        ratio = statistics.median(times[f'{kind}, alone'] / times[f'{kind}, four at once'])
        print(f'{kind}: {ratio:.2f} times as many steps by a core')
    return 0


def _peers() -> int:
    """Print the table of peers."""
    from hydra_actuator.peers.comparison import compare, lines
    with ProgressBar('bench') as progress:
        rows = compare(Path('build', 'peers'), progress=progress)
    print('\n'.join(lines(rows)))
    return 0


def _growth(picture: str) -> int:
    """Print the curves of growth, and draw them."""
    from hydra_actuator.growth.report import draw, lines, measure
    if picture and not Path(picture).absolute().parent.is_dir():
        raise InputError(f'no directory for the picture {picture}')
    with ProgressBar('bench') as progress:
        growth = measure(progress=progress)
    print('\n'.join(lines(growth)))
    if picture:
        draw(growth, Path(picture))
    return 0
