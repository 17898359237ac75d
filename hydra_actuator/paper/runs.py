# SPDX-License-Identifier: Apache-2.0
"""
The runs behind figures and statements, each made once and kept in memory.

The paper's reference is a full sine of 40 units of L/c, 16.25 Hz, for one second, 650 units, on
200 cells. Every step keeps its observation row; the field is kept every 72 steps, as the paper
draws it (as often a period at another frequency), every fourth step in the first 12 units, where
waves stand alone, and at some moments. Units are those of its equation (17): V_max is the pump's
flow in the supply line, p_max the supply pressure, L the streamline, T = L/c.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
import math

from hydra_actuator.actuator import Actuator, SolverError
from hydra_actuator.analysis import streamline
from hydra_actuator.analysis.series import Field
from hydra_actuator.channels import Channels, STATIONS
from hydra_actuator.geometry import domain_lengths, wave_speed
from hydra_actuator.interruption import Interruption
from hydra_actuator.parameters import Parameters
from hydra_actuator.signals import Sine
from hydra_actuator.verification.passes import STEPS_BETWEEN, velocity_unit, whole_field
from hydra_actuator.verification.spool_response import paper_parameters
import numpy as np

FREQUENCY, SECOND = 16.25, 1.0
PERIODS = 10                # of a sine at another frequency
FIRST_UNITS = 12.0          # the beginning, kept densely [L/c]
FIRST_STEPS_BETWEEN = 4
# Within the paper's last loop, whose nodes lie at 50.570 to 50.577 [L/c].
PAPERS_END = 50.5735
CELLS = 200
STEPS_BETWEEN_REPORTS = 500


@dataclass(frozen=True)
class Run:
    """A run: rows (T, channels.width) of every step at `times` [s], its fields, its parameters."""

    parameters: Parameters
    frequency: float            # of the command [Hz]
    amplitude: float            # of the command, 1 is full stroke
    step_time: float            # [s]
    times: np.ndarray           # (T,) [s]
    rows: np.ndarray            # (T, width)
    channels: Channels
    field: Field                # every 72 steps or as often a period; pressure absolute [Pa]
    first: Field                # every 4 steps in the first 12 units
    moments: Field              # the end, a quarter of a period before, the paper's end

    @cached_property
    def length_unit(self) -> float:
        """L, the whole streamline [m]."""
        return sum(domain_lengths(self.parameters))

    @cached_property
    def time_unit(self) -> float:
        """L/c [s]."""
        return self.length_unit / wave_speed(self.parameters)

    @cached_property
    def velocity_unit(self) -> float:
        """V_max [m/s]."""
        return velocity_unit(self.parameters)

    @cached_property
    def pressure_unit(self) -> float:
        """p_max [Pa]."""
        return self.parameters['supply.pressure']

    @property
    def tau(self) -> np.ndarray:
        """Time of every step [L/c], (T,)."""
        return self.times / self.time_unit

    @property
    def position(self) -> np.ndarray:
        """Position of the piston at every step [m], (T,)."""
        return self.rows[:, self.channels.POSITION]

    @property
    def station_pressure(self) -> np.ndarray:
        """p/p_max, gauge, at the twelve stations at every step, (T, 12)."""
        return self.to_units_of_pressure(self.rows[:, self.channels.pressure])

    @property
    def station_velocity(self) -> np.ndarray:
        """u/V_max at the twelve stations at every step, (T, 12)."""
        return self.rows[:, self.channels.flow_velocity] / self.velocity_unit

    @property
    def field_times(self) -> np.ndarray:
        """Time of every frame of the field [s], (T2,)."""
        return self.field.time

    @cached_property
    def pressure(self) -> np.ndarray:
        """Absolute pressure of the field [Pa], (T2, N); what the piston left takes its face's."""
        return streamline.gapless(self.field, self.field.pressure)

    @cached_property
    def velocity(self) -> np.ndarray:
        """Velocity of the field [m/s], (T2, N); what the piston left takes its face's."""
        return streamline.gapless(self.field, self.field.velocity)

    @cached_property
    def positions(self) -> np.ndarray:
        """Streamline coordinate [m] of the field's nodes, (T2, N), moving faces followed."""
        return self.positions_of(self.field)

    @property
    def station_places(self) -> np.ndarray:
        """x/L of the twelve stations at mid-stroke, (12,)."""
        labels = np.array(self.field.labels)
        ends = [np.flatnonzero(labels == domain)[[0, -1]] for domain in streamline.DOMAINS]
        return self.field.positions[np.concatenate(ends)] / self.length_unit

    def positions_of(self, field: Field) -> np.ndarray:
        """Return the streamline coordinate [m] of every node in every frame of a field."""
        return streamline.node_positions(field, np.interp(field.time, self.times, self.position))

    def to_units_of_pressure(self, absolute: np.ndarray) -> np.ndarray:
        """Return p/p_max, gauge as the paper's, of absolute pressures [Pa]."""
        return (absolute - self.parameters['ambient_pressure']) / self.pressure_unit

    def station(self, letter: str) -> int:
        """Return the number of a station, 0 to 11."""
        return STATIONS.index(letter)


