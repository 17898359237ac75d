# SPDX-License-Identifier: Apache-2.0
"""
The actuator: parameters, a state, and the call that moves it. No ROS needed.

    from hydra_actuator import Actuator
    state = Actuator().advance(0.1, spool=0.5)
"""

from collections.abc import Callable, Mapping
import math

from hydra_actuator.actuator_state import ActuatorState, state_of
from hydra_actuator.assembly import (
    all_inputs,
    INPUTS,
    LOAD_FORCE,
    set_supply_pressure,
    SPOOL_1,
    SPOOL_2,
    TANK_PRESSURE,
)
from hydra_actuator.channels import Channels
from hydra_actuator.core.advance import advance
from hydra_actuator.core.observe import observe, read_field
from hydra_actuator.equilibrium import start
from hydra_actuator.faults import Faults
from hydra_actuator.faults.faults import Change
from hydra_actuator.field import field_labels, field_positions
from hydra_actuator.geometry import section_positions, sections
from hydra_actuator.kernels import ByModel, warm_kernels
from hydra_actuator.limits import broken_limit, SolverError
from hydra_actuator.parameters import Parameters
from hydra_actuator.plant_faults import apply_plant_faults, set_air, void_fractions
from hydra_actuator.signals import spool_pair
from hydra_actuator.solver import EXTREMES, note_extremes, Solver
from hydra_actuator.supply import Supply
from hydra_actuator.tally import Tally
import numpy as np

# Periods without end.
MANY = 2**62


