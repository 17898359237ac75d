# SPDX-License-Identifier: Apache-2.0
"""Free run: as fast as it goes; who cannot follow holds it up and loses nothing."""

import time

from hydra_actuator.ros import statuses
from hydra_actuator.ros.clocks.source import Grant, OwnTime


class Free(OwnTime):
    """Grants a tick whenever asked."""

    def __init__(self, period: float):
        super().__init__(period)
        self._began = self._elapsed = 0.0

    def start(self, last_stamp: int) -> int:
        """Go on from the last state."""
        self._began = time.monotonic()
        return super().start(last_stamp)

    def stop(self) -> None:
        """Stop counting the time that passes."""
        self._elapsed += time.monotonic() - self._began
        self._began = 0.0

    def wait(self) -> Grant | None:
        """Grant a tick."""
        return self.out_of_turn(0)

    def status(self) -> statuses.Status:
        """Return how fast it goes."""
        running = time.monotonic() - self._began if self._began else 0.0
        elapsed = self._elapsed + running
        factor = self.ticks * self.period / elapsed if elapsed else 0.0
        return statuses.Status('Real time', statuses.OK, 'free_run', {
            'mode': 'free_run', 'ticks': str(self.ticks), 'real_time_factor': f'{factor:.6f}',
            'stamp': f'{self.stamp * 1e-9:.9f}'})
