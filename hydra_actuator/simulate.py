# SPDX-License-Identifier: Apache-2.0
"""
An offline run, as fast as it goes: the node's solver, the node's recording.

Time starts at 0 and the initial state is the first record. An output instant between two steps
is the next step, with its own stamp; faster outputs than the steps are one per step. The command
is evaluated at every step, whatever the outputs are.

Beside the states, a recording holds the command as it stood at each tick and at each state, when
it had changed since: a command that moves with every step is not kept step by step.
"""

from collections.abc import Callable
from contextlib import ExitStack
from dataclasses import dataclass
from functools import cached_property
import math
from pathlib import Path

from hydra_actuator.actuator import Actuator
from hydra_actuator.channels import Channels
from hydra_actuator.errors import InputError
from hydra_actuator.interruption import Interruption
from hydra_actuator.offline import next_stretch, Run, Stretch
from hydra_actuator.parameters import Parameters
from hydra_actuator.recording.reader import load_recording
from hydra_actuator.signals import Hold, Signal
from hydra_actuator.sinks import Rows, RunRecording
import numpy as np


@dataclass(frozen=True)
class Simulation:
    """What an offline run gave: its recording, or the rows themselves if none was asked for."""

    channels: Channels
    recording: Path | None
    kept_rows: np.ndarray | None = None

    @cached_property
    def rows(self) -> np.ndarray:
        """
        Rows (T, channels.width), one per state.

        A recording is read for them when they are first asked for. What it does not hold is NaN:
        the Mach number, and flow velocities where the sections have another rate.
        """
        if self.kept_rows is not None:
            return self.kept_rows
        return load_recording(self.recording).rows


def simulate(parameters: Parameters | None = None, command: Signal | None = None,
             duration: float = 1.0, output: str | Path | None = None, rate: float | None = None,
             progress: Callable[[float], None] | None = None) -> Simulation:
    """
    Run an actuator for `duration` [s].

    command: a signal of hydra_actuator.signals, or None for zero; output: directory of a new
    recording, with which a run of any length takes no more memory; rate [Hz]: of states and
    pressures, else as parameters say; progress: called with the share done.

    Raises SolverError where the method breaks, KeyboardInterrupt on Ctrl-C: what was recorded
    until then is closed and whole. Raises InputError for what cannot be run, ParameterError and
    RecordingError among it, before anything is written.
    """
    check_run(duration, rate)
    with Interruption() as interruption, ExitStack() as closing:
        course = Course(parameters, command, duration, rate)
        interruption.hold()
        closing.callback(course.begin(output))
        stretch = course.next_stretch()
        while stretch is not None:
            stretch = course.next_stretch(course.actuator.follow(*stretch))
            interruption.raise_if_asked()
            if progress is not None:
                progress(course.share)
    return course.result()


class Course:
    """A run of `simulate` under way; whoever has it advances `actuator`."""

    def __init__(self, parameters: Parameters | None, command: Signal | None, duration: float,
                 rate: float | None) -> None:
        """Make the actuator ready; arguments and errors as those of `simulate`."""
        self.actuator = Actuator(parameters)
        self._run = Run(self.actuator, Hold() if command is None else command, rate)
        self._steps = math.ceil(duration / self.actuator.step_time - 1e-6)

    def begin(self, output: str | Path | None) -> Callable[[], None]:
        """Open the recording, if there is to be one; return what closes it."""
        self._output = output
        self._sink = (Rows() if output is None else
                      RunRecording(self.actuator, self._run.instruments, output))
        self._stretches = self._run.stretches(self._steps, self._sink)
        return self._sink.close

    def next_stretch(self, code: int | None = None) -> Stretch | None:
        """Take the status of the last stretch and return the next one, None at the end."""
        return next_stretch(self._stretches, code)

    @property
    def share(self) -> float:
        """Return the part that is done."""
        return self._run.step / self._steps if self._steps else 1.0

    def result(self) -> Simulation:
        """Return what the run gave."""
        channels = self.actuator.channels
        if self._output is not None:
            return Simulation(channels, Path(self._output))
        return Simulation(channels, None, np.array(self._sink.rows).reshape(-1, channels.width))


def check_run(duration: float, rate: float | None) -> None:
    """Raise InputError for a duration [s] or a rate [Hz] that no run can have."""
    if not 0.0 <= duration < math.inf:
        raise InputError(f'duration {duration!r} is not a time of zero or more seconds')
    if rate is not None and not 0.0 < rate < math.inf:
        raise InputError(f'rate {rate!r} is not a positive frequency in Hz')
