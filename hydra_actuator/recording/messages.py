# SPDX-License-Identifier: Apache-2.0
"""
The messages of this package as CDR bytes, from plain Python values.

Functions for any of them, and an encoder object for each frequent one: as long as its names
and lengths stay, a message is one `struct` call over a template. Both give what rclpy's
`serialize_message` gives, byte for byte, save that padding is zero here and undefined there.

Stamps are nanoseconds since the epoch of their clock, pressures absolute [Pa].
"""

from collections.abc import Iterable, Mapping, Sequence
import struct

from hydra_actuator.recording.cdr import codec, HEADER

FLOAT64 = 'std_msgs/msg/Float64'
FLOAT64_ARRAY = 'std_msgs/msg/Float64MultiArray'
FLOAT32_ARRAY = 'std_msgs/msg/Float32MultiArray'
STRING = 'std_msgs/msg/String'
JOINT_STATE = 'sensor_msgs/msg/JointState'
FLUID_PRESSURE = 'sensor_msgs/msg/FluidPressure'
DIAGNOSTICS = 'diagnostic_msgs/msg/DiagnosticArray'
CLOCK = 'rosgraph_msgs/msg/Clock'
PARAMETER_EVENT = 'rcl_interfaces/msg/ParameterEvent'

SECOND = 1_000_000_000

# rcl_interfaces/msg/ParameterType, and the field of ParameterValue that carries each.
PARAMETER_TYPES = {
    'bool': 1, 'integer': 2, 'double': 3, 'string': 4, 'byte_array': 5, 'bool_array': 6,
    'integer_array': 7, 'double_array': 8, 'string_array': 9,
}

Dimension = tuple[str, int, int]
Status = tuple[int, str, str, str, Mapping[str, str]]


def float64(value: float) -> bytes:
    """Return a Float64."""
    return struct.pack('<4sd', HEADER, value)


def string(text: str) -> bytes:
    """Return a String."""
    return codec(STRING).encode({'data': text})


def clock(stamp_ns: int) -> bytes:
    """Return a Clock."""
    return struct.pack('<4siI', HEADER, *divmod(stamp_ns, SECOND))


def joint_state(
    stamp_ns: int, names: Sequence[str], position: Sequence[float],
    velocity: Sequence[float], effort: Sequence[float],
) -> bytes:
    """Return a JointState; [m], [m/s], [N]."""
    return codec(JOINT_STATE).encode({
        'header': _header(stamp_ns), 'name': names, 'position': position,
        'velocity': velocity, 'effort': effort,
    })


def fluid_pressure(
    stamp_ns: int, frame_id: str, pressure: float, variance: float = 0.0
) -> bytes:
    """Return a FluidPressure; absolute [Pa], variance [Pa^2]."""
    return codec(FLUID_PRESSURE).encode({
        'header': _header(stamp_ns, frame_id), 'fluid_pressure': pressure, 'variance': variance,
    })


def float64_multi_array(
    data: Sequence[float], dimensions: Iterable[Dimension] = (), data_offset: int = 0
) -> bytes:
    """Return a Float64MultiArray; a dimension is (label, size, stride)."""
    return codec(FLOAT64_ARRAY).encode(_multi_array(data, dimensions, data_offset))


def float32_multi_array(
    data: Sequence[float], dimensions: Iterable[Dimension] = (), data_offset: int = 0
) -> bytes:
    """Return a Float32MultiArray; a dimension is (label, size, stride)."""
    return codec(FLOAT32_ARRAY).encode(_multi_array(data, dimensions, data_offset))


def diagnostic_array(stamp_ns: int, statuses: Iterable[Status]) -> bytes:
    """Return a DiagnosticArray; a status is (level, name, message, hardware_id, values)."""
    return codec(DIAGNOSTICS).encode({
        'header': _header(stamp_ns),
        'status': [
            {
                'level': level, 'name': name, 'message': message, 'hardware_id': hardware_id,
                'values': [{'key': key, 'value': value} for key, value in values.items()],
            }
            for level, name, message, hardware_id, values in statuses
        ],
    })


