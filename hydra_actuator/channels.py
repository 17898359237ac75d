# SPDX-License-Identifier: Apache-2.0
"""
The one table of observable quantities: name, unit, and where an observation row holds it.

A row is one float64 vector per instant:

    time, position, velocity, effort, spool_1, spool_2, load_force, mach,
    pressure of each section (absolute), flow velocity of each section (positive pump to tank)
"""

from dataclasses import dataclass

import numpy as np

STATIONS = ('O', 'A', 'B', 'C', 'D', 'E', 'F', 'G', 'H', 'I', 'J', 'K')


@dataclass(frozen=True)
class Channel:
    """One observable quantity: its name, unit and column in a row."""

    name: str
    unit: str
    column: int


class Channels:
    """
    The columns of an observation row for given sections.

    section_names: names in their order; spools: 1 or 2 (both columns exist, one spool moves both).
    """

    TIME, POSITION, VELOCITY, EFFORT, SPOOL_1, SPOOL_2, LOAD_FORCE, MACH = range(8)
    SCALARS = (
        ('time', 's'), ('position', 'm'), ('velocity', 'm/s'), ('effort', 'N'),
        ('spool_1', 'm'), ('spool_2', 'm'), ('load_force', 'N'), ('mach', '-'))

    def __init__(self, section_names: tuple[str, ...], spools: int = 1) -> None:
        self.section_names = tuple(section_names)
        self.spools = spools
        count, first = len(self.section_names), len(self.SCALARS)
        self.pressure = slice(first, first + count)
        self.flow_velocity = slice(first + count, first + 2 * count)
        self.width = first + 2 * count

    def table(self) -> tuple[Channel, ...]:
        """Return all channels in the order of the columns."""
        names = list(self.SCALARS)
        names += [(f'pressure.{name}', 'Pa') for name in self.section_names]
        names += [(f'flow_velocity.{name}', 'm/s') for name in self.section_names]
        return tuple(Channel(name, unit, k) for k, (name, unit) in enumerate(names))

    def empty_row(self) -> np.ndarray:
        """Return a row of zeros, shape (width,)."""
        return np.zeros(self.width)
