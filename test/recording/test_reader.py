# SPDX-License-Identifier: Apache-2.0
"""What was written comes back as arrays, from whole, cut-off and foreign files."""

import shutil

from hydra_actuator import load_recording
from hydra_actuator.recording import messages
from hydra_actuator.recording.definitions import definition
from hydra_actuator.recording.errors import RecordingError
from hydra_actuator.recording.tick import AppliedEncoder
from hydra_actuator.recording.topics import ActuatorTopics, Topic
from hydra_actuator.recording.writer import RecordingWriter
from mcap.reader import make_reader
from mcap.writer import CompressionType, IndexType, Writer
import numpy as np
import pytest
from rclpy.serialization import serialize_message
from sensor_msgs.msg import JointState


def assert_rows_are_those_made(recording, made) -> None:
    """Compare all that topics carry; the rest is known to be NaN or derived."""
    channels, count = made.channels, len(recording.rows)
    rows, expected = recording.rows, made.rows[:count]
    carried = [channels.TIME, channels.POSITION, channels.VELOCITY, channels.EFFORT,
               channels.SPOOL_1]
    carried += [channels.SPOOL_2] * (channels.spools == 2)
    assert np.array_equal(rows[:, carried], expected[:, carried])
    assert np.array_equal(rows[:, channels.pressure], expected[:, channels.pressure])
    assert np.array_equal(rows[:, channels.flow_velocity], expected[:, channels.flow_velocity])
    assert np.array_equal(rows[:, channels.cavities], expected[:, channels.cavities])
    assert np.isnan(rows[:, channels.MACH]).all()


@pytest.mark.parametrize('options', [
    {}, {'compression': 'zstd'}, {'chunk_size': 1}, {'spools': 2}, {'ticks': 1},
])
def test_rows_come_back_bit_for_bit(make_recording, options):
    made = make_recording(**options)
    recording = load_recording(made.directory)
    assert recording.finished
    assert recording.channels.section_names == made.channels.section_names
    assert recording.channels.spools == made.channels.spools
    assert np.array_equal(recording.row_stamps, made.stamps)
    assert np.array_equal(recording.time, made.rows[:, made.channels.TIME])
    assert_rows_are_those_made(recording, made)


def test_cavities_come_back_with_their_stamps(make_recording):
    made = make_recording()
    stamps, values = load_recording(made.directory).cavities
    assert np.array_equal(stamps, made.stamps)
    assert np.array_equal(values, made.rows[:, made.channels.cavities])


def test_one_spool_stands_in_both_spool_columns(make_recording):
    recording = load_recording(make_recording().directory)
    channels = recording.channels
    rows = recording.rows
    assert np.array_equal(rows[:, channels.SPOOL_1], rows[:, channels.SPOOL_2])


