# SPDX-License-Identifier: Apache-2.0
"""Our bytes are rclpy's bytes, padding aside, over the values that trip an encoder."""

import math

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from hydra_actuator.recording import messages
from hydra_actuator.recording.cdr import codec
from hypothesis import given, settings
from hypothesis import strategies as st
import pytest
from rcl_interfaces.msg import Parameter, ParameterEvent, ParameterValue
from rclpy.serialization import deserialize_message, serialize_message
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import FluidPressure, JointState
from std_msgs.msg import (
    Float32MultiArray,
    Float64,
    Float64MultiArray,
    MultiArrayDimension,
    String,
)

NAN, INF = math.nan, math.inf
STAMP = 1_763_877_600_123_456_789
EDGE_VALUES = [0.0, -0.0, 1.5, -1e308, 5e-324, INF, -INF, NAN]
TEXTS = ['', 'a', 'abc', 'abcd', 'piston_joint', 'Öl µ 油 🛢']


def at(stamp_ns, header):
    """Set the stamp of a ROS header and return it."""
    header.stamp.sec, header.stamp.nanosec = divmod(stamp_ns, 10**9)
    return header


def assert_same_bytes(type_name: str, ours: bytes, ros_message) -> None:
    """
    Compare with rclpy wherever a byte has a meaning.

    Fast CDR leaves in the padding, and behind a message whose size it estimated too high, what
    was in memory before; a second encoding with another padding shows where that is.
    """
    theirs = serialize_message(ros_message)
    decoded = codec(type_name).decode(ours)
    other = codec(type_name).encode(decoded, padding=0xFF)
    assert len(ours) == len(other) <= len(theirs)
    meant = [place for place in range(len(ours)) if ours[place] == other[place]]
    assert [ours[place] for place in meant] == [theirs[place] for place in meant]
    assert not any(ours[place] for place in set(range(len(ours))) - set(meant))
    again = deserialize_message(ours, type(ros_message))
    assert repr(again) == repr(ros_message)


@pytest.mark.parametrize('value', EDGE_VALUES)
def test_float64_is_that_of_rclpy(value):
    assert_same_bytes(messages.FLOAT64, messages.float64(value), Float64(data=value))


@pytest.mark.parametrize('text', TEXTS)
def test_string_is_that_of_rclpy(text):
    assert_same_bytes(messages.STRING, messages.string(text), String(data=text))


@pytest.mark.parametrize('stamp_ns', [0, 1, 999_999_999, 10**9, STAMP, 2**31 * 10**9 - 1])
def test_clock_is_that_of_rclpy(stamp_ns):
    message = Clock()
    message.clock.sec, message.clock.nanosec = divmod(stamp_ns, 10**9)
    assert_same_bytes(messages.CLOCK, messages.clock(stamp_ns), message)


@settings(deadline=None)
@given(st.lists(st.sampled_from(TEXTS), max_size=3), st.lists(st.floats(), max_size=4),
       st.lists(st.floats(), max_size=4))
def test_joint_state_is_that_of_rclpy(names, position, effort):
    message = JointState(name=names, position=position, velocity=effort[:2], effort=effort)
    at(STAMP, message.header)
    ours = messages.joint_state(STAMP, names, position, effort[:2], effort)
    assert_same_bytes(messages.JOINT_STATE, ours, message)


@settings(deadline=None)
@given(st.lists(st.sampled_from(TEXTS), min_size=1, max_size=4),
       st.integers(0, 2**31 * 10**9 - 1))
def test_joint_state_encoder_agrees_with_the_plain_function(names, stamp_ns):
    values = EDGE_VALUES[: len(names)]
    encoder = messages.JointStateEncoder(names)
    expected = messages.joint_state(stamp_ns, names, values, values[::-1], values)
    assert encoder.encode(stamp_ns, values, values[::-1], values) == expected


@pytest.mark.parametrize('frame_id', TEXTS)
def test_fluid_pressure_is_that_of_rclpy(frame_id):
    message = FluidPressure(fluid_pressure=2.1e7, variance=NAN)
    at(STAMP, message.header).frame_id = frame_id
    ours = messages.FluidPressureEncoder(frame_id).encode(STAMP, 2.1e7, NAN)
    assert ours == messages.fluid_pressure(STAMP, frame_id, 2.1e7, NAN)
    assert_same_bytes(messages.FLUID_PRESSURE, ours, message)


