# SPDX-License-Identifier: Apache-2.0
"""
The command that holds, between the thread that receives and the thread that solves.

Each attribute is replaced as a whole, so a reader meets the old or the new value, never half of
one. A load holds for ever; a spool command until `timeout` has passed in silence.
"""

from collections.abc import Callable
import time

from hydra_actuator.ros.commands import CENTRED, Spools


class Setpoint:
    """
    What the valve and the load are asked to be now.

    held: (spool 1, spool 2, load [N]) as the solver last took them; applied: how many commands
    and loads it has taken, of several within a tick only the last; commanded: whether a spool
    command holds, rather than the 0 before the first.
    """

    def __init__(
        self, timeout: float = 0.0, on_timeout: str = 'hold',
        clock: Callable[[], int] = time.monotonic_ns,
    ):
        """Take the silence [s] after which `on_timeout` (`hold`, `centre`) acts; 0 is never."""
        self.on_command: Callable[[tuple[float, float, float]], None] = lambda inputs: None
        self.timed_out = False
        self.timeouts = 0
        self.held = (*CENTRED, 0.0)
        self.applied = 0
        self.commanded = False
        self._fresh = False
        self._clock = clock
        self._spools = CENTRED
        self._load_force = 0.0
        self._accepted_ns = clock()
        self.set_timeout(timeout, on_timeout)

    def set_timeout(self, timeout: float, on_timeout: str) -> None:
        """Change what silence does."""
        self._limit = (round(timeout * 1e9), on_timeout == 'centre')

    def accept(self, spools: Spools) -> None:
        """Hold a spool command from the next tick on, and tell `on_command` what holds now."""
        self._hold(spools)
        self.commanded = self._fresh = True
        self.on_command((*spools, self._load_force))

    def accept_load(self, load_force: float) -> None:
        """Hold an external load [N] from the next tick on."""
        self._load_force = load_force
        self._fresh = True

    def centre(self) -> None:
        """Forget the spool command: 0, as before the first one."""
        self._hold(CENTRED)
        self.commanded = False

    @property
    def silence(self) -> float:
        """Time [s] since the last accepted spool command, or since `centre`."""
        return (self._clock() - self._accepted_ns) * 1e-9

    def sample(self) -> tuple[float, float, float]:
        """Return (spool 1, spool 2, load [N]) as they hold at this instant; for the solver."""
        if self._fresh:
            self._fresh = False
            self.applied += 1
        spools = self._spools
        limit_ns, centre = self._limit
        if limit_ns:
            silent = self._clock() - self._accepted_ns > limit_ns
            self.timeouts += silent and not self.timed_out
            self.timed_out = silent
            if silent and centre:
                spools = CENTRED
        else:
            self.timed_out = False
        self.held = (*spools, self._load_force)
        return self.held

    def _hold(self, spools: Spools) -> None:
        self._accepted_ns = self._clock()
        self._spools = spools
