# SPDX-License-Identifier: Apache-2.0
"""A written recording is what rosbag2 would have written, read by readers that are not ours."""

from collections import Counter
import os
import signal
import subprocess
import sys
import tracemalloc

from hydra_actuator.recording import messages
from hydra_actuator.recording.segment import Segment
from hydra_actuator.recording.topics import ActuatorTopics, Topic
from hydra_actuator.recording.writer import RecordingError, RecordingFailure, RecordingWriter
from mcap.reader import make_reader
from mcap.stream_reader import StreamReader
from mcap_ros2.decoder import DecoderFactory
import pytest
from rosbags.interfaces import QosReliability
from rosbags.rosbag2 import Reader
from rosbags.typesys import get_typestore, Stores
import yaml

START = 1_763_877_600_000_000_000
COMMAND = Topic('/actuator/spool_command', messages.FLOAT64, 'best_effort')


def count_in_stream(path) -> Counter:
    """Return the messages by channel that a file gives up to where it ends."""
    counts = Counter()
    with open(path, 'rb') as file:
        try:
            for record in StreamReader(file, skip_magic=False, validate_crcs=True).records:
                if type(record).__name__ == 'Message':
                    counts[record.channel_id] += 1
        except Exception as error:  # its end-of-file error is not public
            assert 'EndOfFile' in repr(error) or 'end' in str(error).lower()
    return counts


@pytest.mark.parametrize('compression', ['none', 'zstd'])
@pytest.mark.parametrize('chunk_size', [1000, 128 * 1024])
def test_rosbags_reads_every_message_as_it_was_written(make_recording, compression, chunk_size):
    made = make_recording(compression=compression, chunk_size=chunk_size)
    written = made.messages()
    with Reader(made.directory) as reader:
        assert reader.message_count == len(written)
        found = [(connection.topic, stamp, bytes(data))
                 for connection, stamp, data in reader.messages()]
    key = [(stamp, topic, data) for topic, stamp, _, data in written]
    assert sorted(key) == sorted((stamp, topic, data) for topic, stamp, data in found)


def test_rosbags_decodes_the_values_with_its_own_definitions(make_recording):
    made = make_recording()
    types = get_typestore(Stores.ROS2_JAZZY)
    positions, pressures = [], []
    with Reader(made.directory) as reader:
        for connection, _, data in reader.messages():
            if connection.topic == made.topics.joint_states:
                positions.append(types.deserialize_cdr(data, connection.msgtype).position[0])
            if connection.topic == made.topics.pressure['K']:
                message = types.deserialize_cdr(data, connection.msgtype)
                pressures.append((message.header.frame_id, message.fluid_pressure))
    channels = made.channels
    assert positions == made.rows[:, channels.POSITION].tolist()
    expected = made.rows[:, channels.pressure][:, 2].tolist()
    assert pressures == [('K', pressure) for pressure in expected]


def test_rosbags_finds_types_hashes_and_qualities(make_recording):
    made = make_recording()
    types = get_typestore(Stores.ROS2_JAZZY)
    with Reader(made.directory) as reader:
        assert reader.start_time == made.stamps[0]
        assert reader.end_time - reader.start_time == made.stamps[-1] - made.stamps[0] + 1
        by_topic = {connection.topic: connection for connection in reader.connections}
        assert reader.ros_distro == 'jazzy'
    assert {name: by_topic[name].msgtype for name in by_topic} == {
        topic.name: topic.type for topic in made.topics.all()}
    for connection in by_topic.values():
        assert connection.digest == types.hash_rihs01(connection.msgtype)
        (quality,) = connection.ext.offered_qos_profiles
        assert quality.reliability == QosReliability.RELIABLE
        assert (quality.depth, quality.deadline.sec) == (10, 9223372036)


def test_mcap_ros2_support_decodes_by_the_schemas_in_the_file(make_recording):
    made = make_recording()
    with open(made.directory / 'run_0.mcap', 'rb') as file:
        reader = make_reader(file, validate_crcs=True, decoder_factories=[DecoderFactory()])
        seen = Counter()
        for _, channel, message, decoded in reader.iter_decoded_messages():
            seen[channel.topic] += 1
            if channel.topic == made.topics.joint_states:
                tick = (message.log_time - made.stamps[0]) // 1_000_000
                assert message.publish_time == message.log_time + 20_000
                assert decoded.position[0] == made.rows[tick, made.channels.POSITION]
    assert seen == Counter(topic for topic, *_ in made.messages())


