# SPDX-License-Identifier: Apache-2.0
"""
How a sweep's speed grows with its workers, and what a run costs beside its own computing.

Overhead of a run: what the workers' time on the clock holds beside computing (fetching, building,
the report back); of the asking process: its own computing time per run, which bounds how many
workers one scheduler can feed.
"""

from collections.abc import Callable
from pathlib import Path
import tempfile
import time
from typing import NamedTuple

from hydra_actuator.parameters import Parameters
from hydra_actuator.signals import Sine
from hydra_actuator.sweep.design import sample
from hydra_actuator.sweep.execution import sweep, Where
from hydra_actuator.sweep.factor import read_factor
from hydra_actuator.sweep.plan import Plan
from hydra_actuator.sweep.run import Drive
import numpy as np


class Scaling(NamedTuple):
    """
    Sweeps of the same runs by so many workers.

    rate: runs per second on the clock between the first and the last that ended; busy: computing
    time of all runs over that of all workers on the clock; asking: computing time of the asking
    process (client and scheduler) per run [s].
    """

    workers: np.ndarray
    rate: np.ndarray
    busy: np.ndarray
    asking: np.ndarray
    run_time: np.ndarray


def over_workers(counts: tuple[int, ...], runs: int, duration: float = 0.1,
                 base: Parameters | None = None,
                 progress: Callable[[float], None] = lambda share: None) -> Scaling:
    """Return how sweeps of `runs` runs, of `duration` [s] each, scale with workers."""
    base = Parameters() if base is None else base
    factors = (read_factor('cylinder.mass=5:20', base),)
    samples = tuple(map(tuple, sample('lhs', factors, runs)))
    plan = Plan(base, factors, 'lhs', runs, 0,
                Drive(Sine(100.0), duration, 0.0, 1e4), 'Sine(100)', samples)
    rows = []
    for k, count in enumerate(counts):
        rows.append(_measured(plan, count))
        progress((k + 1) / len(counts))
    rate, busy, asking, run_time = np.array(rows).T
    return Scaling(np.array(counts), rate, busy, asking, run_time)


def _measured(plan: Plan, workers: int) -> tuple[float, float, float, float]:
    ended, spent = [], []

    def note(_: float) -> None:
        ended.append(time.perf_counter())
        spent.append(time.process_time())

    with tempfile.TemporaryDirectory() as folder:
        outcomes = sweep(plan, Path(folder), Where(None, workers), progress=note)
    # What the first runs wait for, imports and kernels, is not growth.
    first = workers
    counted = len(ended) - 1 - first
    span = ended[-1] - ended[first]
    run_time = float(np.mean([one.figures['run_time'] for one in outcomes.values()]))
    return (counted / span, run_time * counted / (workers * span),
            (spent[-1] - spent[first]) / counted, run_time)
