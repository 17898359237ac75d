# SPDX-License-Identifier: Apache-2.0
"""kill -9 at random times: what is lost is the last flush period and little more."""

import random
import signal
import subprocess
import sys
import time

from hydra_actuator.recording.reader import load_recording
from hydra_actuator.recording.recovery import recover
import pytest

FLUSH_PERIOD = 0.1
# What may be lost beside the flush period [s].
BESIDE = 0.2
SENDER = """
import sys, time
from hydra_actuator.recording import messages
from hydra_actuator.recording.limits import Limits
from hydra_actuator.recording.queue import QueuedWriter
from hydra_actuator.recording.topics import Topic
from hydra_actuator.recording.writer import RecordingWriter
topics = [Topic('/a', messages.FLOAT64)]
for line in sys.stdin:
    directory, flush_period = line.split()
    queue = QueuedWriter(RecordingWriter(directory, topics, flush_period=float(flush_period),
                                         limits=Limits(split_size=200_000)))
    print('begun', flush=True)
    number = 0
    while True:
        now = time.time_ns()
        queue.put_batch([('/a', now, now, messages.float64(number + k)) for k in range(10)])
        number += 10
        print(now, flush=True)
        time.sleep(0.001)
"""



def killed(directory, after):
    """Kill a sender so long after it begins [s]; return times of first and last message [ns]."""
    with subprocess.Popen([sys.executable, '-c', SENDER], stdin=subprocess.PIPE, text=True,
                          stdout=subprocess.PIPE) as process:
        process.stdin.write(f'{directory} {FLUSH_PERIOD}\n')
        process.stdin.flush()
        assert process.stdout.readline() == 'begun\n'
        end = time.monotonic() + after
        first = last = int(process.stdout.readline())
        while time.monotonic() < end:
            last = int(process.stdout.readline())
        process.send_signal(signal.SIGKILL)
        rest, _ = process.communicate()
    lines = rest.split('\n')
    return first, int(lines[-2]) if len(lines) > 1 else last


def losses(directory, kills, chance):
    """Return by how much each killed recording ends before its last message [s]."""
    found = []
    for number in range(kills):
        path = directory / f'run_{number}'
        first, last = killed(path, chance.uniform(0.1, 0.5))
        recovery = recover(path, directory / f'again_{number}')
        recording = load_recording(directory / f'again_{number}')
        values = recording.series('/a').numbers().ravel().tolist()
        # Nothing is missing in between, and nothing is there twice.
        assert values == list(range(len(values)))
        assert recording.finished
        # Killed within the first flush period, it may hold nothing yet.
        found.append((last - (recovery.end_ns or first)) / 1e9)
    return found


def test_a_killed_writer_loses_no_more_than_its_flush_period(tmp_path):
    found = losses(tmp_path, 5, random.Random(5))
    assert max(found) <= FLUSH_PERIOD + BESIDE, found


@pytest.mark.soak
def test_two_hundred_killed_writers_lose_no_more_than_their_flush_period(tmp_path):
    found = sorted(losses(tmp_path, 200, random.Random(200)))
    print(f'lost: min {found[0]:.3f}, median {found[100]:.3f}, max {found[-1]:.3f} s')
    assert found[-1] <= FLUSH_PERIOD + BESIDE
