# SPDX-License-Identifier: Apache-2.0
"""
What the instruments are like: one number per signal, from `sensor.*` and the signal faults.

A signal is a column that is published as a reading: position, velocity, effort, each spool, each
pressure. `fault.spool.*` is for every spool.
"""

from collections.abc import Mapping
from dataclasses import dataclass

from hydra_actuator.channels import Channels
import numpy as np

NOISES = {'position': 'sensor.position_noise', 'velocity': 'sensor.velocity_noise',
          'pressure': 'sensor.pressure_noise'}
RESOLUTIONS = {'position': 'sensor.position_resolution', 'pressure': 'sensor.pressure_resolution'}


class Signals:
    """Names, columns and quantities of what is read, all in the same order."""

    def __init__(self, channels: Channels):
        spools = range(channels.spools)
        names = channels.section_names
        self.names = (
            'position', 'velocity', 'effort', *(f'spool_{k + 1}' for k in spools),
            *(f'pressure.{name}' for name in names))
        self.columns = (
            channels.POSITION, channels.VELOCITY, channels.EFFORT,
            *(channels.SPOOL_1 + k for k in spools),
            *range(channels.pressure.start, channels.pressure.stop))
        self.quantities = (
            'position', 'velocity', 'effort', *('spool' for _ in spools),
            *(f'pressure.{name}' for name in names))


@dataclass(frozen=True, eq=False)
class Settings:
    """
    How each signal is read; arrays of shape (signals,).

    delay, time_constant [s]; offset, sensor_noise, fault_noise (standard deviations) and
    resolution in the signal's unit; off and stuck are claims; dropout a probability.
    variance: of the simulated sensor's pressures [Pa^2], its quantisation included.
    """

    delay: np.ndarray
    time_constant: np.ndarray
    offset: np.ndarray
    sensor_noise: np.ndarray
    fault_noise: np.ndarray
    resolution: np.ndarray
    stuck: np.ndarray
    off: np.ndarray
    dropout: np.ndarray
    seed: int
    variance: float

    @property
    def affected(self) -> np.ndarray:
        """Which signals are not read as they are."""
        return np.any([
            self.delay, self.time_constant, self.offset, self.sensor_noise, self.fault_noise,
            self.resolution, self.stuck, self.off, self.dropout], axis=0)


def settings(
    signals: Signals, sensor: Mapping[str, object], faults: Mapping[str, object]
) -> Settings:
    """
    Return how the signals are read.

    sensor: holds the values of `sensor.*`; faults: those at work, by parameter; what is not there
    is none.
    """
    def fault(kind: str) -> np.ndarray:
        return np.array([
            float(faults.get(f'fault.{quantity}.{kind}', 0.0)) for quantity in signals.quantities])

    def sensors(table: Mapping[str, str]) -> np.ndarray:
        kinds = [quantity.partition('.')[0] for quantity in signals.quantities]
        return np.array([sensor[table[kind]] if kind in table else 0.0 for kind in kinds])

    return Settings(
        delay=sensor['sensor.delay'] + fault('delay'), time_constant=fault('time_constant'),
        offset=fault('offset'), sensor_noise=sensors(NOISES), fault_noise=fault('noise'),
        resolution=sensors(RESOLUTIONS), stuck=fault('stuck') > 0.0, off=fault('off') > 0.0,
        dropout=fault('dropout'), seed=sensor['sensor.seed'],
        variance=(sensor['sensor.pressure_noise'] ** 2
                  + sensor['sensor.pressure_resolution'] ** 2 / 12.0))
