# SPDX-License-Identifier: Apache-2.0
"""Real nodes in real processes on a domain of their own, and a peer that speaks to them."""

from collections.abc import Sequence
import os
from pathlib import Path
import re
import signal
import subprocess
import sys
import tempfile
import time

from hydra_actuator.ros.domain import loopback_environment, own_domain
from hydra_actuator.ros.reception import Reception
import pytest
import rclpy
from rclpy.executors import SingleThreadedExecutor
from rclpy.serialization import deserialize_message

# A machine under load, or a first start that compiles.
PATIENCE = 480.0
ANSWER = 10.0
# The same kernels on a coarse mesh: the tests are about the node.
COARSE = ('-p', 'solver.cells:=100')


@pytest.fixture
def domain(monkeypatch):
    """Hold a ROS domain that no other test run has, on the loopback only."""
    with own_domain() as number:
        for name, value in loopback_environment(number).items():
            monkeypatch.setenv(name, value)
        for name in set(os.environ) - set(loopback_environment(number)):
            monkeypatch.delenv(name)
        monkeypatch.setenv('RCUTILS_COLORIZED_OUTPUT', '0')
        yield number


class Process:
    """`hydra_actuator VERB ...` in a process of its own."""

    def __init__(self, *arguments, environment=None, interrupts=signal.SIG_DFL):
        self._log = tempfile.TemporaryFile()
        self.popen = subprocess.Popen(
            [sys.executable, '-m', 'hydra_actuator', *map(str, arguments)],
            stdin=subprocess.DEVNULL, stdout=self._log, stderr=self._log,
            env={**os.environ, **(environment or {})}, cwd=Path(__file__).parents[2],
            preexec_fn=lambda: signal.signal(signal.SIGINT, interrupts))

    @property
    def text(self):
        """What it printed so far."""
        self._log.seek(0)
        return self._log.read().decode()

    def wait_for_line(self, words):
        """Wait until it has printed the words."""
        end = time.monotonic() + PATIENCE
        while words not in self.text:
            assert self.popen.poll() is None, self.text
            assert time.monotonic() < end, self.text
            time.sleep(0.02)

    def end(self, number=signal.SIGINT):
        """Send a signal; return exit code and the time it took [s]."""
        begin = time.monotonic()
        if self.popen.poll() is None:
            self.popen.send_signal(number)
        return self.popen.wait(20.0), time.monotonic() - begin

    @property
    def recording(self):
        """The recording it said it writes."""
        return Path(re.findall(r'recording to (\S+)', self.text)[-1])

    def kill(self):
        """Leave nothing behind."""
        if self.popen.poll() is None:
            self.popen.kill()
            self.popen.wait()
        self._log.close()


@pytest.fixture
def demo_process(domain):
    """Start commands of this package; they end with the test."""
    processes = []

    def start(*arguments, **settings):
        processes.append(Process(*arguments, **settings))
        return processes[-1]
    yield start
    for process in processes:
        process.kill()


@pytest.fixture
def node_process(demo_process, tmp_path):
    """Start nodes that record into this test's folder, by default until they are active."""
    def start(*arguments, active=True, **settings):
        process = demo_process(
            'node', '--ros-args', *COARSE, '-p', f'recording.directory:={tmp_path}',
            *arguments, **settings)
        if active:
            process.wait_for_line('active: ')
        return process
    return start


class Heard(Sequence):
    """The messages of a topic, read when looked at: listening at 1 kHz must cost little."""

    def __init__(self, message_type):
        self._type = message_type
        self._received = []

    def take(self, data, received, sent):
        """Take a message as bytes."""
        self._received.append(data)

    def __len__(self):
        return len(self._received)

    def __getitem__(self, index):
        return deserialize_message(self._received[index], self._type)


class Peer:
    """A node of the test: calls services, keeps what it hears."""

    def __init__(self, context):
        self.node = rclpy.create_node('peer', context=context)
        self._executor = SingleThreadedExecutor(context=context)
        self._executor.add_node(self.node)
        self._receptions = []
        self._clients = {}

    def hear(self, message_type, topic, depth=1000):
        """Return a sequence that fills with the messages of a topic."""
        heard = Heard(message_type)
        reception = Reception(self.node, lambda error: None)
        reception.subscribe(message_type, topic, heard.take, qos_profile=depth)
        reception.start()
        self._receptions.append(reception)
        return heard

    def publisher(self, message_type, topic):
        """Return a publisher that has found a subscriber; that one may find it later still."""
        publisher = self.node.create_publisher(message_type, topic, 10)
        self.until(lambda: publisher.get_subscription_count() > 0)
        return publisher

    def send(self, publisher, message, reached):
        """Publish a message, again and again, until a condition holds."""
        end = time.monotonic() + ANSWER
        while not reached():
            assert time.monotonic() < end, 'what was waited for did not happen'
            publisher.publish(message)
            self.spin(0.05)

    def until(self, reached, patience=ANSWER):
        """Spin until a condition holds; fail the test otherwise."""
        end = time.monotonic() + patience
        while not reached():
            assert time.monotonic() < end, 'what was waited for did not happen'
            self._executor.spin_once(timeout_sec=0.02)

    def spin(self, duration):
        """Spin for a time [s]."""
        end = time.monotonic() + duration
        while time.monotonic() < end:
            self._executor.spin_once(timeout_sec=0.02)

    def call(self, service_type, name, patience=ANSWER, **fields):
        """Call a service and return its answer."""
        client = self._clients.get(name)
        if client is None:
            client = self._clients[name] = self.node.create_client(service_type, name)
        self.until(client.service_is_ready)
        future = client.call_async(service_type.Request(**fields))
        self.until(future.done, patience)
        return future.result()

    def close(self):
        """Give the node up."""
        for reception in self._receptions:
            reception.stop()
        self._executor.shutdown()
        self.node.destroy_node()


@pytest.fixture
def peer(domain):
    """Speak with the nodes of the test."""
    context = rclpy.Context()
    rclpy.init(context=context, args=[])
    peer = Peer(context)
    yield peer
    peer.close()
    rclpy.try_shutdown(context=context)
