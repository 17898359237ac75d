# SPDX-License-Identifier: Apache-2.0
"""The queue before a slow, a broken and a sound sink."""

from collections import Counter
import threading
import time
from types import SimpleNamespace

from hydra_actuator.recording import messages
from hydra_actuator.recording.queue import QueuedWriter
from hydra_actuator.recording.topics import Topic
from hydra_actuator.recording.writer import RecordingWriter
from rosbags.rosbag2 import Reader

TOPICS = ['/a', '/b']


class GatedSink:
    """A sink that writes nothing until its gate opens."""

    @property
    def statistics(self):
        return SimpleNamespace(messages=Counter(message[0] for message in self.messages))

    def __init__(self):
        self.gate = threading.Event()
        self.entered = threading.Event()
        self.messages = []
        self.closed = False

    def write_batch(self, batch):
        if batch:
            self.entered.set()
            self.gate.wait()
        self.messages += batch

    def flush_if_due(self):
        pass

    def resume(self):
        pass

    def close(self):
        self.closed = True


class BrokenSink(GatedSink):
    """A sink on a full disk."""

    def write_batch(self, batch):
        if batch:
            self.entered.set()
            raise OSError(28, 'No space left on device')


def test_what_is_put_is_written_in_order():
    sink = GatedSink()
    sink.gate.set()
    sent = [(TOPICS[k % 2], k, k, bytes([k % 256])) for k in range(5000)]
    with QueuedWriter(sink) as queue:
        for message in sent[:100]:
            assert queue.put(*message)
        for first in range(100, 5000, 14):
            assert queue.put_batch(sent[first: first + 14]) == 0
    assert sink.messages == sent
    assert sink.closed
    assert queue.statistics.written == {'/a': 2500, '/b': 2500}
    assert queue.statistics.dropped == {}
    assert queue.statistics.waiting_bytes == 0


def test_a_stalled_sink_costs_whole_messages_counted_by_topic_and_never_the_producer():
    sink = GatedSink()
    queue = QueuedWriter(sink, capacity=100_000)
    sent = [(TOPICS[k % 3 == 0], k, k, bytes(850)) for k in range(400)]
    results = [queue.put(*message) for message in sent]
    assert sink.entered.wait(10)
    held = sum(results)
    assert held == 100
    assert queue.statistics.most_waiting_bytes <= 100_000
    dropped = Counter(message[0] for message, taken in zip(sent, results) if not taken)
    assert queue.statistics.dropped == dropped
    sink.gate.set()
    assert queue.close()
    assert sink.messages == [message for message, taken in zip(sent, results) if taken]
    assert sum(queue.statistics.written.values()) == held


def test_a_batch_that_does_not_fit_is_cut_at_whole_messages():
    sink = GatedSink()
    queue = QueuedWriter(sink, capacity=1000)
    assert queue.put_batch([('/a', k, k, bytes(100)) for k in range(6)]) == 2
    assert queue.statistics.dropped == {'/a': 2}
    sink.gate.set()
    queue.close()
    assert len(sink.messages) == 4


def test_a_writing_error_is_kept_and_later_messages_count_as_dropped():
    sink = BrokenSink()
    with QueuedWriter(sink, poll_period=0.001) as queue:
        assert queue.put('/a', 1, 1, b'x')
        assert sink.entered.wait(10)
        while queue.error is None:
            time.sleep(0.001)
        assert not queue.put('/b', 2, 2, b'y')
    assert isinstance(queue.error, OSError)
    assert queue.statistics.dropped == {'/a': 1, '/b': 1}
    assert queue.statistics.written == {}
    assert sink.closed


def test_messages_after_closing_are_dropped():
    sink = GatedSink()
    sink.gate.set()
    queue = QueuedWriter(sink)
    assert queue.close()
    assert not queue.put('/a', 1, 1, b'x')
    assert queue.statistics.dropped == {'/a': 1}


def test_closing_gives_up_after_its_timeout_and_succeeds_later():
    sink = GatedSink()
    queue = QueuedWriter(sink)
    queue.put('/a', 1, 1, b'x')
    assert not queue.close(timeout=0.05)
    sink.gate.set()
    assert queue.close()
    assert sink.messages == [('/a', 1, 1, b'x')]


def test_many_producers_lose_nothing(tmp_path):
    topics = [Topic(f'/t{k}', messages.FLOAT64) for k in range(4)]
    with QueuedWriter(RecordingWriter(tmp_path / 'run', topics)) as queue:

        def produce(name):
            for stamp in range(2000):
                queue.put(name, stamp, stamp, messages.float64(stamp))

        threads = [threading.Thread(target=produce, args=(topic.name,)) for topic in topics]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
    assert queue.error is None
    with Reader(tmp_path / 'run') as reader:
        seen = {topic.name: [] for topic in topics}
        for connection, stamp, _ in reader.messages():
            seen[connection.topic].append(stamp)
    assert seen == {topic.name: list(range(2000)) for topic in topics}


def test_an_unwritable_recording_is_reported_at_closing(tmp_path):
    writer = RecordingWriter(tmp_path / 'run', [Topic('/a', messages.FLOAT64)])
    with QueuedWriter(writer) as queue:
        queue.put('/other', 1, 1, b'')
    assert '/other' in str(queue.error)
