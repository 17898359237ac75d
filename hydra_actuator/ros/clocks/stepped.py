# SPDX-License-Identifier: Apache-2.0
"""
Lockstep: each accepted command is one tick, in the order in which they came, none merged.

A command carries the load that held when it came, so that same messages give same bits at any
speed. Until the first one the initial state is shown again each second, with its own stamp, for
whoever comes late; with `free_wheel` the plant runs meanwhile.
"""

from collections import deque
import time

from hydra_actuator.ros.clocks.source import Act, Grant, Inputs, OwnTime
from hydra_actuator.ros.clocks.waiting import Waiting
from hydra_actuator.ros.statuses import Status
from hydra_actuator.ros.watch import Watched

# How often the initial state is shown [s].
REPETITION = 1.0


class Stepped(OwnTime):
    """
    Grants a tick for each `command`.

    free_wheel: distance of ticks [s] on the steady clock until the first command, 0 for none.
    """

    answers = True

    def __init__(self, period: float, free_wheel: float = 0.0):
        super().__init__(period)
        self._interval = free_wheel or REPETITION
        self._free_wheels = free_wheel > 0.0
        self._commands: deque[Inputs] = deque()
        self._commanded = False
        self._idle_until = 0.0
        self._waiting = Waiting('a command')

    def command(self, inputs: Inputs) -> None:
        """Queue one tick with its inputs."""
        with self._news:
            self._commands.append(inputs)
            self._news.notify()

    def start(self, last_stamp: int) -> int:
        """Go on from the last state."""
        self._idle_until = time.monotonic() + self._interval
        return super().start(last_stamp)

    def stop(self) -> None:
        """End the wait; commands that are queued stay so."""
        self._waiting.end()

    def forget(self) -> None:
        """Drop the commands that are queued."""
        with self._news:
            self._commands.clear()

    def restart(self) -> None:
        """Have the next grant be a reset; the commands before it are past."""
        with self._news:
            self._commands.clear()
            self._commanded = False
            super().restart()

    def wait(self) -> Grant | None:
        """Wait for a command."""
        with self._news:
            if not self._commands and not self._woken:
                self._waiting.begin()
                self._news.wait(self._patience())
            self._woken = False
            return self._reset() or self._obeyed() or self._idle()

    def out_of_turn(self, last_stamp: int) -> Grant:
        """Return a grant for the next command queued, else for what holds."""
        with self._news:
            return self._reset() or self._obeyed() or self._advanced()

    def status(self) -> Status:
        """Return how many commands were obeyed, and how long the next is waited for."""
        return self._waiting.status('lockstep', {
            'ticks': str(self.ticks), 'queued': str(len(self._commands)),
            'stamp': f'{self.stamp * 1e-9:.9f}'})

    def watched(self) -> list[Watched]:
        """Return the long waits."""
        return self._waiting.watched()

    def _patience(self) -> float:
        """Return how long to wait [s] before there is something else to do."""
        remaining = self._waiting.remaining()
        if self._commanded:
            return remaining
        return max(0.0, min(remaining, self._idle_until - time.monotonic()))

    def _reset(self) -> Grant | None:
        self._idle_until = time.monotonic() + self._interval if self._restarting else (
            self._idle_until)
        return super()._reset()

    def _obeyed(self) -> Grant | None:
        """Return the tick of the next command queued, if there is one."""
        if not self._commands:
            return None
        self._commanded = True
        self._waiting.end()
        return self._advanced(self._commands.popleft())

    def _idle(self) -> Grant | None:
        """Return what is to be done while no command comes."""
        self._waiting.look()
        now = time.monotonic()
        if self._commanded or now < self._idle_until:
            return None
        self._idle_until = max(self._idle_until + self._interval, now)
        return self._advanced() if self._free_wheels else Grant(self.stamp, Act.REPEAT)
