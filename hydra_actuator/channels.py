# SPDX-License-Identifier: Apache-2.0
"""
The one table of observable quantities: name, unit, and where an observation row holds it.

A row is one float64 vector per instant:

    time, position, velocity, effort, spool_1, spool_2, load_force, mach,
    pressure of each section (absolute), flow velocity of each section (positive pump to tank),
    cavity_volume, lowest_pressure (absolute, anywhere), cavities_open, cavities_opened,
    cavities_collapsed, cavity_volume of each domain

What a cavity is: hydra_actuator.core.boiling. Its counts are those of the last whole period.
"""

from dataclasses import dataclass

import numpy as np

STATIONS = ('O', 'A', 'B', 'C', 'D', 'E', 'F', 'G', 'H', 'I', 'J', 'K')
DOMAINS = ('supply_line', 'line_1', 'chamber_1', 'chamber_2', 'line_2', 'return_line')


@dataclass(frozen=True)
class Channel:
    """One observable quantity: its name, unit and column in a row."""

    name: str
    unit: str
    column: int


class Channels:
    """
    The columns of an observation row for given sections.

    section_names: names in their order; spools: 1 or 2 (both columns exist, one spool moves both);
    domains: names in the order of the streamline.
    """

    TIME, POSITION, VELOCITY, EFFORT, SPOOL_1, SPOOL_2, LOAD_FORCE, MACH = range(8)
    SCALARS = (
        ('time', 's'), ('position', 'm'), ('velocity', 'm/s'), ('effort', 'N'),
        ('spool_1', 'm'), ('spool_2', 'm'), ('load_force', 'N'), ('mach', '-'))
    CAVITY_SCALARS = (
        ('cavity_volume', 'm^3'), ('lowest_pressure', 'Pa'), ('cavities_open', '-'),
        ('cavities_opened', '-'), ('cavities_collapsed', '-'))

    def __init__(self, section_names: tuple[str, ...], spools: int = 1,
                 domains: tuple[str, ...] = DOMAINS) -> None:
        self.section_names = tuple(section_names)
        self.spools = spools
        self.domains = tuple(domains)
        count, first = len(self.section_names), len(self.SCALARS)
        self.pressure = slice(first, first + count)
        self.flow_velocity = slice(first + count, first + 2 * count)
        start = first + 2 * count
        (self.cavity_volume, self.lowest_pressure, self.cavities_open, self.cavities_opened,
         self.cavities_collapsed) = range(start, start + len(self.CAVITY_SCALARS))
        self.width = start + len(self.CAVITY_SCALARS) + len(self.domains)
        self.cavities = slice(start, self.width)
        self.domain_cavities = slice(self.width - len(self.domains), self.width)

    def table(self) -> tuple[Channel, ...]:
        """Return all channels in the order of the columns."""
        names = list(self.SCALARS)
        names += [(f'pressure.{name}', 'Pa') for name in self.section_names]
        names += [(f'flow_velocity.{name}', 'm/s') for name in self.section_names]
        names += self.cavity_names()
        return tuple(Channel(name, unit, k) for k, (name, unit) in enumerate(names))

    def cavity_names(self) -> list[tuple[str, str]]:
        """Return (name, unit) of the columns about cavities, `cavities`, in order."""
        return [*self.CAVITY_SCALARS,
                *((f'cavity_volume.{name}', 'm^3') for name in self.domains)]

    def empty_row(self) -> np.ndarray:
        """Return a row of zeros, shape (width,)."""
        return np.zeros(self.width)
