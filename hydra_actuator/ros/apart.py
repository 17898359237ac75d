# SPDX-License-Identifier: Apache-2.0
"""
A node whose solver ticks in a process of its own: for the benchmark alone, to compare with.

    python -m hydra_actuator.ros.apart --ros-args ...

The same node, but for two parts: its clock waits for ticks of the other process, its actuator
takes their rows from shared memory. Inputs go there as they are accepted, rows come back through
a ring with a semaphore. Real time and one activation only; parameters, reset, supply and the
field do not reach the other process. The figures of `Real time` are those of the solver, and come
when it has stopped.
"""

import multiprocessing
import os
import sys
import time

from hydra_actuator.actuator import Actuator
from hydra_actuator.parameters import Parameters
from hydra_actuator.realtime.pacer import Pacer
from hydra_actuator.ros import main, rig, statuses
from hydra_actuator.ros.clocks.source import ClockSource, Grant, Inputs
from hydra_actuator.ros.scheduling import prepare_thread
import numpy as np

_ROWS = 256
_PATIENCE = 240.0
_LOOK = 0.05
_spawn = multiprocessing.get_context('spawn')


class Shared:
    """Memory of both: inputs (3,), rows (_ROWS, width), a semaphore that counts new rows."""

    def __init__(self, width: int):
        self.width = width
        self.ready, self.go, self.stopping = _spawn.Event(), _spawn.Event(), _spawn.Event()
        self.ticked = _spawn.Semaphore(0)
        self.pacer = _spawn.SimpleQueue()
        self.parent = os.getpid()
        self._inputs = _spawn.RawArray('d', 3)
        self._rows = _spawn.RawArray('d', _ROWS * width)

    def arrays(self) -> tuple[np.ndarray, np.ndarray]:
        """Return inputs and rows as arrays."""
        return (np.frombuffer(self._inputs),
                np.frombuffer(self._rows).reshape(_ROWS, self.width))


def solve(values: dict[str, object], shared: Shared) -> None:
    """Tick as Plant does, until stopped; the other process's whole life."""
    parameters = Parameters(values)
    actuator = Actuator(parameters)
    inputs, rows = shared.arrays()
    pacer = Pacer(parameters['timing.period'], parameters['timing.overrun_policy'],
                  parameters['timing.max_burst'])
    prepare_thread(parameters)
    shared.ready.set()
    while not shared.go.wait(1.0):
        if os.getppid() != shared.parent:
            return
    held, written = inputs.tolist(), 0
    pacer.start()
    while pacer.ticks % 100 or not (shared.stopping.is_set() or os.getppid() != shared.parent):
        if pacer.wait() is None:
            break
        noted = inputs.tolist()
        if actuator.tick_once(*held):
            break
        held = noted
        rows[written % _ROWS] = actuator.row
        written += 1
        shared.ticked.release()
    pacer.stop()
    shared.pacer.put(pacer)


class ActuatorApart(Actuator):
    """The actuator as its rows tell."""

    def attach(self, shared: Shared) -> None:
        """Take rows from there from now on."""
        self._arrays = shared.arrays()
        self._taken = 0

    def tick_once(self, spool_1: float, spool_2: float, load_force: float) -> int:
        """Take the next row."""
        self.row[:] = self._arrays[1][self._taken % _ROWS]
        self._taken += 1
        return 0


class ClockApart(ClockSource):
    """Grants a tick when the other process has done it."""

    simulated = False

    def __init__(self, parameters: Parameters, width: int):
        super().__init__(parameters['timing.period'])
        self.ticks = 0
        self.shared = Shared(width)
        self._pacer = Pacer(self.period)
        self._base = 0
        self._inputs, _ = self.shared.arrays()
        self._process = _spawn.Process(
            target=solve, args=(dict(parameters), self.shared), daemon=True)
        self._process.start()
        self.shared.ready.wait(_PATIENCE)

    def start(self, last_stamp: int) -> int:
        """Let the other process tick."""
        self._base = time.time_ns()
        self.shared.go.set()
        return self._base

    def stop(self) -> None:
        """End the other process, and take its figures."""
        self.shared.stopping.set()
        self._pacer = self.shared.pacer.get()

    def wait(self) -> Grant | None:
        """Wait for a tick that was done."""
        if not self.shared.ticked.acquire(timeout=_LOOK):
            return None
        self.ticks += 1
        return Grant(self._base + round(self.ticks * self._period_ns))

    def command(self, inputs: Inputs) -> None:
        """Hand the inputs over."""
        self._inputs[:] = inputs

    def log_time(self, system_time: int) -> int:
        """Return the system's time."""
        return system_time

    def status(self) -> statuses.Status:
        """Return how well the other process's ticks kept to their grid."""
        return statuses.real_time(self._pacer, self.period, False)


def _set_apart() -> None:
    """Have rigs be made with the two parts of this room."""
    made: list[ActuatorApart] = []

    def actuator(parameters: Parameters) -> ActuatorApart:
        made.append(ActuatorApart(parameters))
        return made[-1]

    def clock(parameters: Parameters) -> ClockApart:
        source = ClockApart(parameters, made[-1].channels.width)
        made[-1].attach(source.shared)
        return source

    rig.Actuator, rig.clock_source = actuator, clock


if __name__ == '__main__':
    _set_apart()
    sys.exit(main.main(sys.argv[1:]))
