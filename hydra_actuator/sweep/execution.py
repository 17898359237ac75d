# SPDX-License-Identifier: Apache-2.0
"""
A sweep from its plan to its tables, over Dask.

A few runs per worker are under way at a time, so that a scheduler holds few and Ctrl-C waits for
few; what ends goes into the journal at once. Runs that are in it are not done again.
"""

from collections.abc import Callable, Iterator
from pathlib import Path
import queue
from typing import NamedTuple, TYPE_CHECKING
import uuid

from hydra_actuator.interruption import Interruption
from hydra_actuator.sweep.cluster import connected
from hydra_actuator.sweep.journal import finished, Journal, read_journal
from hydra_actuator.sweep.plan import Plan, settle
from hydra_actuator.sweep.run import LOST, Outcome, run_one
from hydra_actuator.sweep.tables import write_tables

if TYPE_CHECKING:
    from distributed import Client

AHEAD = 3               # runs under way per worker
LEAST_AHEAD = 8
WAIT = 0.2              # [s] between looks for Ctrl-C


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
    base, ended = plan.base.changed(), queue.SimpleQueue()
    waiting, under_way, ours = iter(runs), {}, uuid.uuid4().hex
    room = max(LEAST_AHEAD, AHEAD * sum(client.nthreads().values()))
    try:
        while True:
            while len(under_way) < room and (run := next(waiting, None)) is not None:
                future = client.submit(run_one, run, base, plan.changes(run), plan.drive,
                                       key=f'run-{run}-{ours}')
                under_way[run] = future
                future.add_done_callback(lambda _, run=run: ended.put(run))
            if not under_way:
                return
            interruption.raise_if_asked()
            try:
                run = ended.get(timeout=WAIT)
            except queue.Empty:
                continue
            yield _outcome(run, under_way.pop(run))
    finally:
        client.cancel(list(under_way.values()), force=True)


def _outcome(run: int, future) -> Outcome:
    """Return what a future that has ended holds, an error that no run foresees as a failure."""
    from distributed.scheduler import KilledWorker

    error = future.exception()
    if error is None:
        return future.result()
    if isinstance(error, KilledWorker):
        return Outcome(run, LOST, 'its workers died with it', {})
    return Outcome(run, LOST, f'{type(error).__name__}: {" ".join(str(error).split())}'[:300], {})
