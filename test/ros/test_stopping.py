# SPDX-License-Identifier: Apache-2.0
"""Stopped and continued, a node goes on, counts what it missed and declares its slip."""

import os
import signal
import time

from hydra_actuator import load_recording
import numpy as np
import pytest

PERIOD = 1e-3
PERIOD_NS = 1_000_000
MAX_BURST = 10


def last_values(recording, name):
    """Return the values of the last status of that name in a recording."""
    return next(
        {one['key']: one['value'] for one in status['values']}
        for message in reversed(list(recording.messages('/diagnostics')))
        for status in message['status'] if status['name'].endswith(f': {name}'))


def held(node, duration):
    """Stop a process for so long; return for how long it surely stood still [s]."""
    os.kill(node.popen.pid, signal.SIGSTOP)
    os.waitid(os.P_PID, node.popen.pid, os.WSTOPPED)
    begin = time.monotonic()
    time.sleep(duration)
    stood = time.monotonic() - begin
    os.kill(node.popen.pid, signal.SIGCONT)
    return stood


@pytest.mark.parametrize('pauses', [
    (0.05, 1.5), pytest.param((0.05, 1.5, 10.0), marks=pytest.mark.soak)])
def test_a_node_that_was_held_goes_on_and_tells_its_slip(node_process, pauses):
    node = node_process('-p', f'timing.max_burst:={MAX_BURST}')
    stood = []
    for pause in pauses:
        time.sleep(0.3)
        stood.append(held(node, pause))
    time.sleep(0.5)
    assert node.popen.poll() is None, node.text
    code, took = node.end()
    assert (code, took < 2.0) == (0, True), node.text
    assert 'Traceback' not in node.text
    recording = load_recording(node.recording)
    assert recording.finished
    real_time = last_values(recording, 'Real time')
    slip = round(float(real_time['slip']) / PERIOD)
    missed = int(real_time['overruns'])
    # Each pause is counted in whole periods; what cannot be caught up in a burst is slip.
    assert missed >= sum(int(one / PERIOD) for one in stood)
    assert slip >= sum(int(one / PERIOD) - MAX_BURST for one in stood)
    # Every grid instant is a row or declared slip.
    stamps = recording.row_stamps
    gaps = np.diff(stamps)
    assert np.all(gaps >= PERIOD_NS)
    assert np.all(gaps % PERIOD_NS == 0)
    assert np.sum(gaps // PERIOD_NS - 1) == slip
