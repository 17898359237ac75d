# SPDX-License-Identifier: Apache-2.0
"""
How fast the solver is on this machine, beside a bare sweep of the same mesh in the same run.

The machine may be shared and noisy, so what is compared is timed in turn, in short pieces; the
ratio of the medians is the figure to compare between machines, the smallest piece the nearest to
a machine of its own.
"""

from collections.abc import Callable
import copy
from dataclasses import dataclass
import math
import time

from hydra_actuator.actuator import Actuator, SolverError
from hydra_actuator.core.compilation import kernel
from hydra_actuator.core.line import sweep_domains
from hydra_actuator.offline import Stretch
from hydra_actuator.parameters import Parameters
from hydra_actuator.parameters.options import EVERYTHING, OPTIONS
from hydra_actuator.side_by_side import SideBySide, simulate_side_by_side
from hydra_actuator.signals import Sine
from hydra_actuator.simulate import simulate
import numpy as np

PIECE = 5              # ticks in one timed piece
RUN = 1000             # ticks of a timed run
LEAST_RUNS = 5         # whose median is not that of a moment
FREQUENCY = 50.0       # [Hz] of the full-stroke sine
WARM_UP = 0.05         # [s]


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
def repeat_sweep(model, state, passes, count):
    """Sweep the same field `count` times: the arithmetic of the lines and nothing else."""
    for _ in range(count):
        sweep_domains(model, state, passes)


def processor_time(function: Callable, *arguments) -> float:
    """Return the processor time [s] of a call in this thread."""
    began = time.thread_time()
    function(*arguments)
    return time.thread_time() - began


def measure_speed(parameters: Parameters | None = None, duration: float = 2.0) -> Speed:
    """
    Time the actuator on a full-stroke sine of 50 Hz, on one core.

    duration: simulated time [s] to spread over the pieces, after a warm-up of 50 ms.
    """
    actuator = Actuator(parameters)
    bare = (actuator._model, copy.deepcopy(actuator._state), actuator._passes)
    repeat_sweep(*bare, 1)
    drive(actuator, math.ceil(WARM_UP / actuator.period))
    steps = PIECE * actuator.steps_per_period
    times, bare_times = [], []
    for _ in range(_pieces(actuator, duration)):
        began = time.perf_counter()
        drive(actuator, PIECE)
        ended = time.perf_counter()
        repeat_sweep(*bare, steps)
        times.append((ended - began) / steps)
        bare_times.append((time.perf_counter() - ended) / steps)
    return Speed(np.sort(times), np.sort(bare_times), actuator.step_time,
                 int(np.sum(actuator._state.last + 1 + actuator._model.moving)))


def measure_options(parameters: Parameters | None = None, duration: float = 1.0,
                    progress: Callable[[float], None] | None = None) -> dict[str, np.ndarray]:
    """
    Return the time of a step [s], shape (pieces,), of a model and of it with each option added.

    parameters: of that model, the paper's by default; duration: simulated time [s] of each;
    progress is told the part that is done. The models are timed in turn, piece by piece, on the
    drive of `measure_speed`, by the processor's time of this thread.
    """
    model = Parameters().replace({'tank.pressure': 0.0}) if parameters is None else parameters
    choices = {'as configured': {}, **OPTIONS, 'everything': EVERYTHING}
    actuators = {name: Actuator(model.replace(choice)) for name, choice in choices.items()}
    for actuator in actuators.values():
        drive(actuator, math.ceil(WARM_UP / actuator.period))
    pieces = _pieces(next(iter(actuators.values())), duration)
    times = {name: np.empty(pieces) for name in choices}
    for k in range(pieces):
        for name, actuator in actuators.items():
            began = time.thread_time()
            drive(actuator, PIECE)
            steps = PIECE * actuator.steps_per_period
            times[name][k] = (time.thread_time() - began) / steps
        if progress is not None:
            progress((k + 1) / pieces)
    return times


def measure_together(duration: float = 1.0,
                     progress: Callable[[float], None] | None = None) -> dict[str, np.ndarray]:
    """
    Return processor times of one actuator's step [s], shape (pieces,), alone and in fours.

    Four of the paper's model with masses of their own, on the drive of `measure_speed`, `duration`
    [s] each: 'solver' advances one period per call, 'run' is `simulate` that keeps its rows in
    memory. Alone and in fours are timed in turn.
    """
    parameters = [Parameters().replace({'tank.pressure': 0.0, 'cylinder.mass': mass})
                  for mass in (7.0, 9.0, 11.0, 13.0)]
    apart, at_once = ([Actuator(p) for p in parameters] for _ in range(2))
    together = SideBySide(at_once)
    steps, step_time = apart[0].steps_per_period, apart[0].step_time
    command = Sine(FREQUENCY)

    def stretch(actuator):
        times = actuator.time + np.arange(1, steps + 1) * step_time
        return Stretch((times, command(times), True), steps)

    def solve_apart():
        for actuator in apart:
            for _ in range(PIECE):
                actuator.follow(*stretch(actuator))

    def solve_together():
        for _ in range(PIECE):
            together.follow([stretch(actuator) for actuator in at_once])

    def run_apart():
        for p in parameters:
            simulate(p, command, span)

    def run_together():
        simulate_side_by_side(parameters, command, span)

    periods = RUN
    span = periods * apart[0].period
    works = {'solver, alone': (solve_apart, PIECE),
             'solver, four at once': (solve_together, PIECE), 'run, alone': (run_apart, periods),
             'run, four at once': (run_together, periods)}
    pieces = max(LEAST_RUNS, math.ceil(duration / span))
    times = {name: np.empty(pieces) for name in works}
    for k in range(pieces):
        for name, (work, count) in works.items():
            times[name][k] = processor_time(work) / (len(parameters) * count * steps)
        if progress is not None:
            progress((k + 1) / pieces)
    return times


def _pieces(actuator: Actuator, duration: float) -> int:
    """Return how many pieces fit into a duration [s], the warm-up taken off, at least one."""
    return max(1, math.floor((duration - WARM_UP) / actuator.period / PIECE))


def drive(actuator: Actuator, ticks: int) -> None:
    """Advance by ticks under the sine; SolverError where the method breaks."""
    for _ in range(ticks):
        command = math.sin(2.0 * math.pi * FREQUENCY * actuator.tick * actuator.period)
        code = actuator.tick_once(command, command, 0.0)
        if code:
            raise SolverError(actuator.status_message(code))
