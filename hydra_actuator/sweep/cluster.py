# SPDX-License-Identifier: Apache-2.0
"""
Where runs are computed: a cluster of this machine's cores, or a Dask scheduler elsewhere.

Workers have one thread each, for the linear algebra too, and leave Ctrl-C to the process that
asks; a worker that dies is replaced and its runs are done by others.
"""

from collections.abc import Iterator
from contextlib import contextmanager, ExitStack
import os
import signal
import threading
from typing import TYPE_CHECKING

from hydra_actuator.errors import InputError

if TYPE_CHECKING:
    from distributed import Client

PATIENCE = 20.0     # [s] for a scheduler to answer
ONE_THREAD = dict.fromkeys(
    ('OMP_NUM_THREADS', 'OPENBLAS_NUM_THREADS', 'MKL_NUM_THREADS', 'NUMBA_NUM_THREADS'), '1')


@contextmanager
def connected(scheduler: str | None, workers: int | None) -> Iterator['Client']:
    """
    Give a client of the scheduler at an address, or of a new cluster of `workers` processes.

    workers: as many as this process may use cores if None. Raises InputError if nobody answers.
    """
    import dask
    from distributed import Client, LocalCluster

    with ExitStack() as stack:
        stack.enter_context(dask.config.set({
            'distributed.comm.timeouts.connect': f'{PATIENCE:g}s',
            'distributed.worker.daemon': True, 'distributed.scheduler.worker-saturation': 1.0}))
        if scheduler is None:
            count = workers or len(os.sched_getaffinity(0))
            with _without_ctrl_c():
                scheduler = stack.enter_context(LocalCluster(
                    n_workers=count, threads_per_worker=1, processes=True, memory_limit=0,
                    dashboard_address=':0', env=ONE_THREAD, silence_logs='CRITICAL'))
        try:
            client = stack.enter_context(
                Client(scheduler, timeout=PATIENCE, set_as_default=False))
        except (OSError, ValueError) as error:
            raise InputError(f'no scheduler answers at {scheduler}: {error}') from error
        _refuse_other_versions(client)
        client.register_plugin(_leave_ctrl_c(), name='leave_ctrl_c')
        yield client


def _refuse_other_versions(client: 'Client') -> None:
    """Raise InputError where a worker lacks this package, or has another version of it."""
    found = client.run(version, on_error='return')
    for address, answer in found.items():
        if isinstance(answer, Exception):
            reason = ' '.join(str(answer).split())[:200]
            raise InputError(f'worker {address} cannot run sweeps: {reason}')
        if answer != version():
            raise InputError(f'worker {address} has hydra_actuator {answer}, not {version()}')


def version() -> str:
    """Return the version of this package here."""
    import hydra_actuator
    return hydra_actuator.__version__


@contextmanager
def _without_ctrl_c() -> Iterator[None]:
    """Start processes that take no notice of Ctrl-C."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)


def _leave_ctrl_c():
    """Return the plugin by which workers started later take no notice of Ctrl-C either."""
    from distributed import WorkerPlugin

    class LeaveCtrlC(WorkerPlugin):

        def setup(self, worker):
            if threading.current_thread() is threading.main_thread():
                signal.signal(signal.SIGINT, signal.SIG_IGN)

    return LeaveCtrlC()
