# SPDX-License-Identifier: Apache-2.0
"""
Command signals over time: what drives an offline run at every step.

A signal answers with an array (T, 3) for times (T,) [s]: spool 1 and spool 2 (normalised, -1..1)
and load force [N].
"""

from collections.abc import Callable
from dataclasses import dataclass
import math
from pathlib import Path

from hydra_actuator.csv_files import number, read_csv, short
from hydra_actuator.errors import InputError
import numpy as np

Signal = Callable[[np.ndarray], np.ndarray]


def both_spools(spool: np.ndarray, load_force: np.ndarray | float = 0.0) -> np.ndarray:
    """Return the (T, 3) command of one spool command (T,) for both spools."""
    return np.column_stack([spool, spool, np.broadcast_to(load_force, spool.shape)])


def spool_pair(spool: float | tuple[float, float]) -> tuple[float, float]:
    """Return the commands of both spools; raises ValueError unless one or two in -1..1."""
    pair = (spool, spool) if np.ndim(spool) == 0 else tuple(spool)
    if len(pair) != 2 or not all(-1.0 <= x <= 1.0 for x in pair):
        raise ValueError(f'spool {spool!r} is not one or two numbers from -1 to 1')
    return pair


@dataclass(frozen=True)
class Hold:
    """A constant command."""

    spool: float = 0.0
    load_force: float = 0.0

    def __call__(self, times: np.ndarray) -> np.ndarray:
        """Return the command (T, 3) at times [s]."""
        return both_spools(np.full(times.shape, self.spool), self.load_force)


@dataclass(frozen=True)
class Sine:
    """amplitude sin(2 pi frequency t), frequency [Hz]."""

    frequency: float
    amplitude: float = 1.0

    def __call__(self, times: np.ndarray) -> np.ndarray:
        """Return the command (T, 3) at times [s]."""
        return both_spools(self.amplitude * np.sin(2.0 * math.pi * self.frequency * times))


@dataclass(frozen=True)
class Step:
    """0 before `start` [s], amplitude from then on."""

    amplitude: float = 1.0
    start: float = 0.0

    def __call__(self, times: np.ndarray) -> np.ndarray:
        """Return the command (T, 3) at times [s]."""
        return both_spools(np.where(times >= self.start, self.amplitude, 0.0))


@dataclass(frozen=True)
class Chirp:
    """A sine whose frequency rises linearly from `first` to `last` [Hz] over `duration` [s]."""

    first: float
    last: float
    duration: float
    amplitude: float = 1.0

    def __call__(self, times: np.ndarray) -> np.ndarray:
        """Return the command (T, 3) at times [s]."""
        rate = (self.last - self.first) / self.duration
        phase = 2.0 * math.pi * (self.first + 0.5 * rate * times) * times
        return both_spools(self.amplitude * np.sin(phase))


@dataclass(frozen=True)
class Table:
    """Rows of a file: linear between rows, or each held until the next; constant beyond."""

    times: np.ndarray
    spool: np.ndarray
    load_force: np.ndarray
    hold: bool = False

    @property
    def duration(self) -> float:
        """Time of the last row [s]."""
        return float(self.times[-1])

    def __call__(self, times: np.ndarray) -> np.ndarray:
        """Return the command (T, 3) at times [s]."""
        if self.hold:
            row = np.maximum(np.searchsorted(self.times, times, side='right') - 1, 0)
            return both_spools(self.spool[row], self.load_force[row])
        # Rounding in the interpolation can pass full spool by a unit in the last place.
        spool = np.clip(np.interp(times, self.times, self.spool), -1.0, 1.0)
        return both_spools(spool, np.interp(times, self.times, self.load_force))


def read_table(path: str | Path, hold: bool = False) -> Table:
    """
    Read a command file: CSV with header `time,spool` and optionally `load_force`.

    Raises InputError naming file, line and limit for anything else.
    """
    path = Path(path)
    rows = read_csv(path, 'time,spool')
    header = [name.strip() for name in rows[0][1]]
    if header not in (['time', 'spool'], ['time', 'spool', 'load_force']):
        raise InputError(
            f'{path}: header {short(",".join(header))} is neither time,spool nor '
            'time,spool,load_force')
    values = [_numbers(path, line, row, header) for line, row in rows[1:]]
    if not values:
        raise InputError(f'{path} has no rows below its header')
    table = np.array([numbers for _, numbers in values])
    for k in np.flatnonzero(np.diff(table[:, 0]) <= 0.0):
        raise InputError(f'{path}, line {values[k + 1][0]}: time {table[k + 1, 0]:g} s does not '
                         f'increase after {table[k, 0]:g} s')
    load_force = table[:, 2] if len(header) == 3 else np.zeros(len(table))
    return Table(table[:, 0], table[:, 1], load_force, hold)


def _numbers(path: Path, line: int, row: list[str], header: list[str]) -> tuple[int, list[float]]:
    if len(row) != len(header):
        raise InputError(f'{path}, line {line}: {len(row)} values for {len(header)} columns')
    try:
        numbers = [number(cell, name) for name, cell in zip(header, row)]
    except InputError as error:
        raise InputError(f'{path}, line {line}: {error}') from None
    if not -1.0 <= numbers[1] <= 1.0:
        raise InputError(f'{path}, line {line}: spool {numbers[1]:g} is not within -1 to 1')
    if numbers[0] < 0.0:
        raise InputError(f'{path}, line {line}: time {numbers[0]:g} s is before 0')
    return line, numbers
