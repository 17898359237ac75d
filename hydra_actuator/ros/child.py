# SPDX-License-Identifier: Apache-2.0
"""A node in a process of its own, started and stopped in order by the one that measures it."""

from collections.abc import Iterable, Sequence
import ctypes
import os
from pathlib import Path
import re
import signal
import subprocess
import sys
import tempfile
import time

from hydra_actuator.errors import Failure

STOP_PATIENCE = 5.0
_PR_SET_PDEATHSIG = 1


class ChildNode:
    """
    `hydra_actuator node` with ROS arguments, from its making to the end of its context.

    command: module and arguments of another program that is a node.

    It speaks on this process's ROS domain, and ends with this process even if that is killed.
    """

    def __init__(
        self, ros_arguments: Iterable[str], command: Sequence[str] = ('hydra_actuator', 'node')
    ):
        self._log = tempfile.TemporaryFile()
        command = [sys.executable, '-m', *command, '--ros-args', *ros_arguments]
        # In a session of its own: Ctrl-C is for us, and we stop the node in order.
        self._process = subprocess.Popen(
            command, stdin=subprocess.DEVNULL, stdout=self._log, stderr=self._log,
            start_new_session=True, preexec_fn=_end_with_parent)
        self._interrupted = False

    def __enter__(self) -> 'ChildNode':
        return self

    def __exit__(self, *_) -> None:
        self.stop()
        self._log.close()

    def interrupt(self) -> None:
        """Ask it to end, as Ctrl-C would; once is enough."""
        if self._process.poll() is None and not self._interrupted:
            self._interrupted = True
            self._process.send_signal(signal.SIGINT)

    def stop(self) -> int:
        """Have it end, by force if it does not answer; return its exit code."""
        self.interrupt()
        try:
            return self._process.wait(STOP_PATIENCE)
        except subprocess.TimeoutExpired:
            self._process.kill()
            return self._process.wait()

    def check(self) -> None:
        """Raise Failure if it has ended by itself."""
        if self.died:
            raise Failure(
                f'the node ended with code {self._process.returncode}; {self.last_line}')

    def wait_until_active(self, patience: float) -> None:
        """Wait until it says that it is active; raises Failure if it cannot be, or is not yet."""
        end = time.monotonic() + patience
        while 'active: ' not in self.text:
            self.check()
            if 'cannot configure: ' in self.text:
                raise Failure(f'the node does not start; {self.last_line}')
            if time.monotonic() > end:
                raise Failure(f'the node is not active within {patience:g} s; {self.last_line}')
            time.sleep(0.02)

    @property
    def died(self) -> bool:
        """Whether it has ended without having been asked."""
        return self._process.poll() is not None and not self._interrupted

    @property
    def pid(self) -> int:
        """Its process id."""
        return self._process.pid

    @property
    def processor_time(self) -> float:
        """Time [s] that it has had on the processors; 0 once it has ended."""
        try:
            stat = Path(f'/proc/{self.pid}/stat').read_text()
        except OSError:
            return 0.0
        user, system = stat.rpartition(')')[2].split()[11:13]
        return (int(user) + int(system)) / os.sysconf('SC_CLK_TCK')

    @property
    def last_line(self) -> str:
        """What it printed last, as part of a sentence."""
        lines = self.text.strip().splitlines()
        return f'it said: {lines[-1]}' if lines else 'it said nothing'

    @property
    def recording(self) -> Path:
        """The recording that it said it writes; raises Failure if it has said nothing of it."""
        found = re.search(r'recording to (.+)$', self.text, re.MULTILINE)
        if found is None:
            raise Failure('the node recorded nothing')
        return Path(found.group(1))

    @property
    def text(self) -> str:
        """All that it has printed."""
        self._log.seek(0)
        return self._log.read().decode('utf-8', 'replace')


def _end_with_parent() -> None:
    """Have the kernel end the node if this process is killed."""
    ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, signal.SIGTERM)
