# SPDX-License-Identifier: Apache-2.0
"""
One observation row of the actuator as messages, and the two arrays beside it.

What is encoded here is both published and recorded. Spools have no velocity channel and no
effort: both are NaN in the joint state, whose arrays are all of full length.
"""

from collections.abc import Sequence
import math

from hydra_actuator.channels import Channels
from hydra_actuator.recording.messages import (
    FluidPressureEncoder,
    JointStateEncoder,
    MultiArrayEncoder,
    SECOND,
)
from hydra_actuator.recording.topics import ActuatorTopics
import numpy as np

QUANTITIES = 'pressure,velocity'


class TickEncoder:
    """Turns observation rows into joint states, pressures and the sections' array."""

    def __init__(self, channels: Channels, joint_names: Sequence[str], topics: ActuatorTopics):
        """Take the joints in order: the piston's, then one per spool."""
        if len(joint_names) != 1 + channels.spools:
            raise ValueError(f'{len(joint_names)} joint names for {channels.spools} spools')
        sections = len(channels.section_names)
        self._spools = slice(channels.SPOOL_1, channels.SPOOL_1 + channels.spools)
        self._unknown = [math.nan] * channels.spools
        self._channels = channels
        self._topics = topics
        self._joint_state = JointStateEncoder(joint_names)
        self._pressures = [
            (topics.pressure[name], FluidPressureEncoder(name).encode)
            for name in channels.section_names
        ]
        self._sections = MultiArrayEncoder(
            1 + 2 * sections,
            [(','.join(channels.section_names), sections, 2 * sections), (QUANTITIES, 2, 2)],
            data_offset=1,
        )
        names = [name for name, _ in channels.cavity_names()]
        self._cavities = MultiArrayEncoder(
            1 + len(names), [(','.join(names), len(names), len(names))], data_offset=1)

    def joint_state(self, row: Sequence[float], stamp_ns: int) -> bytes:
        """Return the JointState of a row."""
        own = self._channels
        return self._joint_state.encode(
            stamp_ns,
            [row[own.POSITION], *row[self._spools]],
            [row[own.VELOCITY], *self._unknown],
            [row[own.EFFORT], *self._unknown],
        )

    def pressures(
        self, row: Sequence[float], stamp_ns: int, variance: float = 0.0
    ) -> list[tuple[str, bytes]]:
        """Return (topic, FluidPressure) for each section."""
        return [
            (topic, encode(stamp_ns, pressure, variance))
            for (topic, encode), pressure in zip(self._pressures, row[self._channels.pressure])
        ]

    def sections(self, row: Sequence[float], stamp_ns: int) -> bytes:
        """Return the Float64MultiArray: stamp [s], then pressure and velocity by section."""
        values = [stamp_ns / SECOND] * (1 + 2 * len(self._pressures))
        values[1::2] = row[self._channels.pressure]
        values[2::2] = row[self._channels.flow_velocity]
        return self._sections.encode(values)

    def cavities(self, row: Sequence[float], stamp_ns: int) -> bytes:
        """Return the Float64MultiArray: stamp [s], then what the row says about cavities."""
        return self._cavities.encode([stamp_ns / SECOND, *row[self._channels.cavities]])

    def encode(
        self, row: np.ndarray | Sequence[float], stamp_ns: int, pressures: bool = True,
        sections: bool = True,
    ) -> list[tuple[str, bytes]]:
        """Return (topic, message) for the joint state and, as asked, the others."""
        row = row.tolist() if isinstance(row, np.ndarray) else row
        encoded = [(self._topics.joint_states, self.joint_state(row, stamp_ns))]
        if pressures:
            encoded += self.pressures(row, stamp_ns)
        if sections:
            encoded.append((self._topics.sections, self.sections(row, stamp_ns)))
        return encoded


class AppliedEncoder:
    """[tick, spool commands, load] as the solver took them: what a replay needs."""

    def __init__(self, spools: int):
        names = ['tick', *(f'spool_{spool + 1}' for spool in range(spools)), 'load_force']
        size = len(names)
        self._array = MultiArrayEncoder(size, [(','.join(names), size, size)])

    def encode(self, tick: int, spools: Sequence[float], load_force: float) -> bytes:
        """Return the message; commands normalised, load [N]."""
        return self._array.encode([tick, *spools, load_force])


class FieldEncoder:
    """
    Pressure and velocity of every node of the mesh, single precision.

    The first value is the simulated time [s], not a wall stamp: single precision would hold
    that only to about two minutes. The message's log time is the exact stamp.
    """

    def __init__(self, nodes: int):
        self._array = MultiArrayEncoder(
            1 + 2 * nodes, [('node', nodes, 2 * nodes), (QUANTITIES, 2, 2)],
            data_offset=1, single=True,
        )
        self._shape = (nodes, 2)

    def encode(self, time: float, field: np.ndarray) -> bytes:
        """Return the message; `field` is (nodes, 2): absolute pressure [Pa], velocity [m/s]."""
        if field.shape != self._shape:
            raise ValueError(f'field of shape {field.shape}, not {self._shape}')
        values = field.astype('<f4', copy=False)
        return self._array.encode_buffer(np.float32(time).astype('<f4').tobytes()
                                         + values.tobytes())
