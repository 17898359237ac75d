# SPDX-License-Identifier: Apache-2.0
"""
How the solver's cost grows with cells, simulated time, actuators and threads.

The machine may be shared: what is compared is timed in turn, in short pieces, by the processor's
time of the thread, and the least is kept, the nearest to a machine of its own. Threads side by
side are timed on the clock, and want one.
"""

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
import math
import os
from pathlib import Path
import tempfile
import time
from typing import NamedTuple

from hydra_actuator.actuator import Actuator, SolverError
from hydra_actuator.parameters import Parameters
from hydra_actuator.signals import Sine
from hydra_actuator.simulate import simulate
import numpy as np

FREQUENCY = 50.0            # [Hz] of the full-stroke sine
WARM_UP = 20                # ticks
PIECE = 2000                # steps timed at a time, at least
PAGE = os.sysconf('SC_PAGE_SIZE')


class Curve(NamedTuple):
    """A measured curve: what was varied, and what came out, the best of all pieces."""

    over: np.ndarray
    value: np.ndarray


def over_cells(cells: tuple[int, ...], pieces: int, base: Parameters | None = None) -> Curve:
    """Return the time of a step [s] over cells."""
    base = Parameters() if base is None else base
    actuators = [Actuator(base.replace({'solver.cells': count})) for count in cells]
    for actuator in actuators:
        drive(actuator, WARM_UP)
    times = np.empty((pieces, len(cells)))
    for row in times:
        for k, actuator in enumerate(actuators):
            ticks = math.ceil(PIECE / actuator.steps_per_period)
            began = time.thread_time()
            drive(actuator, ticks)
            row[k] = (time.thread_time() - began) / (ticks * actuator.steps_per_period)
    return Curve(np.array(cells), times.min(axis=0))


def over_actuators(counts: tuple[int, ...], pieces: int,
                   base: Parameters | None = None) -> Curve:
    """Return the time of a tick per actuator [s], so many taking turns in one thread."""
    base = Parameters() if base is None else base
    actuators = [Actuator(base) for _ in range(max(counts))]
    for actuator in actuators:
        drive(actuator, WARM_UP)
    times = np.empty((pieces, len(counts)))
    for row in times:
        for k, count in enumerate(counts):
            began = time.thread_time()
            for actuator in actuators[:count]:
                drive(actuator, 1)
            row[k] = (time.thread_time() - began) / count
    return Curve(np.array(counts), times.min(axis=0))


def over_threads(threads: tuple[int, ...], pieces: int,
                 base: Parameters | None = None) -> Curve:
    """
    Return the actuator ticks per second of so many threads, on the clock.

    Each thread drives an actuator of its own, in calls that release the interpreter lock.
    """
    base = Parameters() if base is None else base
    actuators = [Actuator(base) for _ in range(max(threads))]
    ticks, rates = 50, np.empty((pieces, len(threads)))
    for row in rates:
        for k, count in enumerate(threads):
            with ThreadPoolExecutor(count) as pool:
                began = time.perf_counter()
                list(pool.map(lambda one: follow(one, ticks), actuators[:count]))
                row[k] = count * ticks / (time.perf_counter() - began)
    return Curve(np.array(threads), rates.max(axis=0))


def over_time(duration: float, base: Parameters | None = None,
              progress: Callable[[float], None] = lambda share: None) -> tuple[Curve, Curve]:
    """
    Return (computing time of each part [s], resident memory [bytes]) over simulated time [s].

    A run of `duration` into a recording, in twenty parts.
    """
    base = Parameters() if base is None else base
    marks: list[tuple[float, float, int]] = []

    def note(share: float) -> None:
        if share >= 0.05 * len(marks):
            marks.append((share * duration, time.process_time(), resident_memory()))
        progress(share)

    with tempfile.TemporaryDirectory() as folder:
        simulate(base, Sine(FREQUENCY), duration, Path(folder, 'run'), progress=note)
    at, spent, memory = (np.array(column) for column in zip(*marks))
    return (Curve(at[1:], np.diff(spent) / np.diff(at)), Curve(at, memory))


def resident_memory() -> int:
    """Return the memory of this process that lies in RAM [bytes]."""
    return int(Path('/proc/self/statm').read_text().split()[1]) * PAGE


def drive(actuator: Actuator, ticks: int) -> None:
    """Advance by ticks under the sine; SolverError where the method breaks."""
    for _ in range(ticks):
        command = math.sin(2.0 * math.pi * FREQUENCY * actuator.tick * actuator.period)
        _sound(actuator, actuator.tick_once(command, command, 0.0))


def follow(actuator: Actuator, ticks: int) -> None:
    """Advance by ticks under the sine in one compiled call."""
    steps = ticks * actuator.steps_per_period
    times = actuator.time + np.arange(1, ticks + 1) * actuator.period
    _sound(actuator, actuator.follow((times, Sine(FREQUENCY)(times), False), steps))


def _sound(actuator: Actuator, code: int) -> None:
    if code:
        raise SolverError(actuator.status_message(code))
