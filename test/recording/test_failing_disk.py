# SPDX-License-Identifier: Apache-2.0
"""A disk that is full, fails now and then, or is not there: what was written stays."""

from collections import Counter
from concurrent.futures import ThreadPoolExecutor
import errno
import os
import shutil
import subprocess
import threading
import time

from hydra_actuator.recording import messages, segment
from hydra_actuator.recording.errors import RecordingError, RecordingFailure
from hydra_actuator.recording.limits import Limits
from hydra_actuator.recording.queue import QueuedWriter
from hydra_actuator.recording.reader import load_recording
from hydra_actuator.recording.recovery import recover
from hydra_actuator.recording.topics import Topic
from hydra_actuator.recording.writer import RecordingWriter
import pytest
from rosbags.rosbag2 import Reader

TOPICS = [Topic('/a', messages.FLOAT64), Topic('/b', messages.STRING)]


class Faults:
    """Makes every n-th call of one kind fail, in all files that are opened meanwhile."""

    def __init__(self, monkeypatch, kind, every):
        self.calls = self.failed = 0
        self._kind, self._every = kind, every
        monkeypatch.setattr(segment, 'open', self._open, raising=False)
        replace = os.replace

        def replacing(*paths):
            self.count('replace')
            return replace(*paths)
        monkeypatch.setattr(os, 'replace', replacing)

    def count(self, kind):
        """Count a call, and fail if its turn has come."""
        if kind != self._kind:
            return
        self.calls += 1
        if self.calls % self._every == 0:
            self.failed += 1
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    def end(self):
        """Let all calls succeed from now on."""
        self._kind = None

    def _open(self, *arguments, **options):
        self.count('open')
        return FaultyFile(self, open(*arguments, **options))


