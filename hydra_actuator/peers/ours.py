# SPDX-License-Identifier: Apache-2.0
"""
The same line by this package's solver: a lone line, one core, all steps in one compiled call.

It solves the nonlinear equations at 200 reaches of Courant 1/1.025 with cubic interpolation, so
its exact answer is that of mu + u, 0.1 % above a V/g here. Of two passes, as by default, the
second takes slope and friction by the mean velocity of foot and arrival; one pass
(solver.iterations 1) has that of the foot alone, which is first order in time where the velocity
changes on the way.
"""

import time

from hydra_actuator.core.model import Domain, Junction
from hydra_actuator.core.oil import Oil
from hydra_actuator.core.records import CLOSED, PRESSURE
from hydra_actuator.peers.work import GRAVITY, Measured, rise_error, WORK
from hydra_actuator.verification.chains import (
    LoneChain,
    mesh_of,
    pressure_of,
    riemann_variable,
)
import numpy as np

DENSITY = 1000.0
# [1/m]; too small to be seen, but all of its arithmetic is done.
LOSS = 1e-9
BEFORE = 3


class OurLine:
    """The line, closed at its far end, in which the fluid still flows."""

    def __init__(self, passes: int = 2) -> None:
        """Build the line in its initial state; passes as solver.iterations."""
        work, c = WORK, WORK['wave_speed']
        self.modulus, self.pressure = DENSITY * c**2, DENSITY * GRAVITY * WORK['head']
        self.chain = LoneChain(
            [Domain('line', work['length'], 0.25 * np.pi * work['diameter'] ** 2, c, LOSS,
                    self.pressure)],
            [Junction(PRESSURE, (0,), 0), Junction(CLOSED, (1,))],
            mesh_of(work['length'], work['cells'], wave_speed=c, iterations=passes),
            Oil(DENSITY, 1e-6))
        self.nodes = work['cells'] + 1
        state, first = self.chain.state, self.chain.model.start[0]
        mu = riemann_variable(self.pressure, c, self.modulus)
        state.wave_p[first:first + self.nodes] = mu + work['velocity']
        state.wave_q[first:first + self.nodes] = mu - work['velocity']
        self.chain.hold(self.pressure)

    def head_at_valve(self, steps: int) -> np.ndarray:
        """Return the head at the valve [m] at BEFORE instants before it closes and at steps."""
        head = [self.pressure] * BEFORE
        for _ in range(steps):
            self.chain.advance(1)
            head.append(self.chain.end_pressure(1))
        return np.array(head) / (DENSITY * GRAVITY)

    @property
    def exact_rise(self) -> float:
        """The rise [m] of the nonlinear equations: mu + u arrives unchanged."""
        c = WORK['wave_speed']
        mu = riemann_variable(self.pressure, c, self.modulus) + WORK['velocity']
        return (pressure_of(mu, c, self.modulus) - self.pressure) / (DENSITY * GRAVITY)


def run_ours(steps: int, passes: int = 2) -> Measured:
    """Return what our line gives, timed over so many steps; passes as solver.iterations."""
    from hydra_actuator import __version__

    line = OurLine(passes)
    head = line.head_at_valve(2 * WORK['cells'])
    began = time.process_time()
    line.chain.advance(steps)
    seconds = time.process_time() - began
    return Measured(line.nodes * steps / seconds,
                    rise_error(head, BEFORE, line.nodes, line.exact_rise), __version__)
