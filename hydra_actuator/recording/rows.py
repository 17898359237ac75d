# SPDX-License-Identifier: Apache-2.0
"""
Observation rows put together again from recorded topics.

There is one row per joint state. What no topic carries is NaN: the Mach number, cavities without
fluid.cavitation, and what stands in a slower topic at instants that it left out.
"""

from collections.abc import Mapping
from dataclasses import dataclass

from hydra_actuator.channels import Channels
from hydra_actuator.recording.series import Series
import numpy as np


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

    def rows(self, channels: Channels, time: np.ndarray) -> np.ndarray:
        """Return the rows, shape (joint states, channels.width); `time` is their first column."""
        stamps = self.joints.stamps
        rows = np.full((len(stamps), channels.width), np.nan)
        if not len(stamps):
            return rows
        joints = self.joints.numbers().reshape(len(stamps), 3, -1)
        rows[:, channels.TIME] = time
        rows[:, channels.POSITION] = joints[:, 0, 0]
        rows[:, channels.VELOCITY] = joints[:, 1, 0]
        rows[:, channels.EFFORT] = joints[:, 2, 0]
        rows[:, channels.SPOOL_1] = joints[:, 0, 1]
        rows[:, channels.SPOOL_2] = joints[:, 0, channels.spools]
        rows[:, channels.LOAD_FORCE] = self._load_force(stamps)
        self._enter_sections(rows, channels, stamps)
        if len(self.cavities):
            at, chosen = _matching(stamps, self.cavities.stamps)
            rows[at, channels.cavities] = self.cavities.numbers()[chosen, 1:]
        return rows

    def _load_force(self, stamps: np.ndarray) -> np.ndarray | float:
        """Return the load [N] in force at each stamp: 0 before the first applied one."""
        if not len(self.applied):
            return 0.0
        changes = self.applied.stamps
        order = np.argsort(changes, kind='stable')
        loads = np.concatenate([[0.0], self.applied.numbers()[order, -1]])
        return loads[np.searchsorted(changes[order], stamps, 'right')]

    def _enter_sections(self, rows: np.ndarray, channels: Channels, stamps: np.ndarray) -> None:
        """Enter pressures and velocities; a pressure topic goes before the sections' array."""
        if len(self.sections):
            at, chosen = _matching(stamps, self.sections.stamps)
            values = self.sections.numbers()[chosen]
            rows[at, channels.pressure] = values[:, 1::2]
            rows[at, channels.flow_velocity] = values[:, 2::2]
        for column, name in enumerate(channels.section_names, channels.pressure.start):
            series = self.pressures.get(name, ())
            if len(series):
                at, chosen = _matching(stamps, series.stamps)
                rows[at, column] = series.numbers()[chosen, 0]


def _matching(wanted: np.ndarray, found: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the places in `wanted` whose stamps occur in `found`, and where they do."""
    order = np.argsort(found, kind='stable')
    places = np.minimum(np.searchsorted(found, wanted, sorter=order), len(found) - 1)
    chosen = order[places]
    at = np.nonzero(found[chosen] == wanted)[0]
    return at, chosen[at]
