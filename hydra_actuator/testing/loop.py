# SPDX-License-Identifier: Apache-2.0
"""
A controller and an actuator in a closed loop, in one process and without middleware.

    state -> controller(state) -> command, held for one period -> actuator -> next state

As in lockstep: the command that follows from a state acts at once.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
import math

from hydra_actuator.actuator import Actuator, ActuatorState
import numpy as np

Command = float | tuple[float, float]


@dataclass(frozen=True)
class LoopRun:
    """
    What a loop did in n periods.

    states: n + 1 of them, from before the first command on; commands: n, normalised.
    """

    states: tuple[ActuatorState, ...]
    commands: tuple[Command, ...]

    @cached_property
    def time(self) -> np.ndarray:
        """Instants of the states (n + 1,) [s]."""
        return self.of('time')

    @cached_property
    def position(self) -> np.ndarray:
        """The piston's positions (n + 1,) [m]."""
        return self.of('position')

    @cached_property
    def velocity(self) -> np.ndarray:
        """The piston's velocities (n + 1,) [m/s]."""
        return self.of('velocity')

    def of(self, name: str) -> np.ndarray:
        """Return any number or tuple of the states by name, (n + 1,) or (n + 1, length)."""
        return np.array([getattr(state, name) for state in self.states])

    def pressure(self, section: str) -> np.ndarray:
        """Return the absolute pressure at a section (n + 1,) [Pa]."""
        return np.array([state.pressure[section] for state in self.states])


def run_loop(
    actuator: Actuator, controller: Callable[[ActuatorState], Command], duration: float,
    period: float,
) -> LoopRun:
    """
    Run a controller against an actuator, from its present state on.

    controller: returns the normalised spool command for a state, -1 to 1, or one a spool; it is
    called once each `period` [s], for `duration` [s] in all. A period that is no whole number of
    the actuator's steps varies by one of them, but does not drift. Raises ValueError for a
    command that is no number or out of range, with the instant, SolverError as `advance` does.
    """
    if not actuator.step_time <= period < math.inf:
        raise ValueError(
            f'period = {period!r} s is not a time of at least one step, '
            f'{actuator.step_time:.3g} s')
    if not period <= duration < math.inf:
        raise ValueError(f'duration = {duration!r} s is not a time of at least one period')
    begin = actuator.time
    states, commands = [actuator.state], []
    for k in range(1, round(duration / period) + 1):
        command = controller(states[-1])
        remaining = max(0.0, begin + k * period - actuator.time)
        try:
            states.append(actuator.advance(remaining, spool=command))
        except ValueError as error:
            raise ValueError(f'at {states[-1].time:.6g} s: {error}') from None
        commands.append(command)
    return LoopRun(tuple(states), tuple(commands))
