# SPDX-License-Identifier: Apache-2.0
"""All that compiled code needs to solve one period after the other, and what it notes of each."""

from typing import NamedTuple

from hydra_actuator.channels import Channels
from hydra_actuator.core.records import Model, State
import numpy as np

MACH = Channels.MACH
# What counts as below vacuum [Pa]: 0, less what rounding leaves.
VACUUM = -1.0
# largest_mach: |u|/c at any tick; vacuum_ticks: at how many ticks absolute pressure was below 0.
EXTREMES = np.dtype([('largest_mach', np.float64), ('vacuum_ticks', np.int64)], align=True)


class Solver(NamedTuple):
    """
    An actuator's arrays, with which core.advance and core.observe are called.

    steps: in a period; row: the observation, lowest: its column of the lowest pressure;
    extremes (1,): noted.
    """

    model: Model
    state: State
    passes: tuple[int, ...]
    schedule: tuple[np.ndarray, np.ndarray, bool]
    inputs: np.ndarray
    steps: int
    sections: np.ndarray
    ambient: float
    row: np.ndarray
    lowest: int
    extremes: np.ndarray


def note_extremes(extremes, row, lowest):
    """Take note of a period's observation."""
    noted = extremes[0]
    if row[lowest] < VACUUM:
        noted['vacuum_ticks'] += 1
    if row[MACH] > noted['largest_mach']:
        noted['largest_mach'] = row[MACH]
