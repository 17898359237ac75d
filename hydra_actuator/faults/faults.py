# SPDX-License-Identifier: Apache-2.0
"""
The faults at work: what parameters, live changes and the script have made of them.

Whoever sets a fault last wins. Changes act between two ticks, a change of several together; rows
of the script at the first tick not before their time. A new script takes effect from its
beginning: what is past is set at once. Nothing here knows what a fault does.
"""

from collections.abc import Mapping
import math
from typing import NamedTuple

from hydra_actuator.faults.script import is_fault, read_script, ScriptRow
from hydra_actuator.parameters import ParameterError, Parameters
from hydra_actuator.parameters.definition import Value
from hydra_actuator.parameters.table import unknown

AIR = 'fault.air_fraction'


class Change(NamedTuple):
    """A checked change: values of faults, whether they may act, the script; None: as before."""

    values: dict[str, Value]
    enabled: bool | None
    script: tuple[ScriptRow, ...] | None


class Faults:
    """
    Values of all faults.

    `active` holds those at work, by parameter: replaced as a whole, never changed. `edition`
    counts how often it was replaced. Without `air_may_come` there is no kernel for air in the oil,
    and compiling one would stop the ticks: that fault is refused then.
    """

    def __init__(self, parameters: Parameters):
        """Take faults and script from parameters; raises InputError for a bad script."""
        self.active: Mapping[str, Value] = {}
        self.edition = 0
        self.air_may_come = True
        self.enabled: bool = parameters['fault.enabled']
        self._table = parameters.table
        self._values = {
            name: value for name, value in parameters.items() if is_fault(name) and value}
        self._script = read_script(parameters['fault.script'], self._table)
        self._renew()
        self.restart()

    def restart(self) -> None:
        """Begin the script anew; the faults at work stay."""
        self._done = 0
        self.next_time = self._script[0].time if self._script else math.inf

    def follow(self, time: float) -> bool:
        """Set what the script has set by a time [s]; tell whether that changes anything."""
        if time < self.next_time:
            return False
        script = self._script
        while self._done < len(script) and script[self._done].time <= time:
            self._values[script[self._done].parameter] = script[self._done].value
            self._done += 1
        self.next_time = script[self._done].time if self._done < len(script) else math.inf
        return self._renew()

    def check(self, changes: Mapping[str, object]) -> Change:
        """
        Return a change by parameters `fault.*` that `take` will accept.

        Reads a script. Raises ParameterError or InputError.
        """
        for name in changes:
            if name not in self._table:
                raise unknown(name, self._table)
            if not name.startswith('fault.'):
                raise ParameterError(f'{name} is no fault')
        checked = {name: self._table[name].check(value) for name, value in changes.items()}
        enabled = checked.pop('fault.enabled', None)
        script = None
        if 'fault.script' in checked:
            script = read_script(checked.pop('fault.script'), self._table)
        if not (self.enabled if enabled is None else enabled):
            for name in (name for name, value in checked.items() if value):
                raise ParameterError(f'{name} = {checked[name]} needs fault.enabled = true')
        if not self.air_may_come and (checked.get(AIR) or any(
                row.parameter == AIR and row.value for row in script or ())):
            raise ParameterError(f'{AIR} needs fault.enabled = true from the start')
        return Change(checked, enabled, script)

    def take(self, change: Change) -> bool:
        """Set faults; tell whether that changes what is at work."""
        if change.enabled is not None:
            self.enabled = change.enabled
        if change.script is not None:
            self._script = change.script
            self.restart()
        self._values.update(change.values)
        return self._renew()

    def clear(self) -> bool:
        """Forget all faults and the script; tell whether that changes what is at work."""
        self._values.clear()
        self._script = ()
        self.restart()
        return self._renew()

    def _renew(self) -> bool:
        """Bring `active` up to date, in the order of the table."""
        at_work = {
            name: self._values[name] for name in self._table if self._values.get(name)
        } if self.enabled and self._values else {}
        if at_work == self.active:
            return False
        self.active = at_work
        self.edition += 1
        return True
