# SPDX-License-Identifier: Apache-2.0
"""
What a clock source is: it grants ticks to the plant, each with its stamp.

The plant asks for a grant and does what it says; it knows no mode. One thread calls `start`,
`wait` again and again, `stop`; `wake` and `restart` may come from any thread.
"""

from enum import Enum
import threading
from typing import NamedTuple

from hydra_actuator.ros.statuses import Status
from hydra_actuator.ros.watch import Watched
from rclpy.node import Node

NS = 1_000_000_000
# Where simulated time starts [ns]: 0 means to ROS that there is no clock.
START = NS

Inputs = tuple[float, float, float]


class Act(Enum):
    """What the plant is to do with a grant."""

    SOLVE = 'solve one period'
    RESET = 'return to the initial state'
    REPEAT = 'show the state once more'


class Grant(NamedTuple):
    """
    Leave to tick.

    stamp [ns]: of the state that follows; inputs: (spool 1, spool 2, load [N]) during the
    period, None for what was noted one tick before.
    """

    stamp: int
    act: Act = Act.SOLVE
    inputs: Inputs | None = None


class ClockSource:
    """
    Base of the sources.

    period [s]: simulated time of one tick; failure: '' or why there will be no further tick;
    simulated: stamps are simulated time, the system's time has no part in them, and nothing
    is lost because somebody cannot follow; answers: somebody waits for each tick, so its joint
    state and /clock go out whatever their rates.
    """

    simulated = True
    answers = False

    def __init__(self, period: float):
        self.period = period
        self.failure = ''
        self._period_ns = period * NS
        self._restarting = False
        self._news = threading.Condition()
        self._woken = False

    def start(self, last_stamp: int) -> int | None:
        """
        Begin; return the stamp of the state as it stands, None where it is not known yet.

        last_stamp [ns]: of the last state, 0 if there was none.
        """
        raise NotImplementedError

    def wait(self) -> Grant | None:
        """Wait for the next tick; None when woken for something else, or at a failure."""
        raise NotImplementedError

    def stop(self) -> None:
        """End what `start` began."""

    def out_of_turn(self, last_stamp: int) -> Grant:
        """Return a grant of one tick while stopped."""
        raise NotImplementedError

    def restart(self) -> None:
        """Have the next grant be a reset."""
        with self._news:
            self._restarting = True
            self._woken = True
            self._news.notify()

    def wake(self) -> None:
        """Have `wait` return, for there are orders."""
        with self._news:
            self._woken = True
            self._news.notify()

    def command(self, inputs: Inputs) -> None:
        """Take note of an accepted command, with all inputs as they hold with it."""

    def forget(self) -> None:
        """Drop what waits to be done."""

    def log_time(self, system_time: int) -> int:
        """Return the time [ns] at which something that happens now is recorded."""
        raise NotImplementedError

    def connect(self, node: Node) -> None:
        """Subscribe to what is followed, if anything."""

    def disconnect(self) -> None:
        """Give the subscriptions up."""

    def status(self) -> Status:
        """Return how the ticks go."""
        raise NotImplementedError

    def watched(self) -> list[Watched]:
        """Return the counts that become events."""
        return []

    def _reset_due(self) -> bool:
        """Tell once whether a reset was asked for."""
        due, self._restarting = self._restarting, False
        return due


class OwnTime(ClockSource):
    """A source whose simulated time is its own: START and whole periods."""

    def __init__(self, period: float):
        super().__init__(period)
        self.ticks = 0
        self._periods = 0

    @property
    def stamp(self) -> int:
        """Stamp [ns] of the last state granted."""
        return START + round(self._periods * self._period_ns)

    def start(self, last_stamp: int) -> int:
        """Go on from the last state."""
        return self.stamp

    def log_time(self, system_time: int) -> int:
        """Return the stamp of the last state."""
        return self.stamp

    def out_of_turn(self, last_stamp: int) -> Grant:
        """Return a grant of one tick while stopped."""
        return self._reset() or self._advanced()

    def _advanced(self, inputs: Inputs | None = None) -> Grant:
        self.ticks += 1
        self._periods += 1
        return Grant(self.stamp, inputs=inputs)

    def _reset(self) -> Grant | None:
        """Return the grant of a reset if one was asked for."""
        if not self._reset_due():
            return None
        self._periods = 0
        return Grant(START, Act.RESET)
