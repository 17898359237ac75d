# SPDX-License-Identifier: Apache-2.0
"""Ten minutes under full load: memory, descriptors and the clock stay; prints the figures (-s)."""

from collections import Counter
import os
import threading
import time

from hydra_actuator import load_recording
from hydra_actuator.realtime.pacer import Pacer
from hydra_actuator.ros.reception import Reception
import numpy as np
import pytest
from sensor_msgs.msg import FluidPressure, JointState
from std_msgs.msg import Float32MultiArray, Float64

DURATION = 600.0
PERIOD = 1e-3
# The beginning, while buffers fill and allocators settle [s].
SETTLING = 60.0
# Ten hours of this are what the indexes of one file of a recording may take [kB/s].
MEMORY_SLOPE = 10.0


class Commander:
    """Publishes a sine at 1 kHz from a thread."""

    def __init__(self, publisher):
        self._publisher = publisher
        self._stopping = False
        self._thread = threading.Thread(target=self._run)

    def _run(self):
        pacer = Pacer(PERIOD)
        pacer.start()
        while not self._stopping:
            tick = pacer.wait()
            self._publisher.publish(Float64(data=0.05 * np.sin(0.1 * tick)))

    def __enter__(self):
        self._thread.start()
        return self

    def __exit__(self, *_):
        self._stopping = True
        self._thread.join()


def memory(pid):
    """Return the memory [kB] that belongs to a process alone and to no file."""
    status = open(f'/proc/{pid}/status').read()
    return int(next(line for line in status.splitlines() if line.startswith('RssAnon')).split()[1])


@pytest.mark.soak
def test_ten_minutes_take_no_memory_no_descriptors_and_no_time(node_process, peer):
    node = node_process('-p', 'solver.cells:=200', '-p', 'publish.field:=true')
    pid = node.popen.pid
    heard, reception = Counter(), Reception(peer.node, lambda error: None)
    for kind, topic in (
        (JointState, '/joint_states'), (Float32MultiArray, '/actuator/field'),
        *((FluidPressure, f'/actuator/pressure/{name}') for name in 'OABCDEFGHIJK'),
    ):
        reception.subscribe(
            kind, topic, lambda *message, topic=topic: heard.update([topic]), qos_profile=10)
    reception.start()
    command = peer.publisher(Float64, '/actuator/spool_command')
    samples = []
    with Commander(command):
        begin = time.monotonic()
        while (now := time.monotonic() - begin) < DURATION:
            assert node.popen.poll() is None, node.text
            samples.append((now, memory(pid), len(os.listdir(f'/proc/{pid}/fd')),
                            len(os.listdir(f'/proc/{pid}/task'))))
            peer.spin(1.0)
    reception.stop()
    code, took = node.end()
    samples = np.array(samples)
    settled = samples[samples[:, 0] > SETTLING]
    slope = np.polyfit(settled[:, 0], settled[:, 1], 1)[0]
    recording = load_recording(node.recording)
    states = recording.series('/joint_states')
    behind = (states.publish_stamps.astype(float) - states.stamps.astype(float)) * 1e-9
    drift = behind[-1000:].min()
    print(f'\nmemory {settled[0, 1] / 1e3:.1f} MB, {slope:+.2f} kB/s; descriptors '
          f'{settled[:, 2].min():.0f} to {settled[:, 2].max():.0f}; threads '
          f'{settled[:, 3].min():.0f} to {settled[:, 3].max():.0f}; heard {min(heard.values())} '
          f'of {len(states)} states at the least; drift {drift * 1e6:+.0f} us; end {took:.2f} s')
    assert (code, took < 2.0) == (0, True)
    assert slope < MEMORY_SLOPE
    # A file that is being replaced may be open for a moment.
    for counts in settled[:, 2], settled[:, 3]:
        assert np.median(counts[-60:]) == np.median(counts[:60])
    # Wall time is simulated time and slip, to a tick.
    assert 0.0 <= drift <= PERIOD
    assert recording.finished
