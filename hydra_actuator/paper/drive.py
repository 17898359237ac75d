# SPDX-License-Identifier: Apache-2.0
"""
An actuator driven by a function of time, evaluated at every step, and what was seen of it.

Times in units of L/c, as the paper has them: `Trace.units`. Pressures of a Trace are gauge.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cache
import math

from hydra_actuator.actuator import Actuator, SolverError
from hydra_actuator.channels import Channels, STATIONS
from hydra_actuator.geometry import domain_lengths, wave_speed
from hydra_actuator.parameters import Parameters
from hydra_actuator.verification.spool_response import paper_parameters
import numpy as np

# The paper's period and its second of simulation, in units of L/c.
PERIOD, SECOND = 40.0, 650.0
FREQUENCY = 16.25       # of that period, at L/c = 1/650 s [Hz]
STEPS_BETWEEN = 20      # of what is seen of long runs: ten times in a unit


def unit_time(parameters: Parameters) -> float:
    """Return L/c [s], the paper's unit of time, with L at the initial position."""
    return sum(domain_lengths(parameters)) / wave_speed(parameters)


def sine(frequency: float, amplitude: float = 1.0) -> Callable[[np.ndarray], np.ndarray]:
    """Return the spool command, a sine from zero; frequency [Hz], amplitude of full stroke."""
    return lambda times: amplitude * np.sin(2.0 * math.pi * frequency * times)


def opening(target: float, duration: float) -> Callable[[np.ndarray], np.ndarray]:
    """Return a command that rises to `target` at constant speed in `duration` [s], then holds."""
    return lambda times: target * np.clip(times / duration, 0.0, 1.0)


@dataclass(frozen=True)
class Trace:
    """Observations (N, width) in the order of `channels`; row 0 is the initial state."""

    parameters: Parameters
    channels: Channels
    rows: np.ndarray

    @property
    def time(self) -> np.ndarray:
        """Time [s]."""
        return self.rows[:, Channels.TIME]

    @property
    def units(self) -> np.ndarray:
        """Time in units of L/c."""
        return self.time / unit_time(self.parameters)

    @property
    def position(self) -> np.ndarray:
        """Piston position [m]."""
        return self.rows[:, Channels.POSITION]

    @property
    def spool(self) -> np.ndarray:
        """Spool displacement [m]."""
        return self.rows[:, Channels.SPOOL_1]

    @property
    def opening(self) -> np.ndarray:
        """Spool displacement as a share of its stroke."""
        return self.spool / self.parameters['valve.stroke']

    @property
    def mach(self) -> np.ndarray:
        """Largest |u|/c of the whole field."""
        return self.rows[:, Channels.MACH]

    def pressure(self, station: str) -> np.ndarray:
        """Return the gauge pressure [Pa] at a station."""
        column = self.channels.pressure.start + STATIONS.index(station)
        return self.rows[:, column] - self.parameters['ambient_pressure']

    def velocity(self, station: str) -> np.ndarray:
        """Return the flow velocity [m/s] at a station, positive from pump to tank."""
        return self.rows[:, self.channels.flow_velocity.start + STATIONS.index(station)]


def frames(actuator: Actuator, command: Callable, duration: float,
           every: int = 1) -> Iterator[Actuator]:
    """
    Yield the actuator each `every` steps over a duration [s].

    Raises SolverError where the method breaks.
    """
    for _ in range(math.ceil(duration / (actuator.step_time * every) - 1e-6)):
        first = round(actuator.time / actuator.step_time)
        times = np.arange(first + 1, first + every + 1) * actuator.step_time
        spool = command(times)
        code = actuator.follow((times, np.column_stack((spool, spool, 0.0 * spool)), True), every)
        if code:
            raise SolverError(actuator.status_message(code))
        yield actuator


def drive(parameters: Parameters, command: Callable, duration: float, every: int = 1) -> Trace:
    """Return what is seen each `every` steps of an actuator under a command, from its start."""
    actuator = Actuator(parameters.replace({'sections.names': STATIONS}))
    rows = [actuator.row.copy()]
    rows += [seen.row.copy() for seen in frames(actuator, command, duration, every)]
    return Trace(parameters, actuator.channels, np.array(rows))


@cache
def reference(duration: float = SECOND, frequency: float = FREQUENCY, amplitude: float = 1.0,
              every: int = STEPS_BETWEEN, **changes: object) -> Trace:
    """
    Return the paper's case, computed once; duration in units of L/c, frequency [Hz].

    changes: of the paper's parameters, with `__` for the dot of a name.
    """
    parameters = paper_parameters().replace(
        {name.replace('__', '.'): value for name, value in changes.items()})
    return drive(parameters, sine(frequency, amplitude), duration * unit_time(parameters), every)


def field_at(command: Callable, units: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """
    Return (x [m], gauge pressure [Pa], velocity [m/s]) of the paper's field, each (N,).

    At the step nearest to a time in units of L/c; nodes that no chamber covers are left out.
    """
    parameters = paper_parameters()
    actuator = Actuator(parameters)
    steps = round(units * unit_time(parameters) / actuator.step_time)
    for _ in frames(actuator, command, steps * actuator.step_time, steps):
        pass
    out = np.empty((len(actuator.field_labels), 2), np.float32)
    actuator.read_field(out)
    covered = ~np.isnan(out[:, 0])
    pressure, velocity = out[covered].astype(float).T
    return actuator.field_positions[covered], pressure - parameters['ambient_pressure'], velocity