def test_load_is_the_last_applied_one(make_recording):
    recording = load_recording(make_recording().directory)
    loads = recording.rows[:, recording.channels.LOAD_FORCE]
    assert np.array_equal(loads, [5.0 * (tick // 10 * 10) for tick in range(50)])


def test_field_comes_back_with_its_nodes(make_recording):
    made = make_recording()
    recording = load_recording(made.directory)
    assert recording.field.dtype == np.float32
    assert np.array_equal(recording.field, made.fields[:10], equal_nan=True)
    assert np.array_equal(recording.field_time, recording.time[::5])
    assert recording.field_positions.shape == (recording.field.shape[1],)
    assert recording.field_labels == ['supply_line'] * 7
    assert recording.section_positions.tolist() == [0.0, 0.6, 2.0]


def test_commands_applied_and_diagnostics_come_back(make_recording):
    made = make_recording()
    recording = load_recording(made.directory)
    stamps, values = recording.commands['/ns/actuator/spool_command']
    assert np.array_equal(stamps, made.stamps[::10])
    assert np.array_equal(values[:, 0], np.arange(0, 50, 10) / 1000.0)
    stamps, values = recording.applied
    assert np.array_equal(values[:, 0], np.arange(0, 50, 10))
    (message,) = recording.diagnostics
    assert message['topic'] == '/diagnostics'
    assert message['status'][0]['name'] == '/ns/actuator: Solver'
    assert recording.series(made.topics.joint_states).publish_stamps[0] == made.stamps[0] + 20_000


def test_topics_times_and_run_data_are_listed(make_recording):
    made = make_recording()
    recording = load_recording(made.directory)
    assert recording.topics['/ns/joint_states'].count == 50
    assert recording.topics['/ns/joint_states'].type == messages.JOINT_STATE
    assert recording.topics['/ns/actuator/commands'].count == 0
    assert (recording.start_ns, recording.end_ns) == (made.stamps[0], made.stamps[-1])
    assert recording.custom_data['source'] == 'simulate'
    assert recording.joint_names == ['piston_joint', 'valve_joint']


def test_any_topic_is_read_as_dictionaries(make_recording):
    made = make_recording()
    recording = load_recording(made.directory)
    positions = [message['position'][0] for message in recording.messages('/ns/joint_states')]
    assert positions == made.rows[:, made.channels.POSITION].tolist()
    with pytest.raises(RecordingError, match='/nothing'):
        recording.messages('/nothing')


def test_slower_pressures_leave_nan_between(tmp_path):
    topics = ActuatorTopics('/actuator', ('A',))
    joints = messages.JointStateEncoder(['p', 'v'])
    pressure = messages.FluidPressureEncoder('A')
    with RecordingWriter(tmp_path / 'run', topics.all()) as writer:
        for stamp in range(6):
            writer.write(topics.joint_states, stamp, stamp,
                         joints.encode(stamp, [1.0, 2.0], [3.0, 4.0], [5.0, 6.0]))
            if stamp % 2:
                writer.write(topics.pressure['A'], stamp, stamp, pressure.encode(stamp, 7.0))
    recording = load_recording(tmp_path / 'run')
    pressures = recording.rows[:, recording.channels.pressure][:, 0]
    assert np.array_equal(pressures, [np.nan, 7, np.nan, 7, np.nan, 7], equal_nan=True)
    assert np.isnan(recording.rows[:, recording.channels.flow_velocity]).all()
    assert np.isnan(recording.rows[:, recording.channels.cavities]).all()
    assert recording.field.shape[0] == 0


def test_an_empty_recording_has_empty_arrays(tmp_path):
    RecordingWriter(tmp_path / 'run', ActuatorTopics('/actuator', ('A',)).all()).close()
    recording = load_recording(tmp_path / 'run')
    assert recording.rows.shape == (0, recording.channels.width)
    assert recording.time.shape == (0,)
    assert recording.field.shape[0] == recording.field_time.shape[0] == 0
    assert recording.applied[1].shape[0] == 0
    assert recording.cavities[1].shape == (0, len(recording.channels.cavity_names()))
    assert recording.commands == {}
    assert recording.diagnostics == []
    assert (recording.start_ns, recording.end_ns) == (0, 0)


def test_commands_of_changing_length_and_foreign_padding_are_read(tmp_path):
    topics = [Topic('/actuator/commands', messages.FLOAT64_ARRAY),
              Topic('/joint_commands', messages.JOINT_STATE)]
    with RecordingWriter(tmp_path / 'run', topics) as writer:
        for stamp, data in enumerate([[1.0], [2.0, 3.0], []]):
            writer.write('/actuator/commands', stamp, stamp, messages.float64_multi_array(data))
            command = serialize_message(JointState(name=['v'], position=data[:1]))
            writer.write('/joint_commands', stamp, stamp, command)
    commands = load_recording(tmp_path / 'run').commands
    values = commands['/actuator/commands'][1]
    nan = np.nan
    assert np.array_equal(values, [[1.0, nan], [2.0, 3.0], [nan, nan]], equal_nan=True)
    assert np.array_equal(commands['/joint_commands'][1], [[1.0], [2.0], [nan]], equal_nan=True)


def test_a_joint_that_changes_its_name_is_not_taken_for_one_layout(tmp_path):
    topic = Topic('/joint_commands', messages.JOINT_STATE)
    with RecordingWriter(tmp_path / 'run', [topic]) as writer:
        for stamp, name in enumerate(['v', 'w']):
            data = messages.joint_state(stamp, [name], [1.0 + stamp], [0.0], [0.0])
            writer.write(topic.name, stamp, stamp, data)
    recording = load_recording(tmp_path / 'run')
    assert [message['name'] for message in recording.messages(topic.name)] == [['v'], ['w']]
    assert recording.commands[topic.name][1][:, 0].tolist() == [1.0, 2.0]


@pytest.mark.parametrize('chunk_size', [700, 128 * 1024])
def test_a_file_cut_anywhere_opens_up_to_there(make_recording, tmp_path, chunk_size):
    made = make_recording(chunk_size=chunk_size)
    whole = (made.directory / 'run_0.mcap').read_bytes()
    counts = []
    for size in range(9, len(whole), 211):
        cut = tmp_path / 'cut.mcap'
        cut.write_bytes(whole[:size])
        recording = load_recording(cut)
        assert not recording.finished
        assert_rows_are_those_made_as_far_as_they_go(recording, made)
        counts.append(len(recording.row_stamps))
    assert counts == sorted(counts)
    assert counts[-1] == 50


def assert_rows_are_those_made_as_far_as_they_go(recording, made) -> None:
    count = len(recording.row_stamps)
    assert np.array_equal(recording.row_stamps, made.stamps[:count])
    places = [made.channels.POSITION, made.channels.EFFORT]
    if count:
        assert np.array_equal(recording.rows[:, places], made.rows[:count, places])


def test_a_recording_that_is_still_written_opens(tmp_path):
    topics = ActuatorTopics('/actuator', ('A',))
    with RecordingWriter(tmp_path / 'run', topics.all(), {'source': 'node'}) as writer:
        writer.write(topics.applied, 5, 5, AppliedEncoder(1).encode(0, [0.5], 1.0))
        writer.flush()
        recording = load_recording(tmp_path / 'run')
        assert not recording.finished
        assert recording.applied[1].tolist() == [[0.0, 0.5, 1.0]]
        assert recording.custom_data == {'source': 'node'}


def test_a_lone_file_keeps_its_run_data(make_recording, tmp_path):
    made = make_recording()
    shutil.move(made.directory / 'run_0.mcap', tmp_path / 'lone.mcap')
    recording = load_recording(tmp_path / 'lone.mcap')
    assert recording.custom_data['source'] == 'simulate'
    assert_rows_are_those_made(recording, made)


@pytest.mark.parametrize('options', [
    {'use_chunking': False, 'index_types': IndexType.NONE},
    {'compression': CompressionType.LZ4},
    {'compression': CompressionType.ZSTD, 'index_types': IndexType.NONE,
     'repeat_channels': False, 'repeat_schemas': False},
])
def test_a_file_of_another_writer_is_read(make_recording, tmp_path, options):
    made = make_recording()
    types = {topic.name: topic.type for topic in made.topics.all()}
    channels = {}
    with open(tmp_path / 'other.mcap', 'wb') as file:
        writer = Writer(file, chunk_size=4096, **options)
        writer.start('ros2')
        for topic, log_ns, publish_ns, data in made.messages():
            if topic not in channels:
                text = definition(types[topic]).encode()
                schema = writer.register_schema(types[topic], 'ros2msg', text)
                channels[topic] = writer.register_channel(topic, 'cdr', schema)
            writer.add_message(channels[topic], log_ns, data, publish_ns)
        writer.finish()
    recording = load_recording(tmp_path / 'other.mcap')
    assert recording.finished
    assert_rows_are_those_made(recording, made)


def test_a_flipped_bit_is_found(make_recording):
    made = make_recording()
    path = made.directory / 'run_0.mcap'
    content = bytearray(path.read_bytes())
    content[-len(content) // 2] ^= 1
    path.write_bytes(content)
    with pytest.raises(RecordingError, match='damaged'):
        load_recording(made.directory)


@pytest.mark.parametrize('offset', [1, 2**40])
def test_an_index_that_points_astray_is_found(make_recording, offset):
    made = make_recording()
    path = made.directory / 'run_0.mcap'
    content = bytearray(path.read_bytes())
    with open(path, 'rb') as file:
        (chunk,) = make_reader(file).get_summary().chunk_indexes
    entry = chunk.message_index_offsets[1] + 9 + 2 + 4 + 8
    content[entry: entry + 8] = offset.to_bytes(8, 'little')
    path.write_bytes(content)
    with pytest.raises(RecordingError, match='points'):
        load_recording(made.directory).rows  # noqa: B018


def test_a_file_that_the_metadata_do_not_list_yet_is_read(make_recording):
    made = make_recording(ticks=10)
    for number in (1, 2, 10):
        shutil.copy(made.directory / 'run_0.mcap', made.directory / f'run_{number}.mcap')
    recording = load_recording(made.directory)
    assert [path.name for path in recording.files] == [
        'run_0.mcap', 'run_1.mcap', 'run_2.mcap', 'run_10.mcap']
    assert len(recording.rows) == 40


@pytest.mark.parametrize('compression', ['none', 'zstd'])
def test_bits_flipped_anywhere_are_refused_or_do_no_harm(make_recording, tmp_path, compression):
    made = make_recording(ticks=10, compression=compression)
    content = (made.directory / 'run_0.mcap').read_bytes()
    lone = tmp_path / 'lone.mcap'
    for place in range(9, len(content), len(content) // 60):
        flipped = bytearray(content)
        flipped[place] ^= 16
        lone.write_bytes(flipped)
        try:
            assert load_recording(lone).rows.shape[0] <= 10
        except RecordingError as error:
            assert 'lone.mcap' in str(error) or 'damaged' in str(error)


def test_what_is_no_recording_is_named(tmp_path, make_recording):
    with pytest.raises(RecordingError, match='nowhere does not exist'):
        load_recording(tmp_path / 'nowhere')
    with pytest.raises(RecordingError, match='no metadata'):
        load_recording(tmp_path)
    text = tmp_path / 'text.mcap'
    text.write_text('this is not it')
    with pytest.raises(RecordingError, match=r'text\.mcap is not an MCAP file'):
        load_recording(text)
    text.write_text('')
    with pytest.raises(RecordingError, match=r'text\.mcap is not an MCAP file'):
        load_recording(text)
    made = make_recording()
    (made.directory / 'run_0.mcap').unlink()
    with pytest.raises(RecordingError, match=r'run_0\.mcap'):
        load_recording(made.directory)