class Actuator:
    """A servo-actuator; courant: its largest c dt/dx."""

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
        self.faults = Faults(p)
        self.supply = Supply(p['supply.pressure'], p['tank.pressure'], self.period)
        self._sections = sections(p)
        self._ambient = p['ambient_pressure']
        self._passes = (0,) * p['solver.iterations']
        self._times = np.zeros(1)
        self._table = np.zeros((1, INPUTS))
        self._inputs = np.zeros(INPUTS)
        self._extremes = np.zeros(1, EXTREMES)
        self._by_model = ByModel(advance)
        self.reset()
        self.for_each_model(self._warm)
        self.faults.air_may_come = p['fluid.cavitation'] or self.faults.enabled

    def reset(self) -> None:
        """
        Return to the initial state: commands zero, simulated time zero.

        Faults stay, the script begins anew.
        """
        self._model, self._state = start(self.parameters)
        self.step_time = self._model.step_time
        self.steps_per_period = round(self.period / self.step_time)
        self._table[:] = 0.0
        self._table[0, TANK_PRESSURE] = self.parameters['tank.pressure']
        self._inputs[:] = self._table[0]
        self._schedule = (self._times, self._table, True)
        self._extremes[0] = 0
        self.courant = float(np.max(self._model.courant))
        self.supply.begin()
        self.faults.restart()
        self.faults.follow(0.0)
        self._apply_faults()

    def for_each_model(self, call: Callable[[], None]) -> None:
        """Call with each kind of model this actuator may come to have; before the first step."""
        call()
        if self.faults.enabled and not self.parameters['fluid.cavitation']:
            # Air may get into the oil, or out again, which another kernel solves.
            self._model = set_air(self._model, self._state, 0.0 if self._model.gas else 1e-6)
            call()
            self._apply_faults()

    def _warm(self) -> None:
        with warm_kernels(len(self._passes), not self._model.extras):
            self._advance(self._schedule, 0)
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
    def tally(self) -> Tally:
        """What has happened since the start or the last reset."""
        return Tally(self._state, self._extremes)

    @property
    def solver(self) -> Solver:
        """What compiled code needs to solve periods, until the model changes."""
        return Solver(
            self._model, self._state, self._passes, self._schedule, self._inputs,
            self.steps_per_period, self._sections, self._ambient, self.row,
            self.channels.lowest_pressure, self._extremes)

    @property
    def undisturbed(self) -> int:
        """How many periods can be solved before the supply or the fault script acts."""
        if not self.supply.resting:
            return 0
        left = (self.faults.next_time - self._fault_time) / self.period
        return MANY if left > MANY else max(0, math.floor(left) - 1)

    def tick_once(self, spool_1: float, spool_2: float, load_force: float) -> int:
        """
        Advance one period with the commands (normalised, load in N) held; return the status code.

        `row` then holds the new observation. 0 is sound; status_message explains the rest.
        """
        table = self._table[0]
        table[SPOOL_1], table[SPOOL_2], table[LOAD_FORCE] = spool_1, spool_2, load_force
        code = self.go_on(self._schedule, self.steps_per_period)
        self._observe()
        note_extremes(self._extremes, self.row, self.channels.lowest_pressure)
        return code

    def follow(self, schedule: tuple[np.ndarray, np.ndarray, bool], steps: int) -> int:
        """
        Advance `steps` under a schedule, evaluated at every step; return the status code.

        schedule: (times (T,) [s] increasing, commands (T, 3): spool 1, spool 2 and load force,
        hold: keep each row until the next, else linear between rows).
        """
        code = self.go_on(self.schedule_of(schedule), steps)
        self._observe()
        return code

    def schedule_of(self, schedule: tuple[np.ndarray, np.ndarray, bool]) -> tuple:
        """Return a schedule with all inputs, from the row in force now on; see `follow`."""
        return all_inputs(schedule, self.time, self._table[0, TANK_PRESSURE])

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
            table[SPOOL_1], table[SPOOL_2] = spool_pair(spool)
        if load_force is not None:
            if not math.isfinite(load_force):
                raise ValueError(f'load_force {load_force!r} is not a finite force in N')
            table[LOAD_FORCE] = load_force
        if not 0.0 <= duration < math.inf:
            raise ValueError(f'duration {duration!r} is not a time of zero or more seconds')
        code = self.go_on(self._schedule, math.ceil(duration / self.step_time - 1e-6))
        self._observe()
        if code:
            raise SolverError(self.status_message(code))
        return self.state

    @property
    def state(self) -> ActuatorState:
        """The state as last advanced."""
        self._observe()
        pressures = self.row[self.channels.pressure] - self._ambient
        return state_of(self.row, self.channels, void_fractions(
            self.parameters, self.faults.active, self._model, pressures))

    def status_message(self, code: int) -> str:
        """Return what a status code of this actuator means, with place and limit."""
        return broken_limit(self._model, self._state, code, self.time)

    def set_supply_pressure(self, pressure: float) -> None:
        """Set the supply pressure [Pa, gauge] from the next step on."""
        self.supply.pressure = pressure
        self._give_supply(self.supply.give())

    def set_faults(self, changes: Mapping[str, object]) -> None:
        """
        Set faults by parameter, `{'fault.leakage': 2e-12}`, from the next step on.

        0 or False ends one. Those of instruments do not touch the state, which is the truth.
        Raises ParameterError, and then sets none; `fault.enabled` must be true.
        """
        self.take_faults(self.faults.check(changes))

    def take_faults(self, change: Change) -> None:
        """Set faults that `faults.check` has passed."""
        self.faults.take(change)
        self.faults.follow(self._fault_time)
        self._apply_faults()

    def clear_faults(self) -> None:
        """End all faults and the script."""
        self.faults.clear()
        self._apply_faults()

    @property
    def field_labels(self) -> list[str]:
        """The domain of each node of the field, in streamline order."""
        return field_labels(self._model)

    @property
    def field_positions(self) -> np.ndarray:
        """Streamline coordinate [m] of each node; the piston's faces at mid-stroke."""
        return field_positions(self._model)

    @property
    def section_positions(self) -> list[float]:
        """Streamline coordinate [m] of each section; the piston's faces at mid-stroke."""
        return section_positions(self.parameters, self._sections)

    def read_field(self, out: np.ndarray) -> None:
        """Write absolute pressure [Pa] and velocity [m/s] of all nodes, float32 (nodes, 2)."""
        read_field(self._model, self._state, self._ambient, out)

    def go_on(self, schedule: tuple, steps: int) -> int:
        """
        Advance under a schedule of all inputs and return the status code; nothing is read.

        At whole periods the supply moves and the fault script acts.
        """
        if not steps or (self.supply.resting and self.faults.next_time == math.inf):
            return self._advance(schedule, steps)
        code = 0
        while steps and not code:
            done = int(self._state.step[0]) % self.steps_per_period
            if not done:
                self._give_supply(self.supply.tick())
            part = min(steps, self.steps_per_period - done)
            code = self._advance(schedule, part)
            steps -= part
            if done + part == self.steps_per_period and self.faults.follow(self._fault_time):
                self._apply_faults()
        return code

    def _advance(self, schedule: tuple, steps: int) -> int:
        return self._by_model(self._model, self._state, self._passes, schedule, self._inputs,
                              steps, self.steps_per_period)

    @property
    def _fault_time(self) -> float:
        """Simulated time [s] with what rounding leaves of a row's time in a script."""
        return self.time + 0.5 * self.step_time

    def _give_supply(self, pressure: float | None) -> None:
        if pressure is not None:
            set_supply_pressure(self._model.source, pressure, self._model.wave_speed[0],
                                self._model.bulk_modulus[0])

    def _apply_faults(self) -> None:
        active = self.faults.active
        self.supply.loss = active.get('fault.supply_loss', 0.0)
        self._model = apply_plant_faults(self.parameters, active, self._model, self._state)

    def _observe(self) -> None:
        observe(self._model, self._state, self._sections, self._ambient, self._inputs, self.row)