def test_the_file_is_of_profile_ros2_and_carries_the_metadata_records(make_recording):
    made = make_recording()
    with open(made.directory / 'run_0.mcap', 'rb') as file:
        reader = make_reader(file)
        header, summary = reader.get_header(), reader.get_summary()
        records = {record.name: record.metadata for record in reader.iter_metadata()}
    assert header.profile == 'ros2'
    assert header.library.startswith('hydra_actuator ')
    assert summary.statistics.message_count == len(made.messages())
    assert summary.statistics.message_start_time == made.stamps[0]
    assert summary.statistics.message_end_time == made.stamps[-1]
    assert summary.statistics.chunk_count == len(summary.chunk_indexes)
    for channel in summary.channels.values():
        assert set(channel.metadata) == {'offered_qos_profiles', 'topic_type_hash'}
        assert channel.message_encoding == 'cdr'
    assert {schema.encoding for schema in summary.schemas.values()} == {'ros2msg'}
    outside = yaml.safe_load((made.directory / 'metadata.yaml').read_text('utf-8'))
    inside = yaml.safe_load(records['rosbag2']['serialized_metadata'])
    assert inside == outside['rosbag2_bagfile_information']
    assert 'ros__parameters' in records['hydra_actuator']['parameters']


def test_metadata_holds_the_fields_of_version_9(make_recording):
    made = make_recording()
    text = (made.directory / 'metadata.yaml').read_text('utf-8')
    information = yaml.safe_load(text)['rosbag2_bagfile_information']
    assert list(information) == [
        'version', 'storage_identifier', 'duration', 'starting_time', 'message_count',
        'topics_with_message_count', 'compression_format', 'compression_mode',
        'relative_file_paths', 'files', 'custom_data', 'ros_distro',
    ]
    assert information['version'] == 9
    assert information['storage_identifier'] == 'mcap'
    assert information['relative_file_paths'] == ['run_0.mcap']
    counts = {entry['topic_metadata']['name']: entry['message_count']
              for entry in information['topics_with_message_count']}
    written = Counter(topic for topic, *_ in made.messages())
    assert counts == {topic.name: written[topic.name] for topic in made.topics.all()}
    assert information['message_count'] == sum(counts.values())
    assert 'supply' in information['custom_data']['parameters']


def test_metadata_exists_from_the_start_and_counts_at_each_flush(tmp_path):
    def count():
        text = (tmp_path / 'run' / 'metadata.yaml').read_text('utf-8')
        return yaml.safe_load(text)['rosbag2_bagfile_information']['message_count']

    with RecordingWriter(tmp_path / 'run', [COMMAND], flush_period=1e9) as writer:
        assert count() == 0
        writer.write(COMMAND.name, 5, 6, messages.float64(1.0))
        assert count() == 0
        writer.flush()
        assert count() == 1
        assert sorted(os.listdir(tmp_path / 'run')) == ['metadata.yaml', 'run_0.mcap']


def test_statistics_count_messages_and_bytes(tmp_path):
    with RecordingWriter(tmp_path / 'run', [COMMAND], flush_period=0.0) as writer:
        for stamp in range(3):
            writer.write(COMMAND.name, stamp, stamp, messages.float64(1.0))
        assert writer.statistics.messages == {COMMAND.name: 3}
        assert writer.statistics.bytes == (tmp_path / 'run' / 'run_0.mcap').stat().st_size


def test_a_recording_without_messages_is_readable(tmp_path):
    RecordingWriter(tmp_path / 'run', ActuatorTopics().all()).close()
    with Reader(tmp_path / 'run') as reader:
        assert reader.message_count == 0
        assert len(reader.connections) == len(ActuatorTopics().all())


@pytest.mark.parametrize('kind', ['directory', 'file', 'dangling link'])
def test_nothing_is_ever_overwritten(tmp_path, kind):
    target = tmp_path / 'run'
    if kind == 'directory':
        target.mkdir()
    elif kind == 'file':
        target.write_text('mine')
    else:
        target.symlink_to(tmp_path / 'nowhere')
    before = sorted(os.listdir(tmp_path))
    with pytest.raises(RecordingError, match='run exists already'):
        RecordingWriter(target, [COMMAND])
    assert sorted(os.listdir(tmp_path)) == before
    assert kind != 'file' or target.read_text() == 'mine'


def test_a_path_through_a_file_is_refused(tmp_path):
    (tmp_path / 'file').write_text('mine')
    with pytest.raises(RecordingError, match='file'):
        RecordingWriter(tmp_path / 'file' / 'run', [COMMAND])


@pytest.mark.parametrize('name, culprit', [
    ('x' * 300, 'name too long'), ('x' * 252, 'name too long'), (os.fsdecode(b'a\xff'), 'UTF-8'),
])
def test_a_name_no_file_can_have_leaves_nothing_behind(tmp_path, name, culprit):
    with pytest.raises((RecordingError, RecordingFailure), match=culprit):
        RecordingWriter(tmp_path / 'new' / 'run' / name, [COMMAND])
    assert os.listdir(tmp_path) == []


