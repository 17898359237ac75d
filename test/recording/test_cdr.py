# SPDX-License-Identifier: Apache-2.0
"""Bytes from a definition text: there and back, and the errors of wrong bytes."""

import math

from hydra_actuator.recording.cdr import CdrError, Codec, codec
from hydra_actuator.recording.messages import (
    DIAGNOSTICS,
    FLOAT32_ARRAY,
    FLOAT64_ARRAY,
    FLUID_PRESSURE,
    JOINT_STATE,
    STRING,
)
from hypothesis import given
from hypothesis import strategies as st
import pytest

TEXT = st.text(st.characters(exclude_categories=['Cs']), max_size=12)
FLOAT = st.floats(width=64)
HEADER = st.fixed_dictionaries({
    'stamp': st.fixed_dictionaries({
        'sec': st.integers(-2**31, 2**31 - 1), 'nanosec': st.integers(0, 2**32 - 1),
    }),
    'frame_id': TEXT,
})
DIMENSION = st.fixed_dictionaries({
    'label': TEXT, 'size': st.integers(0, 2**32 - 1), 'stride': st.integers(0, 2**32 - 1),
})
LAYOUT = st.fixed_dictionaries({
    'dim': st.lists(DIMENSION, max_size=3), 'data_offset': st.integers(0, 2**32 - 1),
})
STATUS = st.fixed_dictionaries({
    'level': st.integers(0, 3), 'name': TEXT, 'message': TEXT, 'hardware_id': TEXT,
    'values': st.lists(st.fixed_dictionaries({'key': TEXT, 'value': TEXT}), max_size=3),
})
MESSAGES = {
    STRING: st.fixed_dictionaries({'data': TEXT}),
    JOINT_STATE: st.fixed_dictionaries({
        'header': HEADER, 'name': st.lists(TEXT, max_size=3),
        'position': st.lists(FLOAT, max_size=3), 'velocity': st.lists(FLOAT, max_size=3),
        'effort': st.lists(FLOAT, max_size=3),
    }),
    FLUID_PRESSURE: st.fixed_dictionaries({
        'header': HEADER, 'fluid_pressure': FLOAT, 'variance': FLOAT,
    }),
    FLOAT64_ARRAY: st.fixed_dictionaries({
        'layout': LAYOUT, 'data': st.lists(FLOAT, max_size=5),
    }),
    FLOAT32_ARRAY: st.fixed_dictionaries({
        'layout': LAYOUT, 'data': st.lists(st.floats(width=32), max_size=5),
    }),
    DIAGNOSTICS: st.fixed_dictionaries({
        'header': HEADER, 'status': st.lists(STATUS, max_size=3),
    }),
}
MESSAGE = st.sampled_from(sorted(MESSAGES)).flatmap(
    lambda name: st.tuples(st.just(name), MESSAGES[name])
)


def plain(value):
    """Return a message as text, fields sorted: NaN then equals NaN."""
    if isinstance(value, dict):
        return str(sorted((name, plain(part)) for name, part in value.items()))
    if isinstance(value, list):
        return str([plain(part) for part in value])
    return repr(value)


@given(MESSAGE)
def test_a_message_comes_back_as_it_went(case):
    type_name, message = case
    decoded = codec(type_name).decode(codec(type_name).encode(message))
    assert plain(decoded) == plain(message)


@given(MESSAGE)
def test_padding_carries_no_meaning(case):
    type_name, message = case
    data = codec(type_name).encode(message, padding=0xFF)
    assert plain(codec(type_name).decode(data)) == plain(message)


@given(MESSAGE, st.data())
def test_a_message_cut_short_is_an_error_or_ends_in_padding(case, data):
    type_name, message = case
    whole = codec(type_name).encode(message)
    cut = whole[: data.draw(st.integers(0, len(whole) - 1))]
    try:
        assert plain(codec(type_name).decode(cut)) == plain(message)
    except CdrError:
        assert len(cut) < len(whole)


def test_big_endian_bytes_are_read():
    data = b'\x00\x00\x00\x00' + b'\x3f\xf8' + bytes(6)
    assert codec('std_msgs/msg/Float64').decode(data) == {'data': 1.5}


def test_bytes_without_a_plain_cdr_header_are_refused():
    with pytest.raises(CdrError, match='header'):
        codec(STRING).decode(b'\x00\x03\x00\x00\x01\x00\x00\x00\x00')


def test_a_length_beyond_the_message_is_refused():
    data = b'\x00\x01\x00\x00' + bytes(8) + b'\xff\xff\xff\x7f' + bytes(4)
    with pytest.raises(CdrError, match='left'):
        codec(FLOAT64_ARRAY).decode(data)


def test_a_misspelt_field_is_named():
    with pytest.raises(CdrError, match='dta'):
        codec(STRING).encode({'dta': 'x'})


def test_a_value_of_the_wrong_kind_is_refused():
    with pytest.raises(CdrError, match='Float64MultiArray'):
        codec(FLOAT64_ARRAY).encode({'data': ['x']})


def test_constants_bounds_and_fixed_arrays_of_a_definition_are_followed():
    text = (
        'byte OK=0  # a constant\nfloat64[3] fixed\nstring<=8 bounded\nint16[<=4] few\n'
        f'Inner inner\n{"=" * 80}\nMSG: own_msgs/Inner\nbool set true\n'
    )
    own = Codec('own_msgs/msg/Outer', text)
    message = {
        'fixed': [1.0, math.inf, -0.0], 'bounded': 'µ', 'few': [-1, 2], 'inner': {'set': True},
    }
    assert own.decode(own.encode(message)) == message
    assert own.decode(own.encode({}))['fixed'] == [0.0, 0.0, 0.0]


def test_a_definition_without_its_dependency_is_refused():
    with pytest.raises(CdrError, match='own_msgs/Missing'):
        Codec('own_msgs/msg/Outer', 'Missing m\n')
