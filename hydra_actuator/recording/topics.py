# SPDX-License-Identifier: Apache-2.0
"""
What is recorded: topic names, types, quality of service.

The names are absolute, as recorded. A node and an offline run record the same topics; the offline
run writes those of a node `/actuator`.
"""

from dataclasses import dataclass
from typing import Literal

from hydra_actuator.recording import messages

_NEVER = '{indent}  sec: 9223372036\n{indent}  nsec: 854775807\n'


@dataclass(frozen=True)
class Topic:
    """One topic of a recording; `qos` is what its publisher offers, and a player will offer."""

    name: str
    type: str
    qos: Literal['reliable', 'best_effort'] = 'reliable'

    def offered_qos_profiles(self) -> str:
        """Return the YAML list of profiles, as version 9 of rosbag2's metadata writes it."""
        never = _NEVER.format(indent='  ')
        return (
            '- history: keep_last\n'
            f'  depth: {10 if self.qos == "reliable" else 1}\n'
            f'  reliability: {self.qos}\n'
            '  durability: volatile\n'
            f'  deadline:\n{never}'
            f'  lifespan:\n{never}'
            '  liveliness: automatic\n'
            f'  liveliness_lease_duration:\n{never}'
            '  avoid_ros_namespace_conventions: false'
        )


class ActuatorTopics:
    """
    The topics of one actuator node; every attribute is a name, `pressure` one by section.

    An attribute may be set to the name a remapping gave a topic before `all` is asked for.
    """

    def __init__(self, node: str = '/actuator', section_names: tuple[str, ...] = ()):
        """Take the fully qualified name of the node and its sections."""
        namespace = node.rpartition('/')[0]
        self.joint_states = f'{namespace}/joint_states'
        self.true_joint_states = f'{node}/true_joint_states'
        self.clock = '/clock'
        self.pressure = {name: f'{node}/pressure/{name}' for name in section_names}
        self.sections = f'{node}/sections'
        self.cavities = f'{node}/cavities'
        self.field = f'{node}/field'
        self.applied = f'{node}/applied'
        self.events = f'{node}/events'
        self.diagnostics = '/diagnostics'
        self.parameter_events = '/parameter_events'
        self.spool_command = f'{node}/spool_command'
        self.commands = f'{node}/commands'
        self.joint_commands = f'{namespace}/joint_commands'
        self.load_force = f'{node}/load_force'

    def published(self) -> list[Topic]:
        """Return the topics of the actuator's state and of what it reports."""
        return [
            Topic(self.joint_states, messages.JOINT_STATE),
            Topic(self.true_joint_states, messages.JOINT_STATE),
            *(Topic(name, messages.FLUID_PRESSURE) for name in self.pressure.values()),
            Topic(self.sections, messages.FLOAT64_ARRAY),
            Topic(self.cavities, messages.FLOAT64_ARRAY),
            Topic(self.field, messages.FLOAT32_ARRAY),
            Topic(self.applied, messages.FLOAT64_ARRAY),
            Topic(self.events, messages.DIAGNOSTICS),
            Topic(self.diagnostics, messages.DIAGNOSTICS),
            Topic(self.parameter_events, messages.PARAMETER_EVENT),
            Topic(self.clock, messages.CLOCK),
        ]

    def received(self) -> list[Topic]:
        """Return the topics of commands."""
        return [
            Topic(self.spool_command, messages.FLOAT64),
            Topic(self.commands, messages.FLOAT64_ARRAY),
            Topic(self.joint_commands, messages.JOINT_STATE),
            Topic(self.load_force, messages.FLOAT64),
        ]

    def all(self) -> list[Topic]:
        """Return every topic of a recording."""
        return [*self.published(), *self.received()]
