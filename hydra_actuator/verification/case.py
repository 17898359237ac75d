# SPDX-License-Identifier: Apache-2.0
"""One line of a verification: what was expected, what came out, how far apart they may be."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
import math
from typing import Any


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

    @property
    def used(self) -> float:
        """Part of the tolerance that the error uses up: at most 1 if passed; NaN if it is NaN."""
        if self.tolerance == 0.0:
            return 0.0 if self.error == 0.0 else self.error * math.inf
        return self.error / self.tolerance

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

    A slow case still ends within a minute. figure: draws the solver against what was expected
    into an empty matplotlib Figure; a case without one is drawn from its rows.
    """

    rows: Callable[[], list[Row]]
    title: str
    speed: str = 'fast'
    figure: Callable[[Any], None] | None = None


def illustrated(cases: dict[str, Case], **figures: Callable[[Any], None]) -> dict[str, Case]:
    """Return the cases with figures from another module, by the name of the case."""
    return {**cases, **{name: replace(cases[name], figure=draw)
                        for name, draw in figures.items()}}


def worst(rows: Sequence[Row]) -> Row:
    """Return the row that is nearest to its tolerance or farthest beyond; NaN is beyond all."""
    return max(rows, key=_rank)


def nearest(rows: Sequence[Row], most: int) -> list[Row]:
    """Return at most so many rows, those nearest to their tolerances or beyond, in their order."""
    chosen = sorted(range(len(rows)), key=lambda k: _rank(rows[k]), reverse=True)[:most]
    return [rows[k] for k in sorted(chosen)]


def _rank(row: Row) -> float:
    return math.inf if math.isnan(row.used) else row.used


def failures(rows: list[Row]) -> list[str]:
    """
    Return the rows that did not pass, as text.

    Raises ValueError without rows: nothing was verified.
    """
    if not rows:
        raise ValueError('no rows')
    return [str(row) for row in rows if not row.passed]
