# SPDX-License-Identifier: Apache-2.0
"""One line of a verification: what was expected, what came out, how far apart they may be."""

from collections.abc import Callable
from dataclasses import dataclass


@dataclass(frozen=True)
class Row:
    """
    One quantity of a case.

    tolerance: largest error, of `expected` if relative, else in `unit`; reason: why this much.
    """

    case: str
    quantity: str
    unit: str
    expected: float
    got: float
    tolerance: float
    relative: bool
    reason: str

    @property
    def error(self) -> float:
        """Distance of got from expected, in the measure of the tolerance."""
        distance = abs(self.got - self.expected)
        return distance / abs(self.expected) if self.relative else distance

    @property
    def passed(self) -> bool:
        """Whether the error is within the tolerance; a NaN is not."""
        return bool(self.error <= self.tolerance)

    def __str__(self) -> str:
        """Return the row as one line of text."""
        measure = 'relative' if self.relative else self.unit
        return (f'{self.case}: {self.quantity}: expected {self.expected:.9g} {self.unit}, '
                f'got {self.got:.9g}, error {self.error:.3g} of {self.tolerance:.3g} {measure} '
                f'({self.reason})')


@dataclass(frozen=True)
class Case:
    """
    A case: the function that returns its rows, a title, and whether it takes seconds ('slow').

    A slow case still ends within a minute.
    """

    rows: Callable[[], list[Row]]
    title: str
    speed: str = 'fast'


def failures(rows: list[Row]) -> list[str]:
    """
    Return the rows that did not pass, as text.

    Raises ValueError without rows: nothing was verified.
    """
    if not rows:
        raise ValueError('no rows')
    return [str(row) for row in rows if not row.passed]
