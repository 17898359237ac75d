# SPDX-License-Identifier: Apache-2.0
"""
The parameters as ROS parameters: declared from their definitions, refused at the door.

At start-up a refused override leaves the default in its place and its reason in `refusals`; the
node lives, and does not configure before the parameter is set right (a misspelt one cannot be:
that takes a new start). Afterwards a change is taken whole or not at all, and while the node is
active only where the definition says that it may.
"""

import array
from collections.abc import Callable, Mapping
import sys

from hydra_actuator.faults import read_script
from hydra_actuator.faults.script import is_fault
from hydra_actuator.parameters import (
    belongs_to_ros,
    definitions,
    Parameter,
    ParameterError,
    PARAMETERS,
    Parameters,
)
from hydra_actuator.parameters.table import unknown
from rcl_interfaces.msg import (
    FloatingPointRange,
    IntegerRange,
    ParameterDescriptor,
    SetParametersResult,
)
from rclpy.node import Node
from rclpy.parameter import Parameter as RosParameter

TYPES = {
    'double': RosParameter.Type.DOUBLE,
    'integer': RosParameter.Type.INTEGER,
    'bool': RosParameter.Type.BOOL,
    'string': RosParameter.Type.STRING,
    'double_array': RosParameter.Type.DOUBLE_ARRAY,
    'integer_array': RosParameter.Type.INTEGER_ARRAY,
    'string_array': RosParameter.Type.STRING_ARRAY,
}
SCRIPT = 'fault.script'
SIMULATED_TIME = 'use_sim_time'
MODE = 'timing.mode'
_FOLLOW_CLOCK = (
    'use_sim_time = true is refused in timing.mode realtime, which gives time and does not '
    'take it; follow_clock is the mode that follows /clock')


def descriptor(definition: Parameter) -> ParameterDescriptor:
    """Return the definition as ROS shows it."""
    unit = f' [{definition.unit}]' if definition.unit not in ('', '1') else ''
    shown = ParameterDescriptor(description=f'{definition.meaning}{unit}')
    if definition.choices:
        shown.additional_constraints = 'one of ' + ', '.join(definition.choices)
    if not definition.live:
        shown.additional_constraints = '; '.join(
            filter(None, (shown.additional_constraints, 'not while active')))
    low, high = definition.minimum, definition.maximum
    if definition.type == 'double' and (low, high) != (None, None):
        shown.floating_point_range = [FloatingPointRange(
            from_value=-sys.float_info.max if low is None else float(low),
            to_value=sys.float_info.max if high is None else float(high))]
    if definition.type == 'integer' and (low, high) != (None, None):
        shown.integer_range = [IntegerRange(
            from_value=-2**63 if low is None else int(low),
            to_value=2**63 - 1 if high is None else int(high), step=1)]
    return shown


def to_ros(definition: Parameter, value: object) -> RosParameter:
    """Return a checked value as a ROS parameter of the definition's type, empty lists too."""
    value = definition.check(value)
    return RosParameter(
        definition.name, TYPES[definition.type], list(value) if definition.is_array else value)


def plain(parameter: RosParameter) -> object:
    """Return the value of a ROS parameter as Parameters takes it."""
    value = parameter.value
    is_list = value is not None and not isinstance(value, (str, bytes, bool, int, float))
    return list(value) if is_list else value


def _retyped(change: RosParameter, definition: Parameter) -> RosParameter:
    """Return a change with integers as doubles, and an empty list as one of its type."""
    value, wanted = change.value, TYPES[definition.type]
    if change.type_ == RosParameter.Type.INTEGER and wanted == RosParameter.Type.DOUBLE:
        return RosParameter(change.name, wanted, float(value))
    if definition.is_array and isinstance(value, (list, tuple, array.array)):
        if wanted == RosParameter.Type.DOUBLE_ARRAY and all(type(one) is int for one in value):
            return RosParameter(change.name, wanted, [float(one) for one in value])
        if not len(value):
            return RosParameter(change.name, wanted, [])
    return change