class FaultyFile:
    """A real file; a write that fails has written half before, as a full disk does."""

    def __init__(self, faults, file):
        self._faults, self._file = faults, file

    def __getattr__(self, name):
        return getattr(self._file, name)

    def write(self, data):
        try:
            self._faults.count('write')
        except OSError:
            self._file.write(data[:len(data) // 2])
            raise
        return self._file.write(data)

    def truncate(self, size):
        self._faults.count('truncate')
        return self._file.truncate(size)

    def close(self):
        self._file.close()
        self._faults.count('close')


@pytest.mark.parametrize('every', [2, 3, 7])
@pytest.mark.parametrize('kind', ['write', 'replace', 'open', 'close'])
def test_every_nth_call_failing_costs_only_what_is_counted(tmp_path, monkeypatch, kind, every):
    directory = tmp_path / 'run'
    with monkeypatch.context() as patch:
        writer = RecordingWriter(directory, TOPICS, {'source': 'node'}, flush_period=0.0,
                                 limits=Limits(split_duration=10e-9))
        faults = Faults(patch, kind, every)
        # The file at work was opened before.
        writer._files.open._file = FaultyFile(faults, writer._files.open._file)
        kept_before = 0
        for k in range(100):
            try:
                writer.write('/a', k, k, messages.float64(k))
            except RecordingFailure as failure:
                assert 'run' in str(failure)
                kept = writer.statistics.messages['/a']
                assert kept >= kept_before
                kept_before = kept
                for _ in range(20):
                    try:
                        writer.resume()
                        break
                    except RecordingFailure:
                        continue
        assert faults.failed > 0
        faults.end()
    kept = writer.statistics.messages['/a']
    writer.close()
    assert 0 < kept
    recording = load_recording(directory)
    stamps = recording.series('/a').stamps.tolist()
    assert len(stamps) == kept
    assert stamps == sorted(set(stamps))
    assert [value for value, in recording.series('/a').numbers().tolist()] == stamps
    assert not list(directory.glob('*.new'))
    # A summary that could not be written either leaves a file for `recover`.
    assert recording.finished or kind == 'write'
    if recording.finished:
        with Reader(directory) as reader:
            assert reader.message_count == kept
    assert recover(directory, tmp_path / 'again').messages['/a'] == kept


def test_a_failed_write_costs_the_open_chunk_only_and_the_file_is_whole(tmp_path, monkeypatch):
    writer = RecordingWriter(tmp_path / 'run', TOPICS, flush_period=1e9)
    for k in range(10):
        writer.write('/a', k, k, messages.float64(k))
    writer.flush()
    for k in range(10, 15):
        writer.write('/a', k, k, messages.float64(k))
    faults = Faults(monkeypatch, 'write', 1000)
    faults.calls = 999
    writer._files.open._file = FaultyFile(faults, writer._files.open._file)
    with pytest.raises(RecordingFailure, match=r'run_0\.mcap cannot be written: No space left'):
        while True:
            writer.write('/b', 20, 20, messages.string('x' * 10_000))
    assert writer.statistics.messages == {'/a': 10, '/b': 0}
    recording = load_recording(tmp_path / 'run')
    assert recording.finished
    assert recording.series('/a').stamps.tolist() == list(range(10))
    assert recover(tmp_path / 'run', tmp_path / 'again').lossless


def test_the_queue_loses_and_counts_only_what_a_failing_disk_costs(tmp_path, monkeypatch):
    monkeypatch.setattr('hydra_actuator.recording.queue._RETRY', 0.01)
    faults = Faults(monkeypatch, 'write', 13)
    writer = RecordingWriter(tmp_path / 'run', TOPICS, flush_period=0.01, chunk_size=1000)
    queue = QueuedWriter(writer, poll_period=0.001)
    sent = 0
    while queue.statistics.resumed < 5:
        queue.put('/a', sent, sent, messages.float64(sent))
        sent += 1
        time.sleep(0.0002)
    faults.end()
    assert queue.close()
    statistics = queue.statistics
    assert statistics.failures >= 5
    written = statistics.written['/a']
    assert written + statistics.dropped['/a'] == sent
    assert len(load_recording(tmp_path / 'run').series('/a')) == written


@pytest.fixture
def small_disk(make_disk):
    """Give a file system of 4 MB."""
    return make_disk(4)


def test_a_full_disk_costs_nothing_already_written_and_recording_goes_on(small_disk, tmp_path):
    queue = QueuedWriter(RecordingWriter(small_disk / 'run', TOPICS, flush_period=0.05))
    ballast = small_disk / 'ballast'
    ballast.write_bytes(bytes(2_500_000))
    sent = 0
    while queue.error is None:
        queue.put('/b', sent, sent, messages.string('x' * 20_000))
        sent += 1
        time.sleep(0.0005)
    assert 'No space left on device' in str(queue.error)
    before = queue.statistics.written['/b']
    recording = load_recording(small_disk / 'run')
    assert recording.series('/b').stamps.tolist() == list(range(before))
    ballast.unlink()
    while queue.error is not None:
        time.sleep(0.005)
    for k in range(50):
        assert queue.put('/a', sent + k, sent + k, messages.float64(k))
    assert queue.close()
    assert queue.error is None
    statistics = queue.statistics
    assert statistics.written['/b'] + statistics.dropped['/b'] == sent
    assert statistics.written['/a'] == 50
    recording = load_recording(small_disk / 'run')
    assert recording.finished
    assert len(recording.files) == 2
    assert len(recording.series('/b')) == statistics.written['/b'] == before
    with Reader(small_disk / 'run') as reader:
        assert reader.message_count == before + 50


def test_a_disk_that_becomes_read_only_is_named_and_one_from_the_start_refused(small_disk):
    queue = QueuedWriter(RecordingWriter(small_disk / 'run', TOPICS, flush_period=0.01))
    for k in range(5):
        queue.put('/a', k, k, messages.float64(k))
    while queue.statistics.written.get('/a', 0) < 5:
        time.sleep(0.005)
    with pytest.raises(RecordingError, match='Read-only'):
        # A file that is open for writing forbids the change: a bind mount does not mind.
        subprocess.run(['mount', '--bind', str(small_disk), str(small_disk)], check=True)
        try:
            subprocess.run(['mount', '-o', 'remount,bind,ro', str(small_disk)], check=True)
            while queue.error is None:
                time.sleep(0.005)
            assert 'Read-only' in str(queue.error)
            RecordingWriter(small_disk / 'other', TOPICS)
        finally:
            subprocess.run(['umount', '-l', str(small_disk)], check=True)
    while queue.error is not None:
        time.sleep(0.005)
    queue.put('/a', 9, 9, messages.float64(9))
    assert queue.close()
    assert load_recording(small_disk / 'run').series('/a').stamps.tolist() == [0, 1, 2, 3, 4, 9]


def test_a_directory_that_vanishes_is_named_and_one_that_comes_back_is_used(tmp_path):
    queue = QueuedWriter(RecordingWriter(tmp_path / 'run', TOPICS, flush_period=0.01))
    queue.put('/a', 1, 1, messages.float64(1))
    while not queue.statistics.written:
        time.sleep(0.005)
    while (tmp_path / 'run').exists():
        # the writer may put a file there meanwhile
        shutil.rmtree(tmp_path / 'run', ignore_errors=True)
    while queue.error is None:
        time.sleep(0.005)
    assert 'No such file or directory' in str(queue.error)
    assert os.listdir(tmp_path) == []
    (tmp_path / 'run').mkdir()
    while queue.error is not None:
        time.sleep(0.005)
    assert queue.put('/a', 2, 2, messages.float64(2))
    assert queue.close()
    assert load_recording(tmp_path / 'run').series('/a').stamps.tolist() == [2]


@pytest.mark.parametrize('name', [
    'a b', 'quote\'"', 'line\nbreak', '-o', '.hidden', 'Öl', 'a:b', '*', '%s{0}', '[x]', '\\',
    'run_7', 'run.mcap', '~', '$HOME', '#', 'tab\t', 'metadata.yaml',
])
def test_a_strange_name_is_only_a_name(tmp_path, name):
    with RecordingWriter(tmp_path / 'here' / name, TOPICS) as writer:
        writer.write('/a', 1, 1, messages.float64(1.0))
    assert os.listdir(tmp_path / 'here') == [name]
    assert sorted(os.listdir(tmp_path / 'here' / name)) == sorted(
        [f'{name}_0.mcap', 'metadata.yaml'])
    with Reader(tmp_path / 'here' / name) as reader:
        assert reader.message_count == 1
    assert len(load_recording(tmp_path / 'here' / name).series('/a')) == 1


@pytest.mark.parametrize('path', ['.', '..', 'here/..', 'here/.', '/'])
def test_a_path_to_what_is_there_is_refused(tmp_path, monkeypatch, path):
    (tmp_path / 'here').mkdir()
    monkeypatch.chdir(tmp_path)
    with pytest.raises(RecordingError, match='exists already'):
        RecordingWriter(path, TOPICS)
    assert os.listdir(tmp_path) == ['here']


def test_twenty_at_once_under_one_name_leave_one_and_nineteen_refusals(tmp_path):
    together = threading.Barrier(20)

    def begin(number):
        together.wait()
        try:
            writer = RecordingWriter(tmp_path / 'new' / 'run', TOPICS)
        except RecordingError as refusal:
            return str(refusal)
        writer.write('/a', number, number, messages.float64(number))
        writer.close()
        return number

    with ThreadPoolExecutor(20) as pool:
        results = list(pool.map(begin, range(20)))
    winners = [result for result in results if isinstance(result, int)]
    assert len(winners) == 1
    assert Counter('exists already' in str(result) for result in results) == {True: 19, False: 1}
    series = load_recording(tmp_path / 'new' / 'run').series('/a')
    assert series.stamps.tolist() == winners
