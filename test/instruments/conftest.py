# SPDX-License-Identifier: Apache-2.0
"""Instruments on made-up rows."""

from hydra_actuator.channels import Channels
from hydra_actuator.instruments import Instruments
from hydra_actuator.parameters import Parameters
import numpy as np
import pytest

PERIOD, STEPS = 1e-3, 10
STEP_TIME = PERIOD / STEPS


class Bench:
    """Instruments with two sections, read at the ticks or between them."""

    def __init__(self, faults=None, spools=1, remember=False, **sensor):
        self.channels = Channels(('A', 'B'), spools)
        self.instruments = Instruments(self.channels, STEP_TIME, STEPS)
        self.set(faults, remember, **sensor)

    def set(self, faults=None, remember=False, **sensor):
        self.sensor = Parameters({f'sensor.{name}': value for name, value in sensor.items()})
        self.instruments.set(self.sensor, faults or {}, remember)

    def row(self, step):
        """Return a row whose values say column and step."""
        row = 1000.0 * np.arange(self.channels.width) + step
        row[Channels.TIME] = step * STEP_TIME
        if self.channels.spools == 1:
            row[Channels.SPOOL_2] = row[Channels.SPOOL_1]
        return row.tolist()

    def read(self, step):
        return self.instruments.read(self.row(step))

    def rows(self, ticks, first=0):
        """Return (truth, readings) of ticks, shape (ticks, width)."""
        steps = [STEPS * tick for tick in range(first, first + ticks)]
        return (np.array([self.row(step) for step in steps]),
                np.array([self.read(step) for step in steps]))


@pytest.fixture
def make():
    """Make a bench: instruments as `sensor.*` (without the prefix) and faults say."""
    return Bench
