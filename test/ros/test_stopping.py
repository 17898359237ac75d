# SPDX-License-Identifier: Apache-2.0
"""Signals end a node in any phase; stopped and continued, it goes on and tells its slip."""

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


def until_signals_are_taken(pid):
    """Wait until a process has taken the signals; the interpreter's own start comes before."""
    end = time.monotonic() + 20.0
    while time.monotonic() < end:
        status = open(f'/proc/{pid}/status').read()
        mask = int(next(line for line in status.splitlines() if 'SigBlk' in line).split()[1], 16)
        if mask & (1 << (signal.SIGTERM - 1)):
            return
        time.sleep(0.005)
    raise AssertionError('the signals were never taken')


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
    # Each pause is counted in whole periods, but for the tick that was being waited for, which is
    # late and no more; what cannot be caught up in a burst is slip.
    assert missed >= sum(int(one / PERIOD) - 1 for one in stood)
    assert slip >= sum(int(one / PERIOD) - 1 - MAX_BURST for one in stood)
    # Every grid instant is a row or declared slip.
    stamps = recording.row_stamps
    gaps = np.diff(stamps)
    assert np.all(gaps >= PERIOD_NS)
    assert np.all(gaps % PERIOD_NS == 0)
    assert np.sum(gaps // PERIOD_NS - 1) == slip


@pytest.mark.parametrize('number, interrupts', [
    (signal.SIGINT, signal.SIG_DFL), (signal.SIGTERM, signal.SIG_DFL),
    # As a shell starts what runs in the background.
    (signal.SIGINT, signal.SIG_IGN),
])
def test_a_signal_ends_an_active_node_with_a_valid_recording(node_process, number, interrupts):
    node = node_process(interrupts=interrupts)
    time.sleep(0.2)
    code, took = node.end(number)
    assert (code, took < 2.0) == (0, True)
    recording = load_recording(node.recording)
    assert recording.finished
    assert len(recording.row_stamps) > 100
    assert 'Traceback' not in node.text


@pytest.mark.parametrize('delay', [0.2, 0.6, 1.0])
def test_a_signal_during_start_up_ends_it_in_order(node_process, tmp_path, delay):
    node = node_process(active=False)
    until_signals_are_taken(node.popen.pid)
    time.sleep(delay)
    code, took = node.end(signal.SIGTERM)
    assert (code, took < 2.0) == (0, True), node.text
    assert all(load_recording(path).finished for path in tmp_path.iterdir())


def test_a_signal_while_the_solver_compiles_ends_it_in_time(node_process, tmp_path):
    node = node_process(
        active=False, environment={'HYDRA_ACTUATOR_CACHE': str(tmp_path / 'cache')})
    time.sleep(3.0)
    assert node.popen.poll() is None
    code, took = node.end(signal.SIGINT)
    assert (code, took < 2.0) == (0, True)
    assert 'active: ' not in node.text


@pytest.mark.soak
@pytest.mark.parametrize('number', [signal.SIGINT, signal.SIGTERM])
def test_fifty_signals_at_random_phases_end_in_order(node_process, tmp_path, number):
    random = np.random.default_rng(int(number))
    begin = time.monotonic()
    node_process().end()
    start_up = time.monotonic() - begin
    ends = []
    for count in range(50):
        # Every tenth compiles; the others import, configure or tick.
        compiling = count % 10 == 9
        environment = {'HYDRA_ACTUATOR_CACHE': str(tmp_path / f'cache_{count}')}
        node = node_process(active=False, environment=environment if compiling else None)
        until_signals_are_taken(node.popen.pid)
        time.sleep(random.uniform(0.0, 10.0 * start_up if compiling else 2.0 * start_up))
        code, took = node.end(number)
        phase = 'active' if 'active: ' in node.text else 'starting'
        ends.append((took, phase))
        assert code == 0, (phase, node.text)
        assert 'Traceback' not in node.text
    print(f'\n{number.name}: ' + ', '.join(
        f'{phase} slowest of {len(own)} {max(own):.2f} s' for phase in ('starting', 'active')
        if (own := [took for took, one in ends if one == phase])))
    assert max(ends)[0] < 2.0
    recordings = list(tmp_path.glob('actuator_*'))
    assert all(load_recording(path).finished for path in recordings)
    assert len(recordings) >= sum(phase == 'active' for _, phase in ends)
