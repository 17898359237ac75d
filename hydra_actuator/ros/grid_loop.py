# SPDX-License-Identifier: Apache-2.0
"""
The plant's ticks in real time without the interpreter: gives the compiled loop what it needs.

The loop runs while nothing is to be done between two ticks. For an order, a reset, a moving
supply or a due line of a fault script it ends after the tick under way, and the plant goes on.
"""

from typing import NamedTuple

from hydra_actuator.actuator import Actuator
from hydra_actuator.realtime import loop
from hydra_actuator.realtime.system import words
from hydra_actuator.realtime.warm import warm_loop
from hydra_actuator.ros.clocks.paced import Paced
from hydra_actuator.ros.clocks.source import Inputs
from hydra_actuator.ros.ring import Ring
from hydra_actuator.ros.setpoint import Setpoint
from hydra_actuator.solver import Solver
import numpy as np


class Standing(NamedTuple):
    """Where a plant stands: number of the next row, last stamp [ns], inputs of the next tick."""

    rows: int
    stamp: int
    held: Inputs


class GridLoop:
    """Ticks of an actuator on a paced clock, from a setpoint into a ring."""

    def __init__(self, actuator: Actuator, clock: Paced, setpoint: Setpoint, ring: Ring,
                 frames_per_tick: float):
        """Compile the loop, or take it from the disk."""
        pacer = clock.pacer
        self._actuator, self._clock, self._ring = actuator, clock, ring
        self._progress = np.zeros(1, loop.PROGRESS)
        self._progress['period'] = round(clock.period * 1e9)
        self._progress['share'] = frames_per_tick
        self._desk = loop.Desk(
            clock.attention, self._progress, pacer.grid, pacer.lateness.arrays,
            pacer.execution.arrays, setpoint.held, np.zeros(3), ring.memory, words())
        actuator.for_each_model(self._warm)

    def attend(self) -> None:
        """Take note that what was asked so far is about to be done."""
        self._clock.attention[0] = 0

    def run(self, standing: Standing, enabled: bool) -> tuple[Standing, int]:
        """
        Tick as long as nothing else is to be done; return where it stands, and a status code.

        Nothing is done where something else is due at once; `enabled`: whether spool commands
        reach the valve.
        """
        most = 0 if self._clock.reset_is_due else self._actuator.undisturbed
        if not most:
            return standing, 0
        progress, inputs = self._progress[0], self._desk.inputs
        progress['rows'], progress['stamp'], inputs[:] = standing
        progress['base'] = self._clock.base
        code = self._call(self._actuator.solver, enabled, most)
        if code == loop.HALTED:
            self._clock.halt()
        standing = Standing(
            int(progress['rows']), int(progress['stamp']), tuple(inputs.tolist()))
        return standing, max(0, code)

    def _warm(self) -> None:
        solver = self._actuator.solver
        with warm_loop(len(solver.passes), not solver.model.extras):
            self._call(solver, True, 0)

    def _call(self, solver: Solver, enabled: bool, most: int) -> int:
        return loop.tick_on_grid(self._desk, solver, int(enabled), self._ring.descriptor, most)