_RUNS: dict[tuple, Run] = {}


def reference(cavitation: bool = False, passes: int = 2, frequency: float = FREQUENCY,
              amplitude: float = 1.0, duration: float | None = None, cells: int = CELLS,
              progress: Callable[[float], None] | None = None) -> Run:
    """
    Return the paper's case under a sine [Hz], of one second or, at other frequencies, ten periods.

    The same wish is the same run, made once. duration [s]; progress: called with the share done.
    Raises SolverError where the method breaks, KeyboardInterrupt on Ctrl-C.
    """
    if duration is None:
        duration = SECOND if frequency == FREQUENCY else PERIODS / frequency
    key = (cavitation, passes, frequency, amplitude, duration, cells)
    if key not in _RUNS:
        parameters = paper_parameters().replace({
            'fluid.cavitation': cavitation, 'solver.iterations': passes, 'solver.cells': cells,
            'sections.names': STATIONS})
        _RUNS[key] = make_run(parameters, Sine(frequency, amplitude), duration, progress)
    return _RUNS[key]


def make_run(parameters: Parameters, sine: Sine, duration: float,
             progress: Callable[[float], None] | None = None) -> Run:
    """Run an actuator under a sine for a duration [s] and keep every step."""
    with Interruption() as interruption:
        actuator = Actuator(parameters)
        unit = sum(domain_lengths(parameters)) / wave_speed(parameters)
        dt = actuator.step_time
        steps = math.ceil(duration / dt - 1e-6)
        times = np.arange(steps + 1) * dt
        commands = sine(times)
        rows = np.empty((steps + 1, actuator.channels.width))
        between = max(1, round(STEPS_BETWEEN * FREQUENCY / sine.frequency))
        first_steps = min(steps, round(FIRST_UNITS * unit / dt))
        quarter = round(0.25 / (sine.frequency * dt))
        special = {steps, steps - quarter, round(PAPERS_END * unit / dt)}
        frames, beginning, moments = (_Frames(actuator) for _ in range(3))
        interruption.hold()
        for k in range(steps + 1):
            if k and (code := actuator.follow((times[k:k + 1], commands[k:k + 1], True), 1)):
                raise SolverError(actuator.status_message(code))
            rows[k] = actuator.row
            if k % between == 0 or k == steps:
                frames.take(times[k])
            if k % FIRST_STEPS_BETWEEN == 0 and k <= first_steps:
                beginning.take(times[k])
            if k in special:
                moments.take(times[k])
            if k % STEPS_BETWEEN_REPORTS == 0:
                interruption.raise_if_asked()
                if progress is not None:
                    progress(k / max(steps, 1))
    return Run(parameters, sine.frequency, sine.amplitude, dt, times, rows, actuator.channels,
               frames.field(f'every {between}th step'),
               beginning.field(f'every {FIRST_STEPS_BETWEEN}th step'),
               moments.field('single moments'))


class _Frames:
    """Frames of an actuator's field, as they come."""

    def __init__(self, actuator: Actuator) -> None:
        self._actuator = actuator
        self._times: list[float] = []
        self._frames: list[np.ndarray] = []

    def take(self, time: float) -> None:
        """Keep the field as it is now."""
        self._times.append(time)
        self._frames.append(whole_field(self._actuator).astype(np.float32))

    def field(self, source: str) -> Field:
        """Return all frames as a field."""
        values = np.array(self._frames)
        labels = tuple(self._actuator.field_labels)
        return Field(
            np.array(self._times), self._actuator.field_positions, labels,
            values[:, :, 0].astype(float), values[:, :, 1].astype(float),
            streamline.piston_faces(labels), source)
