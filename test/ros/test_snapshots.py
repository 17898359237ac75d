# SPDX-License-Identifier: Apache-2.0
"""Snapshots of a real memory into real recordings, without a node."""

import itertools
import time

from hydra_actuator.recording import messages
from hydra_actuator.recording.errors import RecordingError
from hydra_actuator.recording.reader import load_recording
from hydra_actuator.recording.topics import Topic
from hydra_actuator.recording.writer import RecordingWriter
from hydra_actuator.ros.snapshots import ERROR, OK, Snapshots, WARN
import pytest

TOPIC = Topic('/a', messages.FLOAT64)
PATIENCE = 60.0


@pytest.fixture
def make_snapshots(tmp_path):
    """Return a function that begins to keep messages; what is begun is ended."""
    made = []

    def make(duration):
        number = itertools.count()
        snapshots = Snapshots(
            duration, lambda: RecordingWriter(tmp_path / f'run_{next(number)}', [TOPIC]))
        snapshots.events = []
        snapshots.on_event = lambda *event: snapshots.events.append(event)
        made.append(snapshots)
        return snapshots
    yield make
    for snapshots in made:
        snapshots.close(PATIENCE)


def put(snapshots, first, last):
    """Put messages a millisecond apart."""
    for k in range(first, last):
        stamp = k * 1_000_000
        snapshots.memory.put_batch([(TOPIC.name, stamp, stamp, messages.float64(k))])


def values(path):
    return load_recording(path).series(TOPIC.name).numbers()[:, 0].tolist()


def until(reached):
    end = time.monotonic() + PATIENCE
    while not reached():
        assert time.monotonic() < end
        time.sleep(0.005)


def test_a_snapshot_holds_the_last_seconds_and_the_next_one_as_well(make_snapshots, tmp_path):
    snapshots = make_snapshots(1.0)
    put(snapshots, 0, 3000)
    assert snapshots.take('asked for', PATIENCE) == (True, f'snapshot: {tmp_path / "run_0"}')
    put(snapshots, 3000, 3500)
    assert snapshots.take('asked for', PATIENCE)[0]
    assert values(tmp_path / 'run_0') == list(range(1999, 3000))
    assert values(tmp_path / 'run_1') == list(range(2499, 3500))
    assert load_recording(tmp_path / 'run_0').finished
    assert [event[0] for event in snapshots.events] == [OK, OK]
    assert snapshots.events[0][3] == {'reason': 'asked for', 'messages': '1001'}


@pytest.mark.parametrize('event, wanted', [
    ((ERROR, 'Solver', 'not finite'), True), ((WARN, 'Faults', 'fault.valve_stuck = true'), True),
    ((OK, 'Faults', 'fault.valve_stuck ended'), False), ((WARN, 'Command', 'silence'), False),
    ((ERROR, 'Recorder', 'no snapshot'), False),
])
def test_errors_and_faults_are_worth_a_snapshot(make_snapshots, tmp_path, event, wanted):
    snapshots = make_snapshots(1.0)
    put(snapshots, 0, 10)
    snapshots.notice(*event)
    assert snapshots.close(PATIENCE)
    assert snapshots.written == int(wanted)
    if wanted:
        assert values(tmp_path / 'run_0') == list(range(10))
        assert snapshots.events[0][3]['reason'] == f'{event[1]}: {event[2]}'


def test_errors_one_after_the_other_make_one_more_snapshot_later(make_snapshots, tmp_path):
    snapshots = make_snapshots(0.4)
    put(snapshots, 0, 10)
    snapshots.notice(ERROR, 'Solver', 'first')
    until(lambda: snapshots.written == 1)
    for number in range(10):
        snapshots.notice(ERROR, 'Solver', f'again {number}')
    put(snapshots, 10, 20)
    until(lambda: snapshots.written == 2)
    assert values(tmp_path / 'run_1') == list(range(20))
    assert snapshots.close(PATIENCE)
    assert snapshots.written == 2


def test_a_snapshot_that_cannot_be_written_is_told_and_the_next_may_be(make_snapshots, tmp_path):
    (tmp_path / 'run_0').mkdir()
    snapshots = make_snapshots(1.0)
    put(snapshots, 0, 10)
    done, message = snapshots.take('asked for', PATIENCE)
    assert not done
    assert 'run_0 exists already' in message
    assert snapshots.take('asked for', PATIENCE)[0]
    assert snapshots.error == ''
    with pytest.raises(RecordingError, match='no topic'):
        load_recording(tmp_path / 'run_1').series('/b')


def test_what_holds_is_asked_for_in_every_duration(make_snapshots):
    snapshots = make_snapshots(0.1)
    asked = []
    snapshots.restate = lambda: asked.append(time.monotonic())
    until(lambda: len(asked) > 3)
