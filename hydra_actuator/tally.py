# SPDX-License-Identifier: Apache-2.0
"""What has happened in an actuator since its start: cavities, mass, stops, and the extremes."""

from dataclasses import dataclass

from hydra_actuator.core.records import State
import numpy as np


@dataclass(frozen=True)
class Cavities:
    """Cavities open now, opened and collapsed since the start, largest volume [m^3] of all."""

    open: int
    opened: int
    collapsed: int
    largest: float


@dataclass(frozen=True)
class MassBalance:
    """
    Oil since the start, or since the gas in it was last changed by a fault.

    passed [kg] through the outer ends, half of pump's and tank's either way; residual [kg]: in -
    out - stored, as of the last weighing. See hydra_actuator.core.mass.
    """

    passed: float
    residual: float


class Tally:
    """Counts of a state; each is read when it is asked for."""

    def __init__(self, state: State, extremes: np.ndarray) -> None:
        """Take a state, and what hydra_actuator.solver notes of each period."""
        self._state = state
        self._extremes = extremes

    @property
    def stop_hits(self) -> int:
        """How often the piston has run into an end stop."""
        return int(self._state.piston[0]['stop_hits'])

    @property
    def cavities(self) -> Cavities:
        """How many cavities there are and were, as of the last whole period."""
        return Cavities(*self._state.cavities[0].item())

    @property
    def mass(self) -> MassBalance:
        """What is missing of the oil's mass, and how much has passed the pump and the tank."""
        return MassBalance(*self._state.mass[['passed', 'residual']][0].item())

    @property
    def vacuum_ticks(self) -> int:
        """At how many ticks absolute pressure was below 0 somewhere: possible without gas only."""
        return int(self._extremes['vacuum_ticks'][0])

    @property
    def largest_mach(self) -> float:
        """Largest |u|/c at the end of any tick."""
        return float(self._extremes['largest_mach'][0])
