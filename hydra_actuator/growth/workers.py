# SPDX-License-Identifier: Apache-2.0
"""
How a sweep's speed grows with its workers, and what a run costs beside its own computing.

Three costs decide how far it goes: what a worker computes per run beside the run itself (fetching,
building, reporting), and what the asking process, client and scheduler in one, computes per task
and per run. These are computing times, so a busy machine does not change them much; the rate on
the clock wants a machine of its own.
"""

from collections.abc import Callable
from pathlib import Path
import resource
import tempfile
import time
from typing import NamedTuple

from hydra_actuator.parameters import Parameters
from hydra_actuator.signals import Sine
from hydra_actuator.sweep.chunks import AT_LEAST, PER_WORKER
from hydra_actuator.sweep.cluster import connected
from hydra_actuator.sweep.design import sample
from hydra_actuator.sweep.execution import sweep, Where
from hydra_actuator.sweep.factor import read_factor
from hydra_actuator.sweep.journal import Journal
from hydra_actuator.sweep.plan import Plan
from hydra_actuator.sweep.run import DONE, Drive, Outcome
import numpy as np

TASKS = 400         # that do nothing, for what asking costs


class Scaling(NamedTuple):
    """
    Sweeps of the same runs by so many workers.

    rate: runs per second on the clock, after each worker's first; run_time: computing time of a
    run itself; worker_time: of a worker per run, that in it; task_time, note_time: of the asking
    process per task and per run; all [s].
    """

    workers: np.ndarray
    rate: np.ndarray
    run_time: float
    worker_time: float
    task_time: float
    note_time: float

    def on_paper(self, workers: int) -> tuple[float, float]:
        """
        Return (runs per s, part of the workers' time that is theirs) of so many workers.

        One scheduler feeds them with chunks as `sweep` deals them; the network costs nothing.
        """
        in_chunk = max(1.0, max(AT_LEAST, PER_WORKER * workers) / self.worker_time)
        most = 1.0 / (self.task_time / in_chunk + self.note_time)
        rate = min(workers / self.worker_time, most)
        return rate, rate * self.run_time / workers


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
            outcomes = measured.outcomes
        progress((k + 1) / (len(counts) + 1))
    return Scaling(np.array(counts), np.array(rates), run_time, spent, task_time(),
                   note_time(outcomes))


class _Measured(NamedTuple):
    """One sweep: runs per s, mean run time, all computing of workers [s], outcomes."""

    rate: float
    run_time: float
    workers: float
    outcomes: tuple[Outcome, ...]


def _plan(base: Parameters, factor: str, runs: int, duration: float) -> Plan:
    factors = (read_factor(factor, base),)
    samples = tuple(map(tuple, sample('lhs', factors, runs)))
    return Plan(base, factors, 'lhs', runs, 0, Drive(Sine(100.0), duration, 0.0, 1e4),
                'Sine(100)', samples)


def _sweep(plan: Plan, workers: int) -> _Measured:
    ended = []

    def note(_: float) -> None:
        ended.append(time.perf_counter())

    before = _children()
    with tempfile.TemporaryDirectory() as folder:
        outcomes = sweep(plan, Path(folder), Where(None, workers), progress=note)
    # What the first runs wait for, imports and kernels, is not growth.
    counted = len(ended) - 1 - workers
    times = [one.figures['run_time'] for one in outcomes.values() if one.status == DONE]
    return _Measured(counted / (ended[-1] - ended[workers]), float(np.mean(times or [0.0])),
                     _children() - before, tuple(outcomes.values()))


def task_time(tasks: int = TASKS) -> float:
    """Return what the asking process computes per task [s], of tasks that do nothing."""
    with connected(None, 1) as client:
        client.submit(time.time, key='first').result()
        began = time.process_time()
        asked = [client.submit(time.time, key=f'nothing-{k}') for k in range(tasks)]
        client.gather(asked)
        return (time.process_time() - began) / tasks


def note_time(outcomes: tuple[Outcome, ...], times: int = 10) -> float:
    """Return what it takes to write an outcome into the journal [s]."""
    with tempfile.TemporaryDirectory() as folder, Journal(Path(folder)) as journal:
        began = time.process_time()
        for _ in range(times):
            for outcome in outcomes:
                journal.append(outcome)
        return (time.process_time() - began) / (times * len(outcomes))


def _children() -> float:
    """Return the computing time of all processes that were started and have ended [s]."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime
