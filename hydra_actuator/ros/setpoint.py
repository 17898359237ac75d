# SPDX-License-Identifier: Apache-2.0
"""
The command that holds, between the threads that receive and the thread that solves.

A load holds for ever; a spool command until `timeout` has passed in silence.
"""

from collections.abc import Callable
import threading
import time

from hydra_actuator.realtime.held import nothing_held, sample, SLOTS
from hydra_actuator.ros.commands import CENTRED, Spools


class Setpoint:
    """
    What the valve and the load are asked to be now.

    held: the memory it lies in, for compiled code that samples it as `sample` does; commanded:
    whether a spool command holds, rather than the 0 before the first.
    """

    def __init__(
        self, timeout: float = 0.0, on_timeout: str = 'hold',
        clock: Callable[[], int] = time.monotonic_ns,
    ):
        """Take the silence [s] after which `on_timeout` (`hold`, `centre`) acts; 0 is never."""
        self.on_command: Callable[[tuple[float, float, float]], None] = lambda inputs: None
        self.held = nothing_held()
        self.commanded = False
        self._clock = clock
        self._filling, self._showing = threading.Lock(), threading.Lock()
        self._hold(CENTRED)
        self.set_timeout(timeout, on_timeout)

    def set_timeout(self, timeout: float, on_timeout: str) -> None:
        """Change what silence does; while nobody samples."""
        record = self.held.record[0]
        record['timeout'], record['centres'] = round(timeout * 1e9), on_timeout == 'centre'

    def accept(self, spools: Spools) -> None:
        """Hold a spool command from the next tick on, and tell `on_command` what holds now."""
        self._hold(spools, given=1)
        self.commanded = True
        self.on_command((*spools, float(self.held.record[0]['load_force'])))

    def accept_load(self, load_force: float) -> None:
        """Hold an external load [N] from the next tick on."""
        with self._filling:
            record = self.held.record[0]
            record['load_force'] = load_force
            record['given'] += 1

    def centre(self) -> None:
        """Forget the spool command: 0, as before the first one."""
        self._hold(CENTRED)
        self.commanded = False

    @property
    def silence(self) -> float:
        """Time [s] since the last accepted spool command, or since `centre`."""
        slot = self.held.slots[self.held.record[0]['slot']]
        return (self._clock() - int(slot['accepted'])) * 1e-9

    @property
    def sampled(self) -> tuple[float, float, float]:
        """(spool 1, spool 2, load [N]) as the solver last took them."""
        record = self.held.record[0]
        return tuple(float(record[name]) for name in ('sampled_1', 'sampled_2', 'sampled_load'))

    @property
    def applied(self) -> int:
        """How many commands and loads the solver has taken, of several within a tick one."""
        return int(self.held.record[0]['applied'])

    @property
    def timed_out(self) -> bool:
        """Whether the silence is too long."""
        return bool(self.held.record[0]['timed_out'])

    @property
    def timeouts(self) -> int:
        """How often it has become so."""
        return int(self.held.record[0]['timeouts'])

    def sample(self) -> tuple[float, float, float]:
        """Return (spool 1, spool 2, load [N]) as they hold at this instant; for the solver."""
        return tuple(map(float, sample(self.held, self._clock())))

    def _hold(self, spools: Spools, given: int = 0) -> None:
        # One lock after the other: what is in the slot is seen before its number is.
        with self._filling:
            record = self.held.record[0]
            slot = (int(record['slot']) + 1) % SLOTS
            self.held.slots[slot] = (*spools, self._clock())
            with self._showing:
                record['slot'] = slot
            record['given'] += given
