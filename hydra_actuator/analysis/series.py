# SPDX-License-Identifier: Apache-2.0
"""
A recording as plain arrays, on one time axis, for numbers and figures.

Time is in seconds from the first record, pressures are absolute [Pa], x is measured along the
streamline from pump to tank [m]. Missing parts are empty or None: a picture says so itself.
"""

import dataclasses
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from hydra_actuator.analysis.decimation import bucket_extremes
from hydra_actuator.analysis.frames import Frames
import numpy as np

BUCKETS = 200           # among which an extreme is looked for


@dataclass(frozen=True)
class Field:
    """
    Pressure and velocity over streamline and time.

    `positions` are those at mid-stroke; the nodes `faces` (of both piston faces) move with the
    piston. Nodes that the piston has left behind are NaN. Of a recording, pressure and velocity
    are read when they are looked at: see `frames`.
    """

    time: np.ndarray          # (frames,) [s]
    positions: np.ndarray     # (nodes,) [m]
    labels: tuple[str, ...]   # (nodes,) name of the domain
    pressure: np.ndarray | Frames   # (frames, nodes) absolute [Pa]
    velocity: np.ndarray | Frames   # (frames, nodes) [m/s]
    faces: tuple[int, int] | None
    source: str

    @property
    def interval(self) -> float:
        """
        Return the usual time between frames [s]; infinite for fewer than two frames.

        The mean, gaps left out: instants between two steps of the solver are at the next step.
        """
        if len(self.time) < 2:
            return np.inf
        steps = np.diff(self.time)
        return float(np.mean(steps[steps <= 1.5 * np.median(steps)]))

    @cached_property
    def _extremes(self) -> dict:
        """Hold what `extremes` has found: of a long run it takes seconds."""
        return {}

    def extremes(self, quantity: str, buckets: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return `bucket_extremes` of 'pressure' or 'velocity'."""
        key = quantity, buckets
        finer = [n for name, n in self._extremes if name == quantity and n > 1]
        if key not in self._extremes:
            if buckets == 1 and finer:
                _, lowest, highest = self._extremes[quantity, finer[0]]
                self._extremes[key] = (np.zeros(1, int), np.fmin.reduce(lowest)[None],
                                       np.fmax.reduce(highest)[None])
            else:
                self._extremes[key] = bucket_extremes(getattr(self, quantity), buckets)
        return self._extremes[key]

    def lowest_pressure(self) -> tuple[float, int, int] | None:
        """Return the lowest pressure [Pa], its frame and its node; None if there is none."""
        known = [n for quantity, n in self._extremes if quantity == 'pressure' and n > 1]
        starts, lowest, _ = self.extremes('pressure', max(known, default=BUCKETS))
        if not np.isfinite(lowest).any():
            return None
        bucket = int(np.nanargmin(lowest) // lowest.shape[1])
        first, end = [*starts, len(self.time)][bucket: bucket + 2]
        values = np.asarray(self.pressure[first:end])
        frame, node = np.unravel_index(np.nanargmin(values), values.shape)
        return float(values[frame, node]), int(first + frame), int(node)

    def between(self, start: float, end: float) -> 'Field':
        """Return the frames of start <= time <= end [s], half an interval added."""
        margin = 0.5 * self.interval if len(self.time) > 1 else 0.0
        return self.at(slice(*np.searchsorted(self.time, [start - margin, end + margin])))

    def at(self, frames: slice | np.ndarray) -> 'Field':
        """Return the frames of a slice, a mask or ascending places."""
        return dataclasses.replace(self, time=self.time[frames], pressure=self.pressure[frames],
                                   velocity=self.velocity[frames])

    def having(self, quantity: str) -> 'Field':
        """
        Return the frames in which 'pressure' or 'velocity' was recorded.

        A recorded frame holds both.
        """
        if isinstance(self.pressure, Frames):
            return self
        known = np.isfinite(getattr(self, quantity)).any(axis=1)
        return self if known.all() else self.at(known)


@dataclass(frozen=True)
class Command:
    """The messages of one command topic: receive time [s], values as sent (messages, n)."""

    topic: str
    time: np.ndarray
    values: np.ndarray


@dataclass(frozen=True)
class Cavities:
    """Cavities over time: counts since the start, volumes [m^3], of all and by domain."""

    time: np.ndarray          # (messages,) [s]
    volume: np.ndarray        # (messages,)
    open: np.ndarray          # (messages,) now
    opened: np.ndarray        # (messages,)
    collapsed: np.ndarray     # (messages,)
    domains: tuple[str, ...]
    of_domain: np.ndarray     # (messages, domains) volume


@dataclass(frozen=True)
class Report:
    """One status of /diagnostics: time [s], name, level, message, the texts of its values."""

    time: float
    name: str
    level: int
    message: str
    values: dict[str, str]


@dataclass(frozen=True)
class Series:
    """Everything the figures show. Arrays over ticks have the length of `time`."""

    name: str
    time: np.ndarray                     # (ticks,) [s]
    position: np.ndarray                 # [m]
    velocity: np.ndarray                 # [m/s]
    spool: np.ndarray                    # (ticks, spools) displacement [m]
    load_force: np.ndarray               # [N]
    section_names: tuple[str, ...]
    section_positions: np.ndarray        # (sections,) [m]; empty if not recorded
    pressure: np.ndarray                 # (ticks, sections) absolute [Pa]
    flow_velocity: np.ndarray            # (ticks, sections) [m/s]
    stamps: np.ndarray                   # (ticks,) [ns]
    field: Field | None = None
    commands: tuple[Command, ...] = ()
    applied: Command | None = None
    diagnostics: tuple[Report, ...] = ()
    send_delay: np.ndarray = dataclasses.field(default_factory=lambda: np.empty(0))  # [s]
    parameters: dict = dataclasses.field(default_factory=dict)
    versions: dict = dataclasses.field(default_factory=dict)
    cavities: Cavities | None = None     # without gas there are none
    source: str = ''
    path: Path | None = None

    def extreme_pressure(self, word: str) -> tuple[float, int, int] | None:
        """
        Return the 'highest' or the 'lowest' pressure [Pa] of all sections, its tick and section.

        The first one, if there are several; None if no pressure was recorded.
        """
        choose, sign = (np.nanargmax, -1.0) if word == 'highest' else (np.nanargmin, 1.0)
        ticks = [(int(choose(column)), k) for k, column in enumerate(self.pressure.T)
                 if np.isfinite(column).any()]
        if not ticks:
            return None
        tick, k = min(ticks, key=lambda one: (sign * self.pressure[one], *one))
        return float(self.pressure[tick, k]), tick, k
