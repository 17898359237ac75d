# SPDX-License-Identifier: Apache-2.0
"""A row becomes the messages the interface promises."""

import math

from hydra_actuator.channels import Channels
from hydra_actuator.recording import messages
from hydra_actuator.recording.tick import AppliedEncoder, FieldEncoder, TickEncoder
from hydra_actuator.recording.topics import ActuatorTopics
import numpy as np
import pytest

STAMP = 1_763_877_600_123_456_789
SECTIONS = ('O', 'tap_2')
JOINTS = ('piston_joint', 'valve_joint', 'valve_joint_2')


def encoded(spools: int, **options) -> tuple[np.ndarray, Channels, dict]:
    """Return a row of distinct values, its channels, and its messages decoded by topic."""
    channels = Channels(SECTIONS, spools)
    row = np.arange(1.0, channels.width + 1.0)
    topics = ActuatorTopics('/ns/actuator', SECTIONS)
    encoder = TickEncoder(channels, JOINTS[: 1 + spools], topics)
    types = {topic.name: topic.type for topic in topics.all()}
    pairs = encoder.encode(row, STAMP, **options)
    return row, channels, {name: messages.decode(types[name], data) for name, data in pairs}


@pytest.mark.parametrize('spools', [1, 2])
def test_joint_state_arrays_are_full_length_with_nan_for_what_a_spool_has_not(spools):
    row, channels, decoded = encoded(spools)
    state = decoded['/ns/joint_states']
    assert state['name'] == list(JOINTS[: 1 + spools])
    assert state['header'] == {
        'stamp': {'sec': 1_763_877_600, 'nanosec': 123_456_789}, 'frame_id': '',
    }
    places = [channels.POSITION, channels.SPOOL_1, channels.SPOOL_2][: 1 + spools]
    assert state['position'] == row[places].tolist()
    assert state['velocity'][0] == row[channels.VELOCITY]
    assert state['effort'][0] == row[channels.EFFORT]
    for array in (state['velocity'], state['effort']):
        assert len(array) == 1 + spools
        assert all(math.isnan(value) for value in array[1:])


def test_each_section_has_its_pressure_topic():
    row, channels, decoded = encoded(1)
    pressures = [decoded[f'/ns/actuator/pressure/{name}'] for name in SECTIONS]
    assert [message['header']['frame_id'] for message in pressures] == list(SECTIONS)
    assert [message['fluid_pressure'] for message in pressures] == (
        row[channels.pressure].tolist())
    assert [message['variance'] for message in pressures] == [0.0, 0.0]


def test_sections_hold_the_stamp_then_pressure_and_velocity_by_section():
    row, channels, decoded = encoded(1)
    message = decoded['/ns/actuator/sections']
    layout, data = message['layout'], message['data']
    assert layout['data_offset'] == 1
    assert layout['dim'] == [
        {'label': 'O,tap_2', 'size': 2, 'stride': 4},
        {'label': 'pressure,velocity', 'size': 2, 'stride': 2},
    ]
    assert data[0] == STAMP / 1e9
    values = np.reshape(data[1:], (2, 2))
    assert (values[:, 0] == row[channels.pressure]).all()
    assert (values[:, 1] == row[channels.flow_velocity]).all()


def test_cavities_are_named_by_the_label_behind_the_stamp():
    channels = Channels(SECTIONS, 1)
    row = np.arange(channels.width, dtype=float)
    encoder = TickEncoder(channels, JOINTS[:2], ActuatorTopics('/a', SECTIONS))
    message = messages.decode(messages.FLOAT64_ARRAY, encoder.cavities(row.tolist(), STAMP))
    assert message['layout']['data_offset'] == 1
    assert message['data'] == [STAMP / 1e9, *row[channels.cavities]]
    names = message['layout']['dim'][0]['label'].split(',')
    assert names[:2] == ['cavity_volume', 'lowest_pressure']
    assert names[-1] == 'cavity_volume.return_line'
    assert len(names) == len(message['data']) - 1


def test_pressures_and_sections_can_be_left_out():
    assert set(encoded(1, pressures=False, sections=False)[2]) == {'/ns/joint_states'}
    assert set(encoded(1, pressures=False)[2]) == {'/ns/joint_states', '/ns/actuator/sections'}


def test_joint_names_that_do_not_match_the_spools_are_refused():
    with pytest.raises(ValueError, match='2 spools'):
        TickEncoder(Channels(SECTIONS, 2), JOINTS[:2], ActuatorTopics('/a', SECTIONS))


def test_applied_commands_name_their_columns():
    data = AppliedEncoder(2).encode(12, (0.5, -1.0), 300.0)
    message = messages.decode(messages.FLOAT64_ARRAY, data)
    assert message['data'] == [12.0, 0.5, -1.0, 300.0]
    assert message['layout']['dim'][0]['label'] == 'tick,spool_1,spool_2,load_force'


def test_field_is_single_precision_behind_the_simulated_time():
    field = np.array([[1e7, 1.5], [math.nan, -2.0]], np.float32)
    message = messages.decode(messages.FLOAT32_ARRAY, FieldEncoder(2).encode(0.25, field))
    assert message['data'][0] == 0.25
    assert np.array_equal(np.reshape(message['data'][1:], (2, 2)), field, equal_nan=True)
    assert [part['size'] for part in message['layout']['dim']] == [2, 2]
    with pytest.raises(ValueError, match='shape'):
        FieldEncoder(3).encode(0.25, field)
