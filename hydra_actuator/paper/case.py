# SPDX-License-Identifier: Apache-2.0
"""
The cases that are drawn: the paper's 16.25 Hz at full stroke, and beside it 200 Hz at 0.3 of it.

At 200 Hz the drive is as fast as the waves: a period is 3.25 units of L/c. Each is there as the
plain model, which is the paper's, and with cavitation, so that no pressure falls below vapour.
"""

from collections.abc import Callable
from dataclasses import dataclass

from hydra_actuator.paper.runs import FREQUENCY, reference, Run
import numpy as np

FAST_FREQUENCY, FAST_AMPLITUDE = 200.0, 0.3
# What the surfaces show: the paper's run, which ends here; four periods at 200 Hz [L/c].
SHOWN_UNITS, FAST_SHOWN_UNITS = 50.577, 13.0


@dataclass(frozen=True)
class Case:
    """One run to draw: name (part of the files' names), title, what makes the run."""

    name: str
    title: str
    cavitation: bool
    frequency: float = FREQUENCY
    amplitude: float = 1.0
    duration: float | None = None       # [s]; None: one second, or ten periods at 200 Hz
    cells: int = 200
    fast: bool = False                  # the one beside the paper's: some figures only

    @property
    def suffix(self) -> str:
        """What follows the figure's name in the name of its file."""
        return '' if self.name == 'plain' else f'_{self.name}'

    def run(self, passes: int = 2, progress: Callable[[float], None] | None = None) -> Run:
        """Return the run with so many passes over slope and friction, made at the first call."""
        return reference(self.cavitation, passes, self.frequency, self.amplitude, self.duration,
                         self.cells, progress)

    def shown(self, run: Run) -> np.ndarray:
        """Return which steps the surfaces show, (T,)."""
        return run.tau <= (FAST_SHOWN_UNITS if self.fast else SHOWN_UNITS)


CASES = {case.name: case for case in (
    Case('plain', '16.25 Hz, plain model', False),
    Case('cavitation', '16.25 Hz, with cavitation', True),
    Case('200hz', '200 Hz at 0.3 of the stroke, plain model', False, FAST_FREQUENCY,
         FAST_AMPLITUDE, fast=True),
    Case('200hz_cavitation', '200 Hz at 0.3 of the stroke, with cavitation', True,
         FAST_FREQUENCY, FAST_AMPLITUDE, fast=True),
)}
