# SPDX-License-Identifier: Apache-2.0
"""Files that end by size and time, and a disk with too little left."""

import shutil
import time
from types import SimpleNamespace

from hydra_actuator.recording import messages
from hydra_actuator.recording.limits import Limits
from hydra_actuator.recording.queue import QueuedWriter
from hydra_actuator.recording.reader import load_recording
from hydra_actuator.recording.recovery import recover
from hydra_actuator.recording.topics import Topic
from hydra_actuator.recording.writer import RecordingError, RecordingFailure, RecordingWriter
from mcap.reader import make_reader
import pytest
from rosbags.rosbag2 import Reader
import yaml

TOPICS = [Topic('/a', messages.FLOAT64), Topic('/b', messages.FLOAT64)]
MILLISECOND = 1_000_000
COUNT = 4000


def written(directory, **options):
    """Write COUNT messages of alternating topics, a millisecond apart; return them."""
    sent = [(TOPICS[k % 2].name, k * MILLISECOND, k * MILLISECOND, messages.float64(k))
            for k in range(COUNT)]
    with RecordingWriter(directory, TOPICS, {'source': 'node'}, **options) as writer:
        for first in range(0, COUNT, 14):
            writer.write_batch(sent[first:first + 14])
    return sent


def files_of(directory):
    return sorted(directory.glob('*.mcap'), key=lambda path: int(path.stem.split('_')[-1]))


@pytest.fixture(params=['size', 'duration'])
def split(request, tmp_path):
    """Return a recording in several files, and what was written."""
    how = {'size': Limits(split_size=60_000), 'duration': Limits(split_duration=0.9)}
    sent = written(tmp_path / 'run', limits=how[request.param], chunk_size=5000)
    return tmp_path / 'run', sent


def test_the_files_together_hold_every_message_once_and_in_order(split):
    directory, sent = split
    with Reader(directory) as reader:
        assert reader.message_count == COUNT
        found = [(connection.topic, stamp, bytes(data))
                 for connection, stamp, data in reader.messages()]
    assert found == [(topic, stamp, data) for topic, stamp, _, data in sent]
    recording = load_recording(directory)
    assert len(recording.files) > 3
    assert recording.finished
    assert list(recording.series('/a').numbers()[:, 0]) == list(range(0, COUNT, 2))


def test_each_file_opens_alone_and_counts_from_zero(split):
    directory, _ = split
    total = 0
    for path in files_of(directory):
        with path.open('rb') as file:
            reader = make_reader(file, validate_crcs=True)
            summary = reader.get_summary()
            sequences = {'/a': [], '/b': []}
            for _, channel, message in reader.iter_messages():
                sequences[channel.topic].append(message.sequence)
            for numbers in sequences.values():
                assert numbers == list(range(len(numbers)))
            records = {record.name: record.metadata for record in reader.iter_metadata()}
        alone = yaml.safe_load(records['rosbag2']['serialized_metadata'])
        assert alone['relative_file_paths'] == [path.name]
        assert alone['message_count'] == summary.statistics.message_count
        assert alone['custom_data'] == {'source': 'node'}
        assert load_recording(path).custom_data == {'source': 'node'}
        total += summary.statistics.message_count
    assert total == COUNT


def test_metadata_lists_all_files_with_their_own_times(split):
    directory, _ = split
    information = yaml.safe_load((directory / 'metadata.yaml').read_text('utf-8'))
    information = information['rosbag2_bagfile_information']
    paths = [path.name for path in files_of(directory)]
    assert information['relative_file_paths'] == paths
    assert [file['path'] for file in information['files']] == paths
    assert sum(file['message_count'] for file in information['files']) == COUNT
    starts = [file['starting_time']['nanoseconds_since_epoch'] for file in information['files']]
    assert starts == sorted(starts)
    assert information['starting_time']['nanoseconds_since_epoch'] == 0
    assert information['duration']['nanoseconds'] == (COUNT - 1) * MILLISECOND


