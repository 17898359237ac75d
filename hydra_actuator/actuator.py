# SPDX-License-Identifier: Apache-2.0
"""
The actuator: parameters, a state, and the call that moves it. No ROS needed.

    from hydra_actuator import Actuator
    state = Actuator().advance(0.1, spool=0.5)
"""

from dataclasses import dataclass
import math

from hydra_actuator.assembly import (
    INPUTS,
    LOAD_FORCE,
    oil,
    set_supply_pressure,
    SPOOL_1,
    SPOOL_2,
    TANK_PRESSURE,
)
from hydra_actuator.channels import Channels, DOMAINS
from hydra_actuator.core.advance import advance
from hydra_actuator.core.observe import NOT_A_NUMBER, observe, read_field, TOO_FAST
from hydra_actuator.equilibrium import start
from hydra_actuator.errors import Failure
from hydra_actuator.geometry import section_positions, sections
from hydra_actuator.kernels import warm_kernels
from hydra_actuator.parameters import Parameters
import numpy as np

# Of absolute less vapour pressure [Pa]: without gas it can be below 0.
TINY = 1e-6
# What counts as below vacuum [Pa]: 0, less what rounding leaves.
VACUUM = -1.0


class SolverError(Failure):
    """A condition broke the method; the message names it and its place."""


@dataclass(frozen=True)
class ActuatorState:
    """
    What the actuator shows at one instant.

    time [s], position [m], velocity [m/s], effort [N] (hydraulic force), spool_position [m]
    (one per spool), pressure [Pa, absolute] and flow_velocity [m/s] by section. With cavitation
    cavity_volume [m^3] of the whole streamline and void_fraction by section, else 0; see
    hydra_actuator.core.boiling.
    """

    time: float
    position: float
    velocity: float
    effort: float
    spool_position: tuple[float, ...]
    pressure: dict[str, float]
    flow_velocity: dict[str, float]
    cavity_volume: float
    void_fraction: dict[str, float]


@dataclass(frozen=True)
class Cavities:
    """Cavities open now, opened and collapsed since the start, largest volume [m^3] of all."""

    open: int
    opened: int
    collapsed: int
    largest: float