def test_an_unknown_compression_leaves_nothing_behind(tmp_path):
    with pytest.raises(RecordingError, match='lz5'):
        RecordingWriter(tmp_path / 'run', [COMMAND], compression='lz5')
    assert os.listdir(tmp_path) == []


def test_a_topic_given_twice_is_one_and_two_of_one_name_are_refused(tmp_path):
    other = Topic(COMMAND.name, messages.STRING)
    with pytest.raises(RecordingError, match='spool_command'):
        RecordingWriter(tmp_path / 'run', [COMMAND, other])
    with pytest.raises(RecordingError, match='Wrench'):
        RecordingWriter(tmp_path / 'run', [Topic('/a', 'geometry_msgs/msg/Wrench')])
    assert os.listdir(tmp_path) == []
    with RecordingWriter(tmp_path / 'run', [COMMAND, COMMAND]) as writer:
        writer.write(COMMAND.name, 1, 1, messages.float64(1.0))
    with Reader(tmp_path / 'run') as reader:
        assert [(c.topic, c.msgcount) for c in reader.connections] == [(COMMAND.name, 1)]


def test_a_strange_topic_and_a_negative_time_are_refused_and_cost_nothing_else(tmp_path):
    with RecordingWriter(tmp_path / 'run', [COMMAND]) as writer:
        writer.write(COMMAND.name, 1, 1, messages.float64(1.0))
        with pytest.raises(RecordingError, match='/other'):
            writer.write('/other', 2, 2, b'')
        with pytest.raises(RecordingError, match='time'):
            writer.write(COMMAND.name, -1, 2, messages.float64(1.0))
        writer.write(COMMAND.name, 3, 3, messages.float64(2.0))
    with Reader(tmp_path / 'run') as reader:
        assert [stamp for _, stamp, _ in reader.messages()] == [1, 3]


def test_a_full_disk_is_named(tmp_path):
    writer = RecordingWriter(tmp_path / 'run', [COMMAND], flush_period=0.0)
    segment = writer._files.open
    segment._file.close()
    segment._file = open('/dev/full', 'wb', buffering=0)
    with pytest.raises(RecordingFailure, match='No space left'):
        writer.write(COMMAND.name, 1, 1, messages.float64(1.0))


def test_a_killed_writer_leaves_all_it_flushed(tmp_path):
    code = (
        'import sys, time\n'
        'from hydra_actuator.recording.writer import RecordingWriter\n'
        'from hydra_actuator.recording.topics import Topic\n'
        'from hydra_actuator.recording import messages\n'
        'topic = Topic("/a", messages.FLOAT64)\n'
        'writer = RecordingWriter(sys.argv[1], [topic], {"source": "node"}, flush_period=1e9,\n'
        '                         chunk_size=500)\n'
        'for stamp in range(1000):\n'
        '    writer.write("/a", stamp, stamp, messages.float64(stamp))\n'
        'writer.flush()\n'
        'for stamp in range(7):\n'
        '    writer.write("/a", 1000 + stamp, stamp, messages.float64(stamp))\n'
        'print("flushed", flush=True)\n'
        'time.sleep(60)\n'
    )
    process = subprocess.Popen(
        [sys.executable, '-c', code, str(tmp_path / 'run')], stdout=subprocess.PIPE, text=True
    )
    assert process.stdout.readline() == 'flushed\n'
    process.send_signal(signal.SIGKILL)
    process.wait()
    process.stdout.close()
    assert count_in_stream(tmp_path / 'run' / 'run_0.mcap') == {1: 1000}
    text = (tmp_path / 'run' / 'metadata.yaml').read_text('utf-8')
    information = yaml.safe_load(text)['rosbag2_bagfile_information']
    assert information['message_count'] == 1000
    assert information['custom_data'] == {'source': 'node'}


def test_a_chunk_leaves_only_its_index_in_memory(tmp_path):
    topics = [Topic(f'/t{number}', messages.FLOAT64) for number in range(20)]
    batch = [(topic.name, START, START, messages.float64(1.0)) for topic in topics]
    segment = Segment(tmp_path / 'run_0.mcap', topics, {})
    chunks, held = 300, []
    tracemalloc.start()
    try:
        for _ in range(3):
            for _ in range(chunks):
                segment.write(batch)
                segment.end_chunk()
            held.append(tracemalloc.get_traced_memory()[0])
    finally:
        tracemalloc.stop()
        segment.close()
    # In the file, an index takes 10 bytes for each channel and 77 besides.
    assert (held[2] - held[0]) / (2 * chunks) < 1.5 * (10 * len(topics) + 77)
    with open(segment.path, 'rb') as file:
        indexes = make_reader(file).get_summary().chunk_indexes
    assert len(indexes) == 3 * chunks
    assert all(len(index.message_index_offsets) == len(topics) for index in indexes)
