# SPDX-License-Identifier: Apache-2.0
"""
Observation rows put together again from recorded topics.

There is one row per joint state. What no topic carries is NaN: the Mach number, cavities without
fluid.cavitation, and what stands in a slower topic at instants that it left out.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from hydra_actuator.channels import Channels
from hydra_actuator.recording.series import in_one_pass, Series
import numpy as np

# Of each topic: columns of the rows, and which of its numbers each takes.
Places = Mapping[Series, list[tuple[int, int]]]


@dataclass(frozen=True)
class StateTopics:
    """The topics rows are made of; `pressures` by section."""

    joints: Series
    sections: Series
    applied: Series
    cavities: Series
    pressures: Mapping[str, Series]

    def channels(self) -> Channels:
        """Return the columns, by the sections and the spools that were recorded."""
        if len(self.sections):
            dimension = self.sections.first()['layout']['dim'][0]
            names = tuple(dimension['label'].split(',')) if dimension['size'] else ()
            if len(names) != dimension['size']:
                raise ValueError(f'{self.sections.topic} names {len(names)} sections '
                                 f'and holds {dimension["size"]}')
        else:
            names = tuple(self.pressures)
        spools = len(self.joints.first()['name']) - 1 if len(self.joints) else 1
        return Channels(names, spools)

    def rows(self, channels: Channels, columns: Sequence[int] | None = None) -> np.ndarray:
        """
        Return the rows, shape (joint states, channels.width), each column in one piece.

        columns: those wanted, in this order, by default all. The first, TIME [s], counts from
        the first joint state.
        """
        stamps = self.joints.stamps
        wanted = range(channels.width) if columns is None else columns
        rows = np.full((len(stamps), len(wanted)), np.nan, order='F')
        into = {column: rows[:, place] for place, column in enumerate(wanted)}
        if not len(stamps):
            return rows
        if channels.TIME in into:
            into[channels.TIME][:] = (stamps - stamps[0]) / 1e9
        if channels.LOAD_FORCE in into:
            into[channels.LOAD_FORCE][:] = self._load_force(stamps)
        instants = Instants(stamps)
        for wanted in self._places(channels):
            _enter(into, instants, wanted)
        return rows

    def _places(self, channels: Channels) -> list[Places]:
        """Return columns by topic, in two passes: a pressure topic goes before the sections'."""
        spools, count = channels.spools, len(channels.section_names)
        joints = 1 + spools
        whole = {
            self.joints: [(channels.POSITION, 0), (channels.VELOCITY, joints),
                          (channels.EFFORT, 2 * joints), (channels.SPOOL_1, 1),
                          (channels.SPOOL_2, spools)],
            self.sections: [(column, 1 + 2 * k + part) for k in range(count)
                            for part, column in enumerate((channels.pressure.start + k,
                                                           channels.flow_velocity.start + k))],
            self.cavities: [(column, 1 + k) for k, column in
                            enumerate(range(channels.cavities.start, channels.cavities.stop))],
        }
        single = {self.pressures[name]: [(channels.pressure.start + k, 0)]
                  for k, name in enumerate(channels.section_names) if name in self.pressures}
        return [whole, single]

    def _load_force(self, stamps: np.ndarray) -> np.ndarray | float:
        """Return the load [N] in force at each stamp: 0 before the first applied one."""
        if not len(self.applied):
            return 0.0
        changes = self.applied.stamps
        order = np.argsort(changes, kind='stable')
        loads = np.concatenate([[0.0], self.applied.numbers()[order, -1]])
        return loads[np.searchsorted(changes[order], stamps, 'right')]


class Instants:
    """The stamps of rows (N,) [ns], to be found again; they may repeat."""

    def __init__(self, stamps: np.ndarray):
        steps = np.diff(stamps)
        self._rising = bool((steps > 0).all())
        self._order = None
        self._sorted = stamps
        if (steps < 0).any():
            self._order = np.argsort(stamps, kind='stable')
            self._sorted = stamps[self._order]

    def find(self, stamps: np.ndarray) -> tuple[np.ndarray | slice, np.ndarray | slice]:
        """Return the rows at these stamps, and which of the stamps each has, last ones first."""
        if self._rising and len(stamps):
            # Nearly always a topic has a message for each row.
            begin = int(np.searchsorted(self._sorted, stamps[0]))
            rows = slice(begin, begin + len(stamps))
            if np.array_equal(self._sorted[rows], stamps):
                return rows, slice(None)
        first, end = (np.searchsorted(self._sorted, stamps, side) for side in ('left', 'right'))
        counts = end - first
        chosen = np.repeat(np.arange(len(stamps)), counts)
        within = np.arange(len(chosen)) - np.repeat(np.cumsum(counts) - counts, counts)
        at = first[chosen] + within
        return (at if self._order is None else self._order[at])[::-1], chosen[::-1]


def _enter(into: Mapping[int, np.ndarray], instants: Instants, wanted: Places) -> None:
    """Enter the numbers of topics where their stamps are; of equal stamps in a block the first."""
    for part in in_one_pass(series for series, places in wanted.items()
                            if any(column in into for column, _ in places)):
        at, chosen = instants.find(part.stamps)
        for column, number in wanted[part.series]:
            if column in into and number < part.numbers.shape[1]:
                into[column][at] = part.numbers[chosen, number]
