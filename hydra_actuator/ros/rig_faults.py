# SPDX-License-Identifier: Apache-2.0
"""
Faults and sensors of a rig: set between two ticks, read from a definite row on, announced.

The plant says from which row on other faults are true; the publishing thread reads rows of that
number and later so, and says what has begun, changed or ended.
"""

from collections.abc import Callable, Mapping

from hydra_actuator.actuator import Actuator
from hydra_actuator.faults.announcements import Announcer, NAME
from hydra_actuator.faults.faults import Change
from hydra_actuator.parameters import Parameters
from hydra_actuator.ros.outputs import Outputs
from hydra_actuator.ros.plant import Plant
from hydra_actuator.ros.watch import Event


class RigFaults:
    """Stands between the actuator's faults, the plant and the outputs; wires itself to both."""

    def __init__(
        self, actuator: Actuator, plant: Plant, outputs: Outputs, event: Event,
        parameters: Callable[[], Parameters],
    ):
        """parameters: gives those in force, for sensors."""
        self._actuator = actuator
        self._plant = plant
        self._outputs = outputs
        self._event = event
        self._parameters = parameters
        self._announcer = Announcer()
        plant.on_faults = self._set_instruments
        outputs.on_faults = self._announce

    def check(self, changes: Mapping[str, object]) -> Change | None:
        """
        Return the change of faults among changes of parameters, None if there is none.

        Those of sections that are not there are for the next configure. Raises InputError for
        what cannot act now.
        """
        known = self._parameters().table
        faults = {name: value for name, value in changes.items()
                  if name.startswith('fault.') and name in known}
        return self._actuator.faults.check(faults) if faults else None

    def take(self, fault: Change | None, changes: Mapping[str, object]) -> None:
        """Take a checked change and what changed of sensors, between two ticks."""
        if fault is not None:
            self._actuator.take_faults(fault)
        if fault is not None or any(name.startswith('sensor.') for name in changes):
            self._set_instruments(self._plant.rows)

    def clear(self) -> bool:
        """End all faults and the script; False if the plant did not get round to it."""
        return self._plant.order(self._actuator.clear_faults)

    def announce_anew(self) -> None:
        """Say what is at work to whoever has heard nothing yet, such as a new recording."""
        self._announcer = Announcer()
        self._announce(self._actuator.faults.active)

    def _set_instruments(self, number: int) -> None:
        """Have rows from that number on be read as sensors and faults are now."""
        faults = self._actuator.faults
        self._outputs.set_instruments(
            number, self._parameters(), faults.active, faults.enabled)

    def _announce(self, active: Mapping[str, object]) -> None:
        """Send an event for each fault that has begun, changed or ended."""
        for level, message, values in self._announcer.news(active):
            self._event(level, NAME, message, values)
