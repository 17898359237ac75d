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
import numpy as np


@dataclass(frozen=True)
class Field:
    """
    Pressure and velocity over streamline and time.

    `positions` are those at mid-stroke; the nodes `faces` (of both piston faces) move with the
    piston. Nodes that the piston has left behind are NaN.
    """

    time: np.ndarray          # (frames,) [s]
    positions: np.ndarray     # (nodes,) [m]
    labels: tuple[str, ...]   # (nodes,) name of the domain
    pressure: np.ndarray      # (frames, nodes) absolute [Pa]
    velocity: np.ndarray      # (frames, nodes) [m/s]
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
        if key not in self._extremes:
            self._extremes[key] = bucket_extremes(getattr(self, quantity), buckets)
        return self._extremes[key]

    def between(self, start: float, end: float) -> 'Field':
        """Return the frames of start <= time <= end [s], half an interval added."""
        margin = 0.5 * self.interval if len(self.time) > 1 else 0.0
        shown = slice(*np.searchsorted(self.time, [start - margin, end + margin]))
        return Field(
            self.time[shown], self.positions, self.labels, self.pressure[shown],
            self.velocity[shown], self.faces, self.source,
        )

    def having(self, quantity: str) -> 'Field':
        """Return the frames in which 'pressure' or 'velocity' was recorded."""
        known = np.isfinite(getattr(self, quantity)).any(axis=1)
        return self if known.all() else dataclasses.replace(
            self, time=self.time[known], pressure=self.pressure[known],
            velocity=self.velocity[known])


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