@pytest.mark.parametrize('label', TEXTS)
@pytest.mark.parametrize('data', [[], [1.0], EDGE_VALUES])
def test_multi_arrays_are_those_of_rclpy(label, data):
    single = [value for value in data if abs(value) < 1e38 or not math.isfinite(value)]
    dimensions = [(label, 4, 8), ('pressure,velocity', 2, 2)]
    for type_name, message_class, values, is_single in (
        (messages.FLOAT64_ARRAY, Float64MultiArray, data, False),
        (messages.FLOAT32_ARRAY, Float32MultiArray, single, True),
    ):
        message = message_class(data=values)
        message.layout.data_offset = 1
        message.layout.dim = [
            MultiArrayDimension(label=name, size=size, stride=stride)
            for name, size, stride in dimensions
        ]
        encoder = messages.MultiArrayEncoder(len(values), dimensions, 1, is_single)
        assert_same_bytes(type_name, encoder.encode(values), message)


def test_multi_array_takes_values_as_ready_bytes():
    encoder = messages.MultiArrayEncoder(2)
    assert encoder.encode_buffer(messages.float64(1.5)[4:] * 2) == encoder.encode([1.5, 1.5])


@pytest.mark.parametrize('text', TEXTS)
def test_diagnostic_array_is_that_of_rclpy(text):
    message = DiagnosticArray(status=[
        DiagnosticStatus(level=bytes([level]), name=text, message=text[:1], hardware_id='h',
                         values=[KeyValue(key=text, value='1')] * level)
        for level in range(4)
    ])
    at(STAMP, message.header)
    ours = messages.diagnostic_array(STAMP, [
        (level, text, text[:1], 'h', {text: '1'} if level else {}) for level in range(2)
    ])
    message.status = message.status[:2]
    assert_same_bytes(messages.DIAGNOSTICS, ours, message)


@pytest.mark.parametrize(('kind', 'value'), [
    ('bool', True), ('integer', -2**63), ('double', NAN), ('string', 'Öl'),
    ('bool_array', [True, False]), ('integer_array', [1, 2, 3]), ('double_array', [INF]),
    ('double_array', []), ('string_array', ['q', '', 'ö']),
])
def test_parameter_event_is_that_of_rclpy(kind, value):
    number = messages.PARAMETER_TYPES[kind]
    parameter = Parameter(
        name='a.b', value=ParameterValue(type=number, **{f'{kind}_value': value})
    )
    message = ParameterEvent(
        node='/ns/actuator', new_parameters=[parameter], changed_parameters=[parameter] * 2
    )
    message.stamp.sec, message.stamp.nanosec = divmod(STAMP, 10**9)
    given_as = ('a.b', kind, value)
    ours = messages.parameter_event(STAMP, '/ns/actuator', [given_as] * 2, [given_as])
    assert_same_bytes(messages.PARAMETER_EVENT, ours, message)


def test_the_messages_of_every_tick_have_the_length_rclpy_gives_them():
    joints = JointState(name=['a', 'b'], position=[0.0, 1.0], velocity=[0.0, 1.0],
                        effort=[0.0, NAN])
    encoder = messages.JointStateEncoder(['a', 'b'])
    assert len(encoder.encode(0, [0, 1], [0, 1], [0, 1])) == len(serialize_message(joints))
    pressure = FluidPressure()
    pressure.header.frame_id = 'chamber_1'
    encoder = messages.FluidPressureEncoder('chamber_1')
    assert len(encoder.encode(0, 1.0)) == len(serialize_message(pressure))


def test_a_message_of_rclpy_is_decoded():
    message = JointState(name=['p'], position=[1.5], velocity=[-INF], effort=[])
    at(STAMP, message.header).frame_id = 'O'
    assert messages.decode(messages.JOINT_STATE, serialize_message(message)) == {
        'header': {'stamp': {'sec': 1_763_877_600, 'nanosec': 123_456_789}, 'frame_id': 'O'},
        'name': ['p'], 'position': [1.5], 'velocity': [-INF], 'effort': [],
    }
