# SPDX-License-Identifier: Apache-2.0
"""`watch` beside a real node, in a process and, where it is live, a terminal of its own."""

import fcntl
import os
import pty
import select
import signal
import struct
import subprocess
import sys
import termios
import time

import pytest

PATIENCE = 60.0
OTHER_SCREEN, OWN_SCREEN = '\x1b[?1049h', '\x1b[?1049l'


def test_a_running_node_is_seen(node_process, demo_process):
    node_process('-r', '__ns:=/left', '-p', 'recording.enabled:=false')
    seen = demo_process('watch', '/left/actuator', '--once', environment={'COLUMNS': '100'})
    assert seen.popen.wait(PATIENCE) == 0, seen.text
    for words in ('/left/actuator', 'position', 'MPa', 'Real time', 'Solver'):
        assert words in seen.text
    for station in 'OABCDEFGHIJK':
        assert f' {station} ' in seen.text
    missed = demo_process('watch', '/nobody', '--once')
    assert missed.popen.wait(PATIENCE) == 1
    assert missed.text == (
        'hydra_actuator watch: /nobody: no joint states on /joint_states, ROS domain '
        f'{os.environ["ROS_DOMAIN_ID"]}, within 5 s; actuators here: /left/actuator\n')


class Terminal:
    """`hydra_actuator watch` in a terminal of 100 columns and 40 lines."""

    def __init__(self, *arguments):
        self._side, other = pty.openpty()
        fcntl.ioctl(other, termios.TIOCSWINSZ, struct.pack('HHHH', 40, 100, 0, 0))
        self.popen = subprocess.Popen(
            [sys.executable, '-m', 'hydra_actuator', 'watch', *arguments],
            stdin=other, stdout=other, stderr=other, start_new_session=True,
            env={**os.environ, 'TERM': 'xterm-256color'})
        os.close(other)
        self.text = ''

    def read(self, seconds):
        """Take what it shows; a closed terminal has nothing more to show."""
        if select.select([self._side], [], [], seconds)[0]:
            try:
                self.text += os.read(self._side, 65536).decode('utf-8', 'replace')
            except OSError:
                return

    def wait_for(self, words):
        """Wait until it shows words."""
        end = time.monotonic() + PATIENCE
        while words not in self.text:
            assert time.monotonic() < end and self.popen.poll() is None, self.text
            self.read(0.1)

    def end(self, number):
        """Send a signal; return the exit code."""
        self.popen.send_signal(number)
        end = time.monotonic() + PATIENCE
        while self.popen.poll() is None and time.monotonic() < end:
            self.read(0.1)
        self.read(0.1)
        return self.popen.wait(1.0)

    def close(self):
        """Leave nothing behind."""
        self.popen.kill()
        self.popen.wait()
        os.close(self._side)


@pytest.fixture
def terminal(domain):
    """Open terminals with a watch in them."""
    opened = []

    def watch(*arguments):
        opened.append(Terminal(*arguments))
        return opened[-1]
    yield watch
    for one in opened:
        one.close()


@pytest.mark.parametrize('number, code', [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_it_waits_for_a_node_and_leaves_the_terminal_as_it_was(terminal, domain, number, code):
    watch = terminal('/nobody')
    watch.wait_for(f'waiting for joint states on /joint_states, ROS domain {domain}')
    assert watch.end(number) == code
    assert watch.text.count(OTHER_SCREEN) == watch.text.count(OWN_SCREEN) == 1
    assert 'Traceback' not in watch.text


def test_a_node_that_comes_late_and_dies_is_followed(terminal, node_process):
    watch = terminal()
    watch.wait_for('Nobody publishes there yet.')
    node = node_process('-p', 'recording.enabled:=false')
    watch.wait_for('0 to 21')
    watch.wait_for('commands are obeyed')
    node.kill()
    watch.wait_for('silent for')
    assert watch.end(signal.SIGINT) == 130
