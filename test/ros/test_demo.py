# SPDX-License-Identifier: Apache-2.0
"""The main job as a whole: a node, a driver over DDS, a recording, a summary."""

from pathlib import Path
import signal
import time

from hydra_actuator import load_recording
from hydra_actuator.ros.domain import own_domain
import numpy as np


def children(pid):
    """Return the processes that a process has started."""
    found = []
    for stat in Path('/proc').glob('[0-9]*/stat'):
        try:
            if int(stat.read_text().rpartition(')')[2].split()[1]) == pid:
                found.append(int(stat.parent.name))
        except (OSError, ValueError):
            continue
    return found


def test_demo_runs_the_main_job_and_says_what_came_back(demo_process, tmp_path):
    demo = demo_process('demo', '--duration', '2', '--output', tmp_path, '--no-report')
    assert demo.popen.wait(240.0) == 0, demo.text
    for line in ('real-time factor', 'ticks', 'overruns', 'lateness p50 / p99 / max',
                 'joint states recorded', '12 pressures recorded', 'joint_states over DDS',
                 'stroke', 'lowest pressure', 'highest pressure'):
        assert line in demo.text
    path, = tmp_path.iterdir()
    assert f'recording: {path}' in demo.text
    recording = load_recording(path)
    channels = recording.channels
    moving = recording.rows[-1500:-500]
    # Full stroke, and the sine's own frequency: 50 periods a second.
    spool = moving[:, channels.SPOOL_1]
    assert np.max(np.abs(spool)) > 0.9 * 5e-4
    spectrum = np.abs(np.fft.rfft(spool - np.mean(spool)))
    assert np.argmax(spectrum) == 50


def test_ctrl_c_ends_demo_and_node(demo_process, tmp_path):
    demo = demo_process('demo', '--duration', '60', '--output', tmp_path)
    end = time.monotonic() + 240.0
    while not list(tmp_path.glob('*/*_0.mcap')):
        assert time.monotonic() < end and demo.popen.poll() is None, demo.text
        time.sleep(0.05)
    node, = children(demo.popen.pid)
    time.sleep(0.5)
    assert demo.end(signal.SIGINT)[0] == 130
    assert not Path(f'/proc/{node}').exists()
    path, = tmp_path.iterdir()
    assert load_recording(path).finished
    assert 'Traceback' not in demo.text


def test_a_domain_is_held_by_one_only():
    with own_domain() as first, own_domain() as second:
        assert first != second
        assert {first, second} <= set(range(1, 102))
