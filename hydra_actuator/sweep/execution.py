# SPDX-License-Identifier: Apache-2.0
"""
A sweep from its plan to its tables, over Dask.

A few chunks of runs per worker are under way at a time, so that a scheduler holds few and Ctrl-C
waits for few; what ends goes into the journal at once. Runs that are in it are not done again.
"""

from collections.abc import Callable, Iterator
from concurrent.futures import CancelledError
import itertools
from pathlib import Path
import queue
import time
from typing import NamedTuple, TYPE_CHECKING
import uuid

from hydra_actuator.interruption import Interruption
from hydra_actuator.sweep.chunks import Chunks
from hydra_actuator.sweep.cluster import connected
from hydra_actuator.sweep.journal import finished, Journal, read_journal
from hydra_actuator.sweep.plan import Plan, settle
from hydra_actuator.sweep.run import Drive, LOST, Outcome, run_one
from hydra_actuator.sweep.tables import write_tables

if TYPE_CHECKING:
    from distributed import Client

AHEAD = 3               # chunks under way per worker
LEAST_AHEAD = 8
WAIT = 0.2              # [s] between looks for Ctrl-C
PATIENCE = 30.0         # [s] for what has ended to be fetched


class Where(NamedTuple):
    """Where a sweep runs: a scheduler's address, or that many processes of this machine."""

    scheduler: str | None = None
    workers: int | None = None


HERE = Where()


def sweep(plan: Plan, directory: Path, where: Where = HERE, again: bool = False,
          progress: Callable[[float], None] = lambda share: None) -> dict[int, Outcome]:
    """
    Do what is left of a sweep in its directory, write its tables, return all outcomes by run.

    again: do failed runs again, too. KeyboardInterrupt on Ctrl-C, with journal and tables whole.
    """
    plan = settle(plan, directory)
    with Journal(directory) as journal, Interruption() as interruption:
        outcomes = read_journal(directory)
        known = finished(outcomes, not again)
        left = [run for run in range(len(plan.samples)) if run not in known]
        interruption.hold()
        try:
            if left:
                with connected(*where) as client:
                    for outcome in _outcomes(client, plan, left, interruption):
                        journal.append(outcome)
                        outcomes[outcome.run] = outcome
                        progress(len(outcomes) / len(plan.samples))
        finally:
            write_tables(directory, plan, outcomes)
    return outcomes


def _outcomes(client: 'Client', plan: Plan, runs: list[int],
              interruption: Interruption) -> Iterator[Outcome]:
    """Yield the outcomes of runs as they end."""
    workers = sum(client.nthreads().values())
    chunks, room = Chunks(runs, workers), max(LEAST_AHEAD, AHEAD * workers)
    base, ended, ours = plan.base.changed(), queue.SimpleQueue(), uuid.uuid4().hex
    under_way, number = {}, itertools.count()
    try:
        while True:
            while len(under_way) < room and (chunk := chunks.deal()):
                asked = [(run, plan.changes(run)) for run in chunk]
                future = client.submit(run_chunk, asked, base, plan.drive,
                                       key=f'run-{chunk[0]}-{next(number)}-{ours}')
                under_way[chunk] = future
                future.add_done_callback(lambda _, chunk=chunk: ended.put(chunk))
            if not under_way:
                return
            interruption.raise_if_asked()
            try:
                chunk = ended.get(timeout=WAIT)
            except queue.Empty:
                continue
            yield from _ended(chunk, under_way.pop(chunk), chunks)
    finally:
        client.cancel(list(under_way.values()), force=True)


def run_chunk(asked: list[tuple[int, dict]], base: dict,
              drive: Drive) -> tuple[list[Outcome], float]:
    """Return the outcomes of runs, asked for as (number, changes), and what they took [s]."""
    began = time.perf_counter()
    outcomes = [run_one(run, base, changes, drive) for run, changes in asked]
    return outcomes, time.perf_counter() - began


def _ended(chunk: tuple[int, ...], future, chunks: Chunks) -> list[Outcome]:
    """Return what a chunk gave; one that was lost is given back, unless it is a single run."""
    from distributed.scheduler import KilledWorker

    try:
        error = future.exception(timeout=PATIENCE)
        if error is None:
            outcomes, seconds = future.result(timeout=PATIENCE)
            chunks.learn(len(chunk), seconds)
            return outcomes
    except (TimeoutError, CancelledError):
        # The worker that has it died before it was fetched, and nobody does it again.
        future.cancel(force=True)
        chunks.give_back(chunk)
        return []
    if len(chunk) > 1:
        chunks.give_back(chunk)
        return []
    reason = f'{type(error).__name__}: {" ".join(str(error).split())}'[:300]
    if isinstance(error, KilledWorker):
        reason = 'its workers died with it'
    return [Outcome(chunk[0], LOST, reason, {})]