class Actuator:
    """A hydraulic servo-actuator, solved in steps of `step_time`."""

    def __init__(self, parameters: Parameters | None = None) -> None:
        """
        Build the actuator in its initial state and make its kernels ready.

        parameters: the defaults if None. Raises ParameterError for what cannot be meshed.
        """
        self.parameters = Parameters() if parameters is None else parameters
        p = self.parameters
        self.channels = Channels(p['sections.names'], p['valve.spools'])
        self.period = p['timing.period']
        self.row = self.channels.empty_row()
        self._sections = sections(p)
        self._ambient = p['ambient_pressure']
        self._passes = (0,) * p['solver.iterations']
        self._times = np.zeros(1)
        self._table = np.zeros((1, INPUTS))
        self._inputs = np.zeros(INPUTS)
        self.reset()
        self._make_ready()

    def reset(self) -> None:
        """Return to the initial state: commands zero, simulated time zero."""
        self._model, self._state = start(self.parameters)
        self.step_time = self._model.step_time
        self.steps_per_period = round(self.period / self.step_time)
        self._table[:] = 0.0
        self._table[0, TANK_PRESSURE] = self.parameters['tank.pressure']
        self._inputs[:] = self._table[0]
        self._schedule = (self._times, self._table, True)
        self._vacuum_ticks = 0

    def _make_ready(self) -> None:
        with warm_kernels(len(self._passes), not self._model.extras):
            self._run(self._schedule, 0)
            self._observe()
            self.read_field(np.empty((len(self.field_labels), 2), np.float32))

    @property
    def time(self) -> float:
        """Simulated time [s]."""
        return int(self._state.step[0]) * self.step_time

    @property
    def tick(self) -> int:
        """Whole periods done."""
        return int(self._state.step[0]) // self.steps_per_period

    @property
    def stop_hits(self) -> int:
        """How often the piston has run into an end stop."""
        return int(self._state.piston[0]['stop_hits'])

    @property
    def cavities(self) -> Cavities:
        """How many cavities there are and were, as of the last whole period."""
        counts = self._state.cavities[0]
        return Cavities(int(counts['open']), int(counts['opened']), int(counts['collapsed']),
                        float(counts['largest']))

    @property
    def vacuum_ticks(self) -> int:
        """At how many ticks absolute pressure was below 0 somewhere: possible without gas only."""
        return self._vacuum_ticks

    def tick_once(self, spool_1: float, spool_2: float, load_force: float) -> int:
        """
        Advance one period with the commands (normalised, load in N) held; return the status code.

        `row` then holds the new observation. 0 is sound; status_message explains the rest.
        """
        table = self._table[0]
        table[SPOOL_1], table[SPOOL_2], table[LOAD_FORCE] = spool_1, spool_2, load_force
        code = self._run(self._schedule, self.steps_per_period)
        self._observe()
        if self.row[self.channels.lowest_pressure] < VACUUM:
            self._vacuum_ticks += 1
        return code

    def follow(self, schedule: tuple[np.ndarray, np.ndarray, bool], steps: int) -> int:
        """
        Advance `steps` under a schedule, evaluated at every step; return the status code.

        schedule: (times (T,) [s] increasing, commands (T, 3): spool 1, spool 2 and load force,
        hold: keep each row until the next, else linear between rows).
        """
        times, commands, hold = schedule
        first = max(0, int(np.searchsorted(times, self.time, side='right')) - 1)
        table = np.empty((len(times) - first, INPUTS))
        table[:, :TANK_PRESSURE] = commands[first:]
        table[:, TANK_PRESSURE] = self._table[0, TANK_PRESSURE]
        code = self._run((np.ascontiguousarray(times[first:]), table, hold), steps)
        self._observe()
        return code

    def advance(self, duration: float, spool: float | tuple[float, float] | None = None,
                load_force: float | None = None) -> ActuatorState:
        """
        Advance by a duration [s], rounded up to whole steps, and return the state.

        spool: normalised command -1..1, one for each spool or one for all; load_force [N],
        positive opposes positive motion; None keeps the last. Raises SolverError where the method
        breaks, ValueError for a command that is no number or out of range.
        """
        table = self._table[0]
        if spool is not None:
            pair = (spool, spool) if np.ndim(spool) == 0 else tuple(spool)
            if len(pair) != 2 or not all(-1.0 <= x <= 1.0 for x in pair):
                raise ValueError(f'spool {spool!r} is not one or two numbers from -1 to 1')
            table[SPOOL_1], table[SPOOL_2] = pair
        if load_force is not None:
            if not math.isfinite(load_force):
                raise ValueError(f'load_force {load_force!r} is not a finite force in N')
            table[LOAD_FORCE] = load_force
        if not 0.0 <= duration < math.inf:
            raise ValueError(f'duration {duration!r} is not a time of zero or more seconds')
        code = self._run(self._schedule, math.ceil(duration / self.step_time - 1e-6))
        self._observe()
        if code:
            raise SolverError(self.status_message(code))
        return self.state

    @property
    def state(self) -> ActuatorState:
        """The state as last advanced."""
        self._observe()
        row, channels = self.row, self.channels
        names = channels.section_names
        return ActuatorState(
            *(float(x) for x in row[:channels.SPOOL_1]),
            tuple(float(x) for x in row[channels.SPOOL_1:channels.SPOOL_1 + channels.spools]),
            dict(zip(names, row[channels.pressure].tolist())),
            dict(zip(names, row[channels.flow_velocity].tolist())),
            float(row[channels.cavity_volume]),
            dict(zip(names, self._void_fractions().tolist())))

    def _void_fractions(self) -> np.ndarray:
        """Return the gas by volume at each section."""
        gas, model = oil(self.parameters), self._model
        star = self.row[self.channels.pressure] - self._ambient + model.floor
        return gas.air_fraction * model.floor / np.maximum(star, TINY)

    def status_message(self, code: int) -> str:
        """Return what a status code of this actuator means, with place and limit."""
        _, domain, value = self._state.fault
        place = DOMAINS[int(domain)]
        if code == NOT_A_NUMBER:
            return f'NaN in {place} at {self.time:.6f} s'
        if code == TOO_FAST:
            return (f'|u|/c = {value:.4g} in {place} at {self.time:.6f} s exceeds '
                    f'solver.max_mach {self._model.max_mach:g}')
        return (f'{place} is {value:.4g} m long at {self.time:.6f} s, shorter than one cell of '
                f'{self._model.spacing[int(domain)]:.4g} m; raise solver.cells')

    def set_supply_pressure(self, pressure: float) -> None:
        """Set the supply pressure [Pa, gauge] from the next step on."""
        set_supply_pressure(self._model.source, pressure, self._model.wave_speed[0],
                            self._model.bulk_modulus[0])

    @property
    def field_labels(self) -> list[str]:
        """The domain of each node of the field, in streamline order."""
        counts = self._model.capacity + 1 + self._model.moving
        return [name for name, count in zip(DOMAINS, counts) for _ in range(count)]

    @property
    def field_positions(self) -> np.ndarray:
        """Streamline coordinate [m] of each node; the piston's faces at mid-stroke."""
        model, parts = self._model, []
        for d in range(len(DOMAINS)):
            x = model.spacing[d] * np.arange(model.capacity[d] + 1)
            if model.moving[d]:
                x = np.append(x, model.piston[0][f'length_{d - 1}'])
            x = model.origin[d] + model.direction[d] * x
            parts.append(x if model.direction[d] > 0 else x[::-1])
        return np.concatenate(parts)

    @property
    def section_positions(self) -> list[float]:
        """Streamline coordinate [m] of each section; the piston's faces at mid-stroke."""
        return section_positions(self.parameters, self._sections)

    def read_field(self, out: np.ndarray) -> None:
        """Write absolute pressure [Pa] and velocity [m/s] of all nodes, float32 (nodes, 2)."""
        read_field(self._model, self._state, self._ambient, out)

    def _run(self, schedule: tuple, steps: int) -> int:
        return advance(self._model, self._state, self._passes, schedule, self._inputs, steps,
                       self.steps_per_period)

    def _observe(self) -> None:
        observe(self._model, self._state, self._sections, self._ambient, self._inputs, self.row)