class ParameterDoor:
    """
    All ways by which a parameter enters the node.

    `is_active` tells whether only live parameters may change now; `on_change` is given the new
    parameters after a change was accepted, with the definitions and values of what changed;
    `further_check` raises on what is sound but cannot be now.
    """

    def __init__(self, node: Node):
        self.refusals: dict[str, str] = {}
        self.is_active: Callable[[], bool] = lambda: False
        self.on_change: Callable[[dict[str, object]], None] = lambda changes: None
        self.further_check: Callable[[dict[str, object]], None] = lambda changes: None
        self._node = node
        self._declare_all()
        node.add_pre_set_parameters_callback(self._take_integers_for_doubles)
        node.add_on_set_parameters_callback(self._judge)
        node.add_post_set_parameters_callback(self._tell)

    @property
    def table(self) -> Mapping[str, Parameter]:
        """The definitions for the sections as they are named now."""
        return definitions(tuple(self._value('sections.names')))

    def parameters(self) -> Parameters:
        """Return all parameters as they stand; raises ParameterError, the first refusal first."""
        for reason in self.refusals.values():
            raise ParameterError(reason)
        return Parameters(self._values())

    def forget_faults(self) -> None:
        """Set all faults and the script to none."""
        table = self.table
        self._node.set_parameters_atomically([
            to_ros(table[name], table[name].default) for name, value in self._values().items()
            if value and (is_fault(name) or name == SCRIPT)])

    def _values(self) -> dict[str, object]:
        return {name: self._value(name) for name in self.table if self._node.has_parameter(name)}

    def _value(self, name: str) -> object:
        return plain(self._node.get_parameter(name))

    def _declare_all(self) -> None:
        """Declare every parameter with its override where that is good, else its default."""
        # rclpy has no public way to see an override before it is declared, and one of the wrong
        # type ends the node there.
        overrides = {
            name: plain(parameter)
            for name, parameter in self._node._parameter_overrides.items()}
        names = PARAMETERS['sections.names']
        try:
            sections = names.check(overrides.get(names.name, names.default))
        except ParameterError:
            sections = names.default
        table = definitions(sections)
        for name, definition in table.items():
            self._declare(definition, overrides.pop(name, definition.default))
        if self._simulated_realtime({}):
            self.refusals[SIMULATED_TIME] = _FOLLOW_CLOCK
        for name in overrides:
            if not belongs_to_ros(name):
                self.refusals[name] = str(unknown(name, table))

    def _declare(self, definition: Parameter, wanted: object) -> None:
        if wanted is None and definition.is_array:
            # So rcl reads an empty list.
            wanted = []
        try:
            parameter = to_ros(definition, wanted)
        except ParameterError as refusal:
            self.refusals[definition.name] = str(refusal)
            parameter = to_ros(definition, definition.default)
        # By its value, an empty list would become one of bytes for ever.
        empty = definition.is_array and not parameter.value
        self._node.declare_parameter(
            definition.name, parameter.type_ if empty else parameter.value,
            descriptor(definition), ignore_override=True)
        if empty:
            self._node.set_parameters([parameter])

    def _take_integers_for_doubles(self, changes: list[RosParameter]) -> list[RosParameter]:
        """Give numbers and lists the type that is wanted, before rclpy compares types."""
        table = self.table
        return [
            _retyped(change, table[change.name]) if change.name in table else change
            for change in changes]

    def _judge(self, changes: list[RosParameter]) -> SetParametersResult:
        try:
            reason = self._objection({change.name: plain(change) for change in changes})
        except Exception as error:
            reason = str(error)
        return SetParametersResult(successful=not reason, reason=reason)

    def _objection(self, changes: dict[str, object]) -> str:
        """Return why changes cannot be made together now, '' if they can."""
        if changes.keys() & {SIMULATED_TIME, MODE} and self._simulated_realtime(changes):
            return _FOLLOW_CLOCK
        own = {name: value for name, value in changes.items() if not belongs_to_ros(name)}
        table = self.table
        for name, value in own.items():
            if name not in table:
                return str(unknown(name, table))
            table[name].check(value)
            if self.is_active() and not table[name].live:
                return f'{name}: not while the node is active; deactivate it first'
        if own and self._sound():
            self._with(own)
        if SCRIPT in own:
            read_script(own[SCRIPT], table)
        self.further_check(own)
        return ''

    def _simulated_realtime(self, changes: Mapping[str, object]) -> bool:
        """Tell whether, with changes, real time would have to be taken from /clock."""
        simulated, mode = (
            changes[name] if name in changes else self._value(name)
            for name in (SIMULATED_TIME, MODE))
        return bool(simulated) and mode == 'realtime'

    def _sound(self) -> bool:
        """Tell whether the parameters fit together now; if not, configuring will say so."""
        try:
            self.parameters()
        except ParameterError:
            return False
        return True

    def _with(self, changes: dict[str, object]) -> Parameters:
        """Return all parameters as they would be; raises ParameterError."""
        values = {**self._values(), **changes}
        table = definitions(tuple(values['sections.names']))
        return Parameters({name: value for name, value in values.items() if name in table})

    def _tell(self, changes: list[RosParameter]) -> None:
        for change in changes:
            self.refusals.pop(change.name, None)
        if not self._simulated_realtime({}):
            self.refusals.pop(SIMULATED_TIME, None)
        own = {change.name: plain(change) for change in changes if change.name in self.table}
        if 'sections.names' in own:
            self._declare_sections()
        if not own:
            return
        try:
            self.on_change(own)
        except Exception as error:
            self._node.get_logger().error(f'parameters {sorted(own)} did not act: {error!r}')

    def _declare_sections(self) -> None:
        """Declare what sections bring along that were named after the start."""
        missing = [one for one in self.table.values() if not self._node.has_parameter(one.name)]
        for definition in missing:
            # A declaration is a change as well, and comes back to here.
            if not self._node.has_parameter(definition.name):
                self._declare(definition, definition.default)
