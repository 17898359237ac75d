# SPDX-License-Identifier: Apache-2.0
"""
Many offline runs in one process, four actuators to a step: each the same as alone, to the bit.

Side by side go actuators with constant friction or none, no gas, no leakage at the valve and no
faults; others, and what is left over, run alone. Four actuators advance as many steps at once as
the one with the fewest has in its stretch; the rest of its longer stretches each does alone.
"""

from collections import defaultdict
from collections.abc import Callable, Sequence
from contextlib import ExitStack
import copy
from pathlib import Path

from hydra_actuator.actuator import Actuator
from hydra_actuator.assembly import choose_mesh, INPUTS
from hydra_actuator.core.lanes import WIDTH
from hydra_actuator.core.observe import SOUND
from hydra_actuator.core.together.advance import advance_together
from hydra_actuator.core.together.ensemble import build_ensemble, fits
from hydra_actuator.errors import Failure, InputError
from hydra_actuator.interruption import Interruption
from hydra_actuator.kernels import specialised, warm_together
from hydra_actuator.offline import Stretch
from hydra_actuator.parameters import ParameterError, Parameters
from hydra_actuator.parameters.table_hydraulics import LINES
from hydra_actuator.signals import Signal
from hydra_actuator.simulate import check_run, Course, Simulation
import numpy as np

# Stretches in a row that some lane's nearness to a limit may spoil, until all go on alone.
PATIENCE = 8


def kind_of(p: Parameters) -> tuple | None:
    """Return what actuators must have alike to go side by side, None for one that cannot."""
    if (p['fluid.cavitation'] or p['fault.enabled'] or p['valve.leakage'] > 0.0
            or any(p[f'{line}.friction'] in ('steady', 'unsteady') for line in LINES)):
        return None
    return p['solver.iterations'], p['solver.interpolation']


def group(parameters: Sequence[Parameters]) -> list[list[int]]:
    """
    Return the indices of the sets in groups: WIDTH that may go side by side, or one alone.

    Those with like counts of steps in a period are put together.
    """
    kinds: dict[tuple, list[tuple[int, int]]] = defaultdict(list)
    groups = []
    for index, p in enumerate(parameters):
        kind = kind_of(p)
        try:
            steps = round(p['timing.period'] / choose_mesh(p).step_time)
        except ParameterError:
            kind = None
        if kind is None:
            groups.append([index])
        else:
            kinds[kind].append((steps, index))
    for members in kinds.values():
        members.sort()
        whole = len(members) // WIDTH * WIDTH
        groups += [[index for _, index in members[k:k + WIDTH]] for k in range(0, whole, WIDTH)]
        groups += [[index] for _, index in members[whole:]]
    return groups


class SideBySide:
    """
    Four actuators that advance at once where they can; see hydra_actuator.core.together.

    Their balance of mass (Actuator.tally) begins anew with each advance at once.
    """

    def __init__(self, actuators: Sequence[Actuator]) -> None:
        """Take WIDTH actuators of one kind and make the kernel ready."""
        self._actuators = tuple(actuators)
        self._patience = PATIENCE
        solvers = [actuator.solver for actuator in actuators]
        models = tuple(solver.model for solver in solvers)
        states = tuple(solver.state for solver in solvers)
        self._fits = all(fits(model) for model in models)
        if not self._fits:
            return
        self._ensemble = build_ensemble(list(models), INPUTS)
        shadows = copy.deepcopy(states)
        self._members = (models, states, shadows)
        self._passes = solvers[0].passes
        self._own_inputs = [solver.inputs for solver in solvers]
        self._inputs = np.array(self._own_inputs)
        self._looks = np.array([solver.steps for solver in solvers])
        self._kernel = advance_together
        schedules = tuple(solver.schedule for solver in solvers)
        with warm_together(len(self._passes)):
            self._advance(schedules, 0)
        self._kernel = specialised(advance_together, self._arguments(schedules, 0))

    def follow(self, stretches: Sequence[Stretch]) -> list[int]:
        """Advance each by its stretch; return their status codes, as Actuator.follow does."""
        schedules = tuple(actuator.schedule_of(stretch.schedule)
                          for actuator, stretch in zip(self._actuators, stretches))
        common = min(stretch.steps for stretch in stretches)
        at_once = self._fits and all(actuator.undisturbed for actuator in self._actuators)
        if at_once and self._advance(schedules, common):
            self._patience = PATIENCE
        else:
            common = 0
        codes = []
        for actuator, schedule, stretch in zip(self._actuators, schedules, stretches):
            left = stretch.steps - common
            codes.append(actuator.go_on(schedule, left) if left else SOUND)
            actuator._observe()
        return codes

    def _arguments(self, schedules: tuple, count: int) -> tuple:
        return (self._ensemble, self._members, self._passes,
                (schedules, self._inputs, self._looks), count)

    def _advance(self, schedules: tuple, count: int) -> bool:
        """Advance all by `count` steps, or none."""
        for lane, own in enumerate(self._own_inputs):
            self._inputs[lane] = own
        done = self._kernel(*self._arguments(schedules, count))
        if done:
            for lane, own in enumerate(self._own_inputs):
                own[:] = self._inputs[lane]
        else:
            self._patience -= 1
            self._fits = self._patience > 0
        return done


