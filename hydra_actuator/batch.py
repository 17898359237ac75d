# SPDX-License-Identifier: Apache-2.0
"""
Many offline runs at once, one process per core, four actuators to a step: each into its own file.

A run is the same as alone, to the last bit of its states: see hydra_actuator.side_by_side. A row
of a batch file says how its run differs:

    name,cylinder.mass,valve.stroke
    light,5.0,0.0005
    heavy,20.0,0.0005
"""

from collections.abc import Callable, MutableSequence
from concurrent.futures import FIRST_COMPLETED, ProcessPoolExecutor, wait
import multiprocessing
import os
from pathlib import Path
import re
import signal
import threading
from typing import NamedTuple

from hydra_actuator.csv_files import read_csv
from hydra_actuator.errors import InputError
from hydra_actuator.kernels import has_together
from hydra_actuator.one_compiler import compile_once
from hydra_actuator.parameters import load_parameters, ParameterError, Parameters
from hydra_actuator.parameters.yaml_files import read_scalar
from hydra_actuator.side_by_side import group, ready_together, simulate_side_by_side
from hydra_actuator.signals import Signal

# Simulated seconds of a batch from which on compiling the kernel for four at once is repaid: it
# takes as long as it then saves, some 0.3 us of each of 134 000 steps of each second.
WORTH = 1000.0
LOOK = 0.2              # [s] between looks at how far the processes are
# Of the batch that a process works for: whether it has ended, runs done of each group.
_ended, _shares = threading.Event(), []
_NAME = re.compile(r'[A-Za-z0-9][A-Za-z0-9._-]*')


class Run(NamedTuple):
    """One run of a batch: its name, which is its recording's, and its parameters."""

    name: str
    parameters: Parameters


def read_batch(path: str | Path, *configs: str) -> list[Run]:
    """Return the runs of a batch file, on top of parameter files; InputError by its line."""
    path = Path(path)
    rows = read_csv(path, 'name')
    header = [cell.strip() for cell in rows[0][1]]
    if header[0] != 'name' or len(set(header)) < len(header):
        raise InputError(f'{path}: the header is name, then parameters, each once')
    runs: dict[str, Run] = {}
    for line, row in rows[1:]:
        cells = [cell.strip() for cell in row]
        if len(cells) != len(header):
            raise InputError(f'{path}, line {line}: {len(cells)} values for {len(header)} columns')
        name = cells[0]
        if not _NAME.fullmatch(name) or name in runs:
            raise InputError(f'{path}, line {line}: {name!r} is no name of a recording, or is '
                             'there twice')
        changes = {key: read_scalar(cell) for key, cell in zip(header[1:], cells[1:]) if cell}
        try:
            runs[name] = Run(name, load_parameters(*configs, overrides=changes))
        except ParameterError as error:
            raise InputError(f'{path}, line {line}: {error}') from None
    if not runs:
        raise InputError(f'{path} has no rows below its header')
    return list(runs.values())


def simulate_batch(runs: list[Run], drive: tuple[Signal, float, float | None], output: Path,
                   workers: int | None = None,
                   progress: Callable[[float], None] = lambda share: None) -> dict[str, str]:
    """
    Simulate runs side by side into `output`/NAME; return by name why a run failed, '' if not.

    drive: the command, duration [s], rate [Hz] or None, as of `simulate`; workers: processes, one
    per core this process may use if None. KeyboardInterrupt on Ctrl-C: recordings begun are whole.
    """
    compile_once(runs[0].parameters)
    output.mkdir(parents=True, exist_ok=True)
    count = min(workers or len(os.sched_getaffinity(0)), len(runs))
    groups = _groups(runs, drive[1], count)
    told: dict[str, str] = {}
    context = multiprocessing.get_context('spawn')
    ended, shares = context.Event(), context.Array('d', len(groups), lock=False)
    with ProcessPoolExecutor(count, context, _begin, (ended, shares)) as pool:
        under_way = {pool.submit(_some, number, members, drive, output): number
                     for number, members in enumerate(groups)}
        try:
            while under_way:
                for future in wait(under_way, LOOK, FIRST_COMPLETED).done:
                    told.update(future.result())
                    del under_way[future]
                begun = sum(shares[number] for number in under_way.values())
                progress((len(told) + begun) / len(runs))
        except BaseException:
            # a process has work in its queue that cannot be cancelled, and who asked may have
            # asked this one alone
            ended.set()
            pool.shutdown(wait=False, cancel_futures=True)
            raise
    return {run.name: told[run.name] for run in runs}


def _groups(runs: list[Run], duration: float, workers: int) -> list[list[Run]]:
    """
    Return the runs by what one process does at a time: four side by side, or one.

    Side by side where that leaves every process some, and saves the time in which its kernel
    compiles; the work of whole groups first.
    """
    alone = [[run] for run in runs]
    groups = [[runs[k] for k in indices] for indices in group([run.parameters for run in runs])]
    whole = [members for members in groups if len(members) > 1]
    if len(whole) < workers:
        return alone
    passes = whole[0][0].parameters['solver.iterations']
    if len(runs) * duration < WORTH and not has_together(passes):
        return alone
    ready_together([run.parameters for run in whole[0]])
    return sorted(groups, key=len, reverse=True)


def _begin(ended: 'multiprocessing.synchronize.Event', shares: MutableSequence[float]) -> None:
    """Begin a process: it does nothing once the batch has ended, and tells how far it is."""
    global _ended, _shares
    _ended, _shares = ended, shares
    _ignore()


def _ignore() -> None:
    """Leave Ctrl-C alone while there is no run that it could end."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)


def _some(number: int, runs: list[Run], drive: tuple, output: Path) -> dict[str, str]:
    """Simulate group `number` of the batch; return by name why a run failed, or ''."""
    command, duration, rate = drive

    def tell(share: float) -> None:
        _shares[number] = share * len(runs)
        # whoever was interrupted, and if it was swallowed where compiled code was being loaded
        if _ended.is_set():
            raise KeyboardInterrupt

    signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        if _ended.is_set():
            raise KeyboardInterrupt
        compile_once(runs[0].parameters)
        outcomes = simulate_side_by_side(
            [run.parameters for run in runs], command, duration,
            [output / run.name for run in runs], rate, tell)
    finally:
        _ignore()
    return {run.name: str(outcome) if isinstance(outcome, Exception) else ''
            for run, outcome in zip(runs, outcomes)}
