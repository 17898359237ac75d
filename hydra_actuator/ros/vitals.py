# SPDX-License-Identifier: Apache-2.0
"""What a rig says of itself: the statuses of diagnostics, and the counts that become events."""

from collections.abc import Mapping

from hydra_actuator.actuator import Actuator
from hydra_actuator.parameters import Parameters
from hydra_actuator.ros import statuses
from hydra_actuator.ros.clocks.source import ClockSource
from hydra_actuator.ros.inbox import Inbox
from hydra_actuator.ros.publishing import Publishers
from hydra_actuator.ros.recorder import Recorder
from hydra_actuator.ros.ring import Ring
from hydra_actuator.ros.setpoint import Setpoint
from hydra_actuator.ros.statuses import Status
from hydra_actuator.ros.watch import Watched

RIVAL = '/clock is published by another node as well'


class Vitals:
    """
    Reads the parts of a rig, and remembers what has happened of late.

    setup: what scheduling was asked for and had, filled as it is known.
    """

    def __init__(
        self, actuator: Actuator, clock: ClockSource, inbox: Inbox, setpoint: Setpoint,
        ring: Ring, recorder: Recorder, publishers: Publishers,
    ):
        self._actuator = actuator
        self._clock = clock
        self._desk = inbox.desk
        self._commanders = inbox.commanders
        self._setpoint = setpoint
        self._ring = ring
        self._recorder = recorder
        self._publishers = publishers
        self._rivals = self._rivals_in_all = 0
        self.setup: Mapping[str, str] = {}
        self._rejected = statuses.Recently()
        self._boiled, self._vacuum = statuses.Recently(), statuses.Recently()

    def oil(self, parameters: Parameters) -> statuses.Status:
        """Return whether the oil boils, or would."""
        tally = self._actuator.tally
        cavities, vacuum_ticks = tally.cavities, tally.vacuum_ticks
        return statuses.oil(
            cavities, vacuum_ticks, parameters['fluid.cavitation'],
            (self._boiled.grew(cavities.opened), self._vacuum.grew(vacuum_ticks)))

    def statuses(self, parameters: Parameters) -> list[statuses.Status]:
        """Return what diagnostics say, but for the state of the solver."""
        self._commanders.look()
        return [
            statuses.scheduled(self._time(), self.setup),
            statuses.command(
                self._desk, self._setpoint, parameters['command.on_timeout'],
                self._rejected.grew(self._desk.rejections), self._commanders),
            statuses.recorder(self._recorder),
            statuses.faults(self._actuator.faults.enabled, self._actuator.faults.active),
        ]

    def _time(self) -> Status:
        """Return how the ticks go, and whether somebody else gives time as well."""
        status, rivals = self._clock.status(), self._publishers.rivals()
        self._rivals_in_all += max(0, rivals - self._rivals)
        self._rivals = rivals
        if rivals < 1 or status.level:
            return status
        return Status(status.name, statuses.WARN, RIVAL, status.values)

    def watched(self) -> list[Watched]:
        """Return the counts that become events."""
        warn = statuses.WARN
        actuator = self._actuator
        return [
            *self._clock.watched(),
            Watched('Real time', warn, RIVAL, lambda: self._rivals_in_all),
            Watched('Real time', warn, 'ticks not published', lambda: self._ring.lost),
            Watched('Command', warn, 'messages dropped', lambda: self._desk.rejections),
            Watched('Command', warn, 'silence', lambda: self._setpoint.timeouts),
            Watched('Solver', warn, 'end stop hit', lambda: actuator.tally.stop_hits),
            Watched('Solver', warn, 'cavity opened', lambda: actuator.tally.cavities.opened),
            Watched('Solver', statuses.OK, 'cavity collapsed',
                    lambda: actuator.tally.cavities.collapsed),
            Watched('Solver', warn, statuses.VACUUM, lambda: actuator.tally.vacuum_ticks),
            Watched('Recorder', statuses.ERROR, 'recording broke off',
                    lambda: self._recorder.failures),
            Watched('Recorder', statuses.OK, 'recording goes on in a new file',
                    lambda: self._recorder.resumed),
        ]