def parameter_event(
    stamp_ns: int, node: str, changed: Iterable[tuple[str, str, object]],
    new: Iterable[tuple[str, str, object]] = (),
) -> bytes:
    """Return a ParameterEvent; a parameter is (name, type, value), types as PARAMETER_TYPES."""
    return codec(PARAMETER_EVENT).encode({
        'stamp': _time(stamp_ns), 'node': node,
        'new_parameters': [_parameter(*parameter) for parameter in new],
        'changed_parameters': [_parameter(*parameter) for parameter in changed],
    })


def decode(type_name: str, data: bytes) -> dict:
    """Return a message of one of the package's types as a dictionary."""
    return codec(type_name).decode(data)


class JointStateEncoder:
    """JointState messages of the same joints, all arrays of full length."""

    def __init__(self, names: Sequence[str]):
        """Take the joints in order, at least one."""
        count = len(names)
        blank = joint_state(0, names, [0.0] * count, [0.0] * count, [0.0] * count)
        arrays = len(blank) - 3 * 8 * count - 2 * 8
        self._constant = blank[12:arrays]
        self._count = count
        form = f'<4siI{len(self._constant)}s{count}dI4x{count}dI4x{count}d'
        self._pack = struct.Struct(form).pack

    def encode(
        self, stamp_ns: int, position: Sequence[float], velocity: Sequence[float],
        effort: Sequence[float],
    ) -> bytes:
        """Return the message; each array has one value per joint, NaN where unknown."""
        seconds, rest = divmod(stamp_ns, SECOND)
        count = self._count
        return self._pack(
            HEADER, seconds, rest, self._constant, *position, count, *velocity, count, *effort
        )


class FluidPressureEncoder:
    """FluidPressure messages of one place."""

    def __init__(self, frame_id: str):
        self._constant = fluid_pressure(0, frame_id, 0.0)[12:-16]
        self._pack = struct.Struct(f'<4siI{len(self._constant)}sdd').pack

    def encode(self, stamp_ns: int, pressure: float, variance: float = 0.0) -> bytes:
        """Return the message; absolute pressure [Pa]."""
        seconds, rest = divmod(stamp_ns, SECOND)
        return self._pack(HEADER, seconds, rest, self._constant, pressure, variance)


class MultiArrayEncoder:
    """Multi-arrays of one layout, as Float64 or, with `single`, as Float32."""

    def __init__(
        self, count: int, dimensions: Sequence[Dimension] = (), data_offset: int = 0,
        single: bool = False,
    ):
        """Take the number of values in a message, data offset included."""
        encode, form = (float32_multi_array, 'f') if single else (float64_multi_array, 'd')
        blank = encode([0.0] * count, dimensions, data_offset)
        self._constant = blank[: len(blank) - count * struct.calcsize(form)]
        self._pack = struct.Struct(f'<{len(self._constant)}s{count}{form}').pack

    def encode(self, data: Sequence[float]) -> bytes:
        """Return the message with these values."""
        return self._pack(self._constant, *data)

    def encode_buffer(self, data: bytes) -> bytes:
        """Return the message with these values as little-endian bytes of the right type."""
        return self._constant + data


def _time(stamp_ns: int) -> dict:
    seconds, rest = divmod(stamp_ns, SECOND)
    return {'sec': seconds, 'nanosec': rest}


def _header(stamp_ns: int, frame_id: str = '') -> dict:
    return {'stamp': _time(stamp_ns), 'frame_id': frame_id}


def _multi_array(data: Sequence[float], dimensions: Iterable[Dimension], offset: int) -> dict:
    labelled = [
        {'label': label, 'size': size, 'stride': stride} for label, size, stride in dimensions
    ]
    return {'layout': {'dim': labelled, 'data_offset': offset}, 'data': data}


def _parameter(name: str, kind: str, value: object) -> dict:
    field = f'{kind}_value'
    return {'name': name, 'value': {'type': PARAMETER_TYPES[kind], field: value}}