def ready_together(parameters: Sequence[Parameters]) -> None:
    """Let the kernel for WIDTH such actuators be compiled and kept, if it is not."""
    SideBySide([Actuator(p) for p in parameters])


class _Member:
    """A run under way, what it is to do next, and why it failed."""

    def __init__(self, course: Course) -> None:
        self.course = course
        self.stretch: Stretch | None = None
        self.failure: Exception | None = None

    def go_on(self, code: int | None = None) -> None:
        """Take the status of the last stretch and find the next: None at the end."""
        try:
            self.stretch = self.course.next_stretch(code)
        except (InputError, Failure) as error:
            self.stretch, self.failure = None, error

    @property
    def share(self) -> float:
        """Return the part that is done."""
        return 1.0 if self.stretch is None else self.course.share


def simulate_side_by_side(
        parameters: Sequence[Parameters], command: Signal | None = None, duration: float = 1.0,
        outputs: Sequence[Path] | None = None, rate: float | None = None,
        progress: Callable[[float], None] | None = None) -> list[Simulation | Exception]:
    """
    Run many actuators under the same command, as `simulate` runs one, in this process.

    Each has the bits it has alone. Where a run fails, its InputError or SolverError is returned
    in its place. Raises KeyboardInterrupt on Ctrl-C: recordings begun are whole.
    """
    check_run(duration, rate)
    outcomes: list[Simulation | Exception | None] = [None] * len(parameters)
    done = 0
    for indices in group(parameters):
        with Interruption() as interruption, ExitStack() as closing:
            members: dict[int, _Member] = {}
            for index in indices:
                try:
                    members[index] = _Member(
                        Course(parameters[index], command, duration, rate))
                except (InputError, Failure) as error:
                    outcomes[index] = error
            interruption.hold()
            for index in list(members):
                try:
                    closing.callback(members[index].course.begin(
                        None if outputs is None else outputs[index]))
                except (InputError, Failure) as error:
                    outcomes[index] = error
                    del members[index]
            for _ in _play(list(members.values())):
                interruption.raise_if_asked()
                if progress is not None:
                    shares = sum(member.share for member in members.values())
                    progress((done + shares) / len(parameters))
            done += len(indices)
        for index, member in members.items():
            outcomes[index] = member.failure or member.course.result()
    return outcomes


def _play(members: list[_Member]):
    """Advance all to their ends, side by side while there are WIDTH; yield after each stretch."""
    for member in members:
        member.go_on()
    if len(members) == WIDTH:
        together = SideBySide([member.course.actuator for member in members])
        while all(member.stretch is not None for member in members):
            codes = together.follow([member.stretch for member in members])
            for member, code in zip(members, codes):
                member.go_on(code)
            yield
    for member in members:
        while member.stretch is not None:
            member.go_on(member.course.actuator.follow(*member.stretch))
            yield
