# SPDX-License-Identifier: Apache-2.0
"""
How a sweep's speed grows with its workers, and what a run costs beside its own computing.

Two costs decide how far it goes: what a worker computes per run beside the run itself (fetching,
building, reporting), and what the asking process, client and scheduler in one, computes per run,
which bounds how many workers one scheduler can feed. Both are computing times, so a busy machine
does not change them much; the rate on the clock wants a machine of its own.
"""

from collections.abc import Callable
from pathlib import Path
import resource
import tempfile
import time
from typing import NamedTuple

from hydra_actuator.parameters import Parameters
from hydra_actuator.signals import Sine
from hydra_actuator.sweep.design import sample
from hydra_actuator.sweep.execution import sweep, Where
from hydra_actuator.sweep.factor import read_factor
from hydra_actuator.sweep.plan import Plan
from hydra_actuator.sweep.run import DONE, Drive
import numpy as np

REFUSED = 400       # runs that are refused at once, for what asking costs


class Scaling(NamedTuple):
    """
    Sweeps of the same runs by so many workers.

    rate: runs per second on the clock, after each worker's first; run_time: computing time of a
    run itself; worker_time: of a worker per run, that in it; asking: of the asking process per
    run; all [s].
    """

    workers: np.ndarray
    rate: np.ndarray
    run_time: float
    worker_time: float
    asking: float


def over_workers(counts: tuple[int, ...], runs: int, duration: float = 0.1,
                 base: Parameters | None = None,
                 progress: Callable[[float], None] = lambda share: None) -> Scaling:
    """Return how sweeps of `runs` runs, of `duration` [s] each, scale with workers."""
    base = Parameters() if base is None else base
    mass = 'cylinder.mass=5:20'
    few = _sweep(_plan(base, mass, max(counts) + 1, duration), 1)
    rates = []
    for k, count in enumerate(counts):
        measured = _sweep(_plan(base, mass, runs, duration), count)
        rates.append(measured.rate)
        if count == counts[0]:
            run_time = measured.run_time
            spent = (measured.workers - few.workers) / (runs - max(counts) - 1)
        progress((k + 1) / (len(counts) + 1))
    asking = _sweep(_plan(base, 'initial.position=0.2:0.5', REFUSED, duration), 1).asking
    return Scaling(np.array(counts), np.array(rates), run_time, spent, asking)


class _Measured(NamedTuple):
    """One sweep: runs per s, mean run time, all computing of workers, of asking per run [s]."""

    rate: float
    run_time: float
    workers: float
    asking: float


def _plan(base: Parameters, factor: str, runs: int, duration: float) -> Plan:
    factors = (read_factor(factor, base),)
    samples = tuple(map(tuple, sample('lhs', factors, runs)))
    return Plan(base, factors, 'lhs', runs, 0, Drive(Sine(100.0), duration, 0.0, 1e4),
                'Sine(100)', samples)


def _sweep(plan: Plan, workers: int) -> _Measured:
    ended, spent = [], []

    def note(_: float) -> None:
        ended.append(time.perf_counter())
        spent.append(time.process_time())

    before = _children()
    with tempfile.TemporaryDirectory() as folder:
        outcomes = sweep(plan, Path(folder), Where(None, workers), progress=note)
    # What the first runs wait for, imports and kernels, is not growth.
    counted = len(ended) - 1 - workers
    times = [one.figures['run_time'] for one in outcomes.values() if one.status == DONE]
    return _Measured(counted / (ended[-1] - ended[workers]), float(np.mean(times or [0.0])),
                     _children() - before, (spent[-1] - spent[workers]) / counted)


def _children() -> float:
    """Return the computing time of all processes that were started and have ended [s]."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime
