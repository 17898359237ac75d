# SPDX-License-Identifier: Apache-2.0
"""What is asked for: which figures of which cases, and which statements."""

from dataclasses import dataclass

from hydra_actuator.errors import InputError
from hydra_actuator.paper.case import Case, CASES
from hydra_actuator.paper.figures import FIGURES, PaperFigure
from hydra_actuator.paper.statements import STATEMENTS


@dataclass(frozen=True)
class Choice:
    """Pictures as (figure, case), in the order of the page, and names of statements."""

    pictures: list[tuple[PaperFigure, Case]]
    statements: list[str]

    @property
    def runs(self) -> list[tuple[Case, int]]:
        """The runs the pictures need, as (case, passes), without repetition."""
        wanted = [(case, passes) for figure, case in self.pictures for passes in figure.passes]
        return list(dict.fromkeys(wanted))


def choose(only: list[str], plain: bool = True, cavitation: bool = True) -> Choice:
    """
    Return what to draw: all, or `only` these figures (2a or figure_2a) and statements.

    plain, cavitation: which models are drawn. Raises InputError for an unknown name.
    """
    names = [name.removeprefix('figure_') for name in only]
    for name in names:
        if name not in FIGURES and name not in STATEMENTS:
            known = f'{", ".join(FIGURES)}; statements: {", ".join(STATEMENTS) or "none"}'
            raise InputError(f'no figure and no statement {name!r}; figures: {known}')
    cases = [case for case in CASES.values() if (cavitation if case.cavitation else plain)]
    pictures = [
        (figure, case) for name, figure in FIGURES.items() if not names or name in names
        for case in cases if figure.fast or not case.fast]
    return Choice(pictures, [name for name in STATEMENTS if not names or name in names])
