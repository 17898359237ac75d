# SPDX-License-Identifier: Apache-2.0
"""
How fast the solver is on this machine, beside a bare sweep of the same mesh in the same run.

The machine may be shared and noisy, so the two are timed in turn, in short pieces; the ratio of
the medians is the figure to compare between machines, the smallest piece the nearest to a
machine of its own.
"""

from dataclasses import dataclass
import math
import time

from hydra_actuator.actuator import Actuator
from hydra_actuator.core.compilation import kernel
from hydra_actuator.core.line import sweep
from hydra_actuator.parameters import Parameters
import numpy as np

PIECE = 5              # ticks in one timed piece
FREQUENCY = 50.0       # [Hz] of the full-stroke sine


@dataclass(frozen=True)
class Speed:
    """
    Times of one step [s] in rising order, shape (pieces,), and what a step is.

    step_time: simulated time of a step [s]; nodes: swept in a step; bare_times: of a sweep alone.
    """

    times: np.ndarray
    bare_times: np.ndarray
    step_time: float
    nodes: int

    def real_time_factor(self, quantile: float = 0.5) -> float:
        """Return simulated time over computing time, at a quantile of the pieces' times."""
        return self.step_time / float(np.quantile(self.times, quantile))

    @property
    def ratio_to_bare_sweep(self) -> float:
        """Median time of a whole step over that of a sweep alone."""
        return float(np.median(self.times) / np.median(self.bare_times))


@kernel
def repeat_sweep(waves, new_waves, mesh, passes, count):
    """Sweep the same field `count` times: the arithmetic of the lines and nothing else."""
    for _ in range(count):
        sweep(waves, new_waves, mesh, 1.0, passes)


def measure_speed(parameters: Parameters | None = None, duration: float = 2.0) -> Speed:
    """
    Time the actuator on a full-stroke sine of 50 Hz, on one core.

    duration: simulated time [s] to spread over the pieces, after a warm-up of 50 ms.
    """
    actuator = Actuator(parameters)
    model, state = actuator._model, actuator._state
    fields = (state.wave_p.copy(), state.wave_q.copy())
    bare = (fields, (fields[0].copy(), fields[1].copy()),
            (model.courant, model.slope, model.friction), actuator._passes)
    repeat_sweep(*bare, 1)
    commands = [math.sin(2.0 * math.pi * FREQUENCY * k * actuator.period)
                for k in range(math.ceil(duration / actuator.period))]
    warm = math.ceil(0.05 / actuator.period)
    for command in commands[:warm]:
        actuator.tick_once(command, command, 0.0)
    steps = PIECE * actuator.steps_per_period
    times, bare_times = [], []
    for start in range(warm, len(commands) - PIECE + 1, PIECE):
        began = time.perf_counter()
        for command in commands[start:start + PIECE]:
            actuator.tick_once(command, command, 0.0)
        ended = time.perf_counter()
        repeat_sweep(*bare, steps)
        times.append((ended - began) / steps)
        bare_times.append((time.perf_counter() - ended) / steps)
    return Speed(np.sort(times), np.sort(bare_times), actuator.step_time,
                 int(np.sum(state.last + 1 + model.moving)))
