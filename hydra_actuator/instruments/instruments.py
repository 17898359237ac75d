# SPDX-License-Identifier: Apache-2.0
"""
The instruments: from the truth of a row to what is read of it.

    truth -> delay -> first-order lag -> offset -> noise -> resolution -> stuck -> off, dropout
             sensor   fault              fault     both     sensor        fault    NaN
             + fault

An instrument samples at the ticks: what it remembers (past truth, the lag, the last reading)
changes there only, so a row between two ticks is read without a trace, and readings do not
depend on how often they are published. Where nothing acts a row is returned as it is.
"""

from collections.abc import Mapping
import math

from hydra_actuator.channels import Channels
from hydra_actuator.instruments.draws import Draws
from hydra_actuator.instruments.history import History
from hydra_actuator.instruments.settings import Settings, settings, Signals
import numpy as np

# The sensor's delay and a fault's on top of it [s].
LONGEST_DELAY = 20.0
# A delay this near to whole ticks is whole ticks.
WHOLE = 1e-6


class Instruments:
    """
    Reads rows in the order of time.

    An earlier time is a new beginning; the same row again reads as before.
    steps_per_period: solver steps from one tick to the next, of `step_time` [s] each.
    """

    def __init__(self, channels: Channels, step_time: float, steps_per_period: int):
        self.channels = channels
        self._signals = Signals(channels)
        self._columns = list(self._signals.columns)
        self._twin = channels.spools == 1
        self._step_time = step_time
        self._steps_per_period = steps_per_period
        self._step = -1
        self._history: History | None = None
        self.acting = False
        self.variance = 0.0
        self._remembering = False

    def set(self, sensor: Mapping[str, object], faults: Mapping[str, object],
            remember: bool = False) -> None:
        """
        Read like this from the next row on.

        sensor: holds `sensor.*`; faults: those at work by parameter; remember: keep what a fault
        that comes later would want to know.
        """
        new = settings(self._signals, sensor, faults)
        self._settings: Settings = new
        self._affected = new.affected
        self._delays, self._lags = new.delay.any(), new.time_constant.any()
        self._sticks, self._misses = new.stuck.any(), new.off.any() or new.dropout.any()
        self._resolves, self._fine = new.resolution > 0.0, None
        if self._resolves.any():
            self._fine = np.where(self._resolves, new.resolution, 1.0)
        self.variance = new.variance
        self.acting = bool(self._affected.any())
        self._remembering = remember or self.acting
        self._truth_row: list[float] | None = None
        period = self._step_time * self._steps_per_period
        ticks = new.delay / period
        self._delay = np.where(abs(ticks - np.round(ticks)) < WHOLE, np.round(ticks), ticks)
        self._noises = [
            (deviation, self._draws(purpose))
            for purpose, deviation in (('sensor', new.sensor_noise), ('fault', new.fault_noise))
            if deviation.any()]
        self._dropout = self._draws('dropout')
        if self._history is None and (remember or new.delay.any()):
            capacity = math.ceil(LONGEST_DELAY / period) + 3
            self._history = History(len(self._columns), capacity)
            self._step = -1

    def _draws(self, purpose: str) -> Draws:
        return Draws(self._settings.seed, purpose, self._signals.names, self._steps_per_period)

    def read(self, row: list[float]) -> list[float]:
        """Return the row with its signals as they are read; the row itself where nothing acts."""
        if not self._remembering:
            return row
        step = round(row[Channels.TIME] / self._step_time)
        if step == self._step and row == self._truth_row:
            return self._read_row
        truth = np.array(row)[self._columns]
        if step <= self._step or self._step < 0:
            self._begin()
        self._step = step
        at_tick = step % self._steps_per_period == 0
        if at_tick and self._history is not None:
            self._history.append(step // self._steps_per_period, truth)
        late, lagging, reading = truth, truth, truth
        if self.acting:
            late = self._late(truth, step)
            lagging = self._lagging(late, step)
            reading = self._reading(lagging, truth, step)
        if at_tick:
            self._at_last_tick = (step, late, lagging, reading)
        self._truth_row = row
        self._read_row = self._entered(row, reading, step) if self.acting else row
        return self._read_row

    def _begin(self) -> None:
        """Forget what was: this is the first row."""
        self._at_last_tick: tuple[int, np.ndarray, np.ndarray, np.ndarray] | None = None
        if self._history is not None:
            self._history.forget()

    def _late(self, truth: np.ndarray, step: int) -> np.ndarray:
        """Return the signals as they were before their delays."""
        if self._history is None or not self._delays:
            return truth
        now = step / self._steps_per_period
        return self._history.at(now - self._delay, now, truth)

    def _lagging(self, signal: np.ndarray, step: int) -> np.ndarray:
        """
        Return the signals after their first-order lags T y' + y = x.

        Exact for a signal that is linear from the last tick until now; a lag begins at rest.
        """
        if self._at_last_tick is None or not self._lags:
            return signal
        lag = self._settings.time_constant
        step_before, before, response, _ = self._at_last_tick
        time = (step - step_before) * self._step_time
        decay = np.exp(-time / np.maximum(lag, 1e-300))
        response = (decay * response + (1.0 - decay) * before
                    + (1.0 - lag * (1.0 - decay) / time) * (signal - before))
        return np.where(lag > 0.0, response, signal)

    def _reading(self, signal: np.ndarray, truth: np.ndarray, step: int) -> np.ndarray:
        """Return what the instruments make of the signals; those nothing acts on stay true."""
        own = self._settings
        value = signal + own.offset
        for deviation, draws in self._noises:
            value = value + deviation * draws.normal(step)
        if self._fine is not None:
            value = np.where(self._resolves, np.rint(value / self._fine) * self._fine, value)
        value = np.where(self._affected, value, truth)
        if self._sticks and self._at_last_tick is not None:
            value = np.where(own.stuck, self._at_last_tick[3], value)
        return value

    def _entered(self, row: list[float], reading: np.ndarray, step: int) -> list[float]:
        """Return a copy of the row with the readings, NaN for those that are missing."""
        own = self._settings
        if self._misses:
            missing = own.off | (self._dropout.uniform(step) < own.dropout)
            reading = np.where(missing, math.nan, reading)
        read = row.copy()
        for column, value in zip(self._columns, reading.tolist()):
            read[column] = value
        if self._twin:
            read[Channels.SPOOL_2] = read[Channels.SPOOL_1]
        return read