def test_a_file_is_not_much_larger_or_longer_than_its_limit(tmp_path):
    written(tmp_path / 'size', limits=Limits(split_size=60_000), chunk_size=5000)
    # A piece of messages comes behind the limit, and a summary behind that.
    assert max(path.stat().st_size for path in files_of(tmp_path / 'size')) < 75_000
    written(tmp_path / 'time', limits=Limits(split_duration=0.9))
    lengths = [(load_recording(path).end_ns - load_recording(path).start_ns) / 1e9
               for path in files_of(tmp_path / 'time')]
    assert max(lengths) < 0.9 + 0.1
    assert min(lengths[:-1]) > 0.9 - 0.1


def test_recovery_of_split_files_is_lossless_and_one_lost_file_is_told(split, tmp_path):
    directory, _ = split
    assert recover(directory, tmp_path / 'whole').lossless
    assert sum(recover(directory, tmp_path / 'again').messages.values()) == COUNT
    files_of(directory)[1].unlink()
    recovery = recover(directory, tmp_path / 'rest')
    assert recovery.lost_files == ['run_1.mcap']
    assert sum(recovery.messages.values()) + sum(recovery.missing.values()) == COUNT


class Disk:
    """A disk whose free space is what the test says."""

    def __init__(self, monkeypatch):
        self.free = 10**9
        monkeypatch.setattr(shutil, 'disk_usage',
                            lambda path: SimpleNamespace(free=self.free, path=path))


def test_recording_stops_below_the_limit_and_goes_on_in_a_new_file(tmp_path, monkeypatch):
    disk = Disk(monkeypatch)
    writer = RecordingWriter(tmp_path / 'run', TOPICS, limits=Limits(min_free_space=10**8))
    monkeypatch.setattr('hydra_actuator.recording.writer._LOOK', 0.0)
    writer.write('/a', 1, 1, messages.float64(1.0))
    disk.free = 10**8 - 1
    with pytest.raises(RecordingFailure, match='99999999 bytes are free'):
        writer.write('/a', 2, 2, messages.float64(2.0))
    with pytest.raises(RecordingFailure, match='broken off'):
        writer.write('/a', 3, 3, messages.float64(3.0))
    assert load_recording(tmp_path / 'run').finished
    disk.free = 10**8 + 1
    with pytest.raises(RecordingFailure, match='are needed'):
        writer.resume()
    disk.free = 2 * 10**8
    writer.resume()
    writer.write('/a', 4, 4, messages.float64(4.0))
    writer.close()
    recording = load_recording(tmp_path / 'run')
    assert [path.name for path in recording.files] == ['run_0.mcap', 'run_1.mcap']
    assert recording.series('/a').stamps.tolist() == [1, 2, 4]
    assert writer.statistics.messages == {'/a': 3, '/b': 0}


def test_behind_the_queue_the_interruption_is_an_error_until_there_is_space(
        tmp_path, monkeypatch):
    disk = Disk(monkeypatch)
    resumed = []
    writer = RecordingWriter(tmp_path / 'run', TOPICS, limits=Limits(min_free_space=10**8))
    queue = QueuedWriter(writer)
    queue.on_resume = lambda: resumed.append(True)
    puts = 0
    disk.free = 0
    while queue.error is None:
        queue.put('/a', puts, puts, messages.float64(puts))
        puts += 1
        time.sleep(0.001)
    assert 'bytes are free' in str(queue.error)
    assert not queue.put('/a', puts, puts, messages.float64(puts))
    puts += 1
    disk.free = 10**9
    while queue.error is not None:
        time.sleep(0.001)
    for sent in range(10):
        assert queue.put('/b', sent, sent, messages.float64(sent))
    assert queue.close()
    statistics = queue.statistics
    assert (statistics.failures, statistics.resumed, resumed) == (1, 1, [True])
    assert queue.error is None
    assert statistics.written['/b'] == 10
    assert statistics.written['/a'] + statistics.dropped['/a'] == puts
    with Reader(tmp_path / 'run') as reader:
        assert reader.message_count == sum(statistics.written.values())
    assert [path.name for path in files_of(tmp_path / 'run')] == ['run_0.mcap', 'run_1.mcap']


def test_the_longest_name_has_room_for_many_files(tmp_path):
    with pytest.raises(RecordingError, match='name too long, more than 243 bytes'):
        RecordingWriter(tmp_path / ('x' * 244), TOPICS)
    written(tmp_path / ('x' * 243), limits=Limits(split_duration=0.1))
    assert len(files_of(tmp_path / ('x' * 243))) > 10
