# SPDX-License-Identifier: Apache-2.0
"""All curves of growth: measured, told as text, drawn as one picture."""

from collections.abc import Callable
import os
from pathlib import Path
from typing import NamedTuple

from hydra_actuator.analysis.palette import BLUE, GREEN, INK, ORANGE, VERMILION
from hydra_actuator.growth.solver import (
    Curve,
    over_actuators,
    over_cells,
    over_threads,
    over_time,
)
from hydra_actuator.growth.workers import over_workers, Scaling
import numpy as np

CELLS = (50, 100, 200, 400, 800, 1600, 3200)
ACTUATORS = (1, 2, 4, 8, 16, 32, 64)
DURATION = 20.0         # [s] of the run that shows memory
RUNS = 96
MANY = (10, 100, 1000)  # workers, on paper


class Growth(NamedTuple):
    """All curves; `cells` in s per step, `actuators` in s per tick, `threads` in ticks per s."""

    cells: Curve
    time: Curve
    memory: Curve
    actuators: Curve
    threads: Curve
    workers: Scaling
    steps_per_cell: float


def measure(pieces: int = 40, progress: Callable[[float], None] = lambda share: None) -> Growth:
    """Return all curves; the workers of sweeps are 1, the cores, and twice as many."""
    from hydra_actuator.actuator import Actuator
    cores = len(os.sched_getaffinity(0))
    counts = tuple(sorted({1, 2, cores, 2 * cores}))
    actuator = Actuator()
    each = 1.0 / actuator.step_time / actuator.parameters['solver.cells']
    cells = over_cells(CELLS, pieces)
    progress(0.2)
    actuators = over_actuators(ACTUATORS, max(1, pieces // 4))
    progress(0.3)
    threads = over_threads(counts, pieces)
    progress(0.4)
    spent, memory = over_time(DURATION, progress=lambda share: progress(0.4 + 0.3 * share))
    workers = over_workers(counts, RUNS, progress=lambda share: progress(0.7 + 0.3 * share))
    return Growth(cells, spent, memory, actuators, threads, workers, each)


def lines(growth: Growth) -> list[str]:
    """Return the curves as text."""
    told = [f'{len(os.sched_getaffinity(0))} cores, load average {os.getloadavg()[0]:.1f} after']
    told += ['', f'{"cells":>8}{"us per step":>14}{"ns per node":>14}'
             f'{"computing s per simulated s":>30}']
    for cells, step in zip(*growth.cells):
        told.append(f'{cells:8d}{step * 1e6:14.3f}{step / cells * 1e9:14.2f}'
                    f'{step * growth.steps_per_cell * cells:30.3f}')
    told += ['', f'{"actuators":>10}{"us per tick and actuator":>28}']
    told += [f'{count:10d}{tick * 1e6:28.1f}' for count, tick in zip(*growth.actuators)]
    told += ['', f'{"threads":>8}{"actuator ticks per s":>24}{"over one thread":>18}']
    told += [f'{count:8d}{rate:24.0f}{rate / growth.threads.value[0]:18.2f}'
             for count, rate in zip(*growth.threads)]
    memory = growth.memory.value
    half = len(memory) // 2
    told += ['', f'memory of a run of {growth.memory.over[-1]:.0f} s into a recording: '
             f'{memory[1] / 2**20:.1f} MiB at the start, {memory[half] / 2**20:.1f} half-way, '
             f'{memory[-1] / 2**20:.1f} at the end']
    scaling = growth.workers
    told += ['', f'{"workers":>8}{"runs per s":>12}{"over one":>10}']
    told += [f'{count:8d}{rate:12.2f}{rate / scaling.rate[0]:10.2f}'
             for count, rate in zip(scaling.workers, scaling.rate)]
    told.append(f'computing time per run: {scaling.run_time * 1e3:.1f} ms of its own, '
                f'{scaling.worker_time * 1e3:.1f} ms of a worker, '
                f'{scaling.task_time * 1e3:.2f} ms of client and scheduler per task, '
                f'{scaling.note_time * 1e3:.3f} ms per run')
    told += [f'on paper, {many} workers and one scheduler: {rate:.0f} of these runs per s, '
             f'{busy:.0%} of each worker in runs'
             for many in MANY for rate, busy in (scaling.on_paper(many),)]
    return told


def draw(growth: Growth, path: Path) -> None:
    """Draw all curves into a PNG."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(11.0, 6.6), layout='constrained')
    (cells, time, memory), (actuators, threads, workers) = figure.subplots(2, 3)
    over, step = growth.cells
    cells.loglog(over, step * growth.steps_per_cell * over, 'o-', color=BLUE)
    guide = step[-1] * growth.steps_per_cell * over[-1] * (over / over[-1]) ** 2
    cells.loglog(over, guide, ':', color=INK, label='cells squared')
    cells.axhline(1.0, color=VERMILION, linewidth=0.8, label='real time')
    cells.set(xlabel='cells', ylabel='computing s per simulated s', title='Cells')
    cells.set_xticks(over, [f'{c:g}' for c in over], minor=False)
    cells.minorticks_off()
    cells.legend(fontsize=8)
    time.plot(growth.time.over, growth.time.value, '.-', color=BLUE)
    time.set(xlabel='simulated time [s]', ylabel='computing s per simulated s', ylim=(0, None),
             title='A long run into a recording: time')
    memory.plot(growth.memory.over, growth.memory.value / 2**20, '.-', color=GREEN)
    memory.set(xlabel='simulated time [s]', ylabel='resident memory [MiB]', ylim=(0, None),
               title='The same run: memory')
    actuators.semilogx(growth.actuators.over, growth.actuators.value * 1e6, 'o-', color=BLUE,
                       base=2)
    actuators.set(xlabel='actuators in turn, one thread', ylabel='us per tick and actuator',
                  ylim=(0, None), title='Actuators')
    actuators.xaxis.set_major_formatter('{x:g}')
    _scaling(threads, growth.threads, 'threads', 'Threads of one process')
    _scaling(workers, Curve(growth.workers.workers, growth.workers.rate), 'workers',
             'Workers of a sweep')
    for axes in (cells, time, memory, actuators, threads, workers):
        axes.title.set_size(10)
        axes.grid(True, color='#dde1e5', linewidth=0.6)
        axes.set_axisbelow(True)
    figure.savefig(path, dpi=110)


def _scaling(axes, curve: Curve, what: str, title: str) -> None:
    """Draw a throughput over that of one, with the ideal up to the cores."""
    cores = len(os.sched_getaffinity(0))
    axes.plot(curve.over, curve.value / curve.value[0], 'o-', color=ORANGE, label='measured')
    axes.plot(curve.over, np.minimum(curve.over, cores), ':', color=INK,
              label=f'ideal on {cores} cores')
    axes.set(xlabel=what, ylabel='throughput over that of one', ylim=(0, None), title=title)
    axes.set_xticks(curve.over)
    axes.legend(fontsize=8)
