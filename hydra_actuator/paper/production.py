# SPDX-License-Identifier: Apache-2.0
"""
Runs, pictures and page into one new directory: all of it, or nothing.

Everything is written beside the directory first and gets its name at the end, so an interrupted
or failed attempt leaves nothing behind.
"""

from collections.abc import Callable
import os
from pathlib import Path
import shutil
import tempfile

from hydra_actuator.errors import InputError
from hydra_actuator.paper.canvas import draw_styled, new_figure, png
from hydra_actuator.paper.case import Case
from hydra_actuator.paper.choice import Choice
from hydra_actuator.paper.figures import ONE, PaperFigure
from hydra_actuator.paper.page import page, Picture
from hydra_actuator.paper.statement import Statement
from hydra_actuator.paper.statements import STATEMENTS

PAGE = 'paper.html'
# Seconds, roughly: what the share done is counted in.
RUN_COST, FAST_RUN_COST, PICTURE_COST, STATEMENT_COST = 6.0, 1.0, 1.0, 6.0


class Progress:
    """The share done of work whose parts cost differently."""

    def __init__(self, choice: Choice, show: Callable[[float], None] | None) -> None:
        self._total = sum(map(run_cost, choice.runs)) + 1e-9
        self._total += PICTURE_COST * len(choice.pictures)
        self._total += STATEMENT_COST * len(choice.statements)
        self._done, self._show = 0.0, show

    def part(self, cost: float) -> Callable[[float], None]:
        """Return what is called with the share done of a part of this cost."""
        def tell(share: float) -> None:
            if self._show is not None:
                self._show(min(1.0, (self._done + share * cost) / self._total))
        return tell

    def end(self, cost: float) -> None:
        """Count a part as done."""
        self._done += cost
        self.part(0.0)(0.0)


def run_cost(wanted: tuple[Case, int]) -> float:
    """Return what a run costs."""
    return FAST_RUN_COST if wanted[0].fast else RUN_COST


def write_paper(output: str | Path, choice: Choice,
                progress: Callable[[float], None] | None = None) -> Path:
    """
    Draw what is chosen into a new directory and return the page's path.

    progress: called with the share done. Raises InputError where the directory cannot be made or
    matplotlib is missing, SolverError where a run breaks, KeyboardInterrupt on Ctrl-C.
    """
    output = Path(os.path.abspath(output))
    try:
        import matplotlib  # noqa: F401
    except ImportError as error:
        raise InputError(
            'the figures need matplotlib: pip install hydra_actuator[report]') from error
    share = Progress(choice, progress)
    for case, passes in choice.runs:
        case.run(passes, share.part(run_cost((case, passes))))
        share.end(run_cost((case, passes)))
    try:
        output.parent.mkdir(parents=True, exist_ok=True)
        draft = Path(tempfile.mkdtemp(prefix=f'.{output.name}-', dir=output.parent))
        try:
            _write(draft, choice, share)
            draft.chmod(0o777 & ~_mask())
            if os.path.lexists(output):
                raise InputError(f'{output} exists already, and nothing is overwritten')
            draft.rename(output)
        except BaseException:
            shutil.rmtree(draft, ignore_errors=True)
            raise
    except OSError as error:
        raise InputError(f'cannot write {output}: {error.strerror or error}') from error
    return output / PAGE


def _write(folder: Path, choice: Choice, share: Progress) -> None:
    """Write pictures and page into an existing folder."""
    pictures = [_draw(folder, figure, case, share) for figure, case in choice.pictures]
    told = [_tell(folder, name, share) for name in choice.statements]
    (folder / PAGE).write_text(page(pictures, told, [case for case, _ in choice.runs]), 'utf-8')


def _draw(folder: Path, figure: PaperFigure, case: Case, share: Progress) -> Picture:
    """Draw one figure of one case."""
    drawn, caption = figure.drawn(case)
    content = png(drawn)
    name = f'figure_{figure.name}{case.suffix}.png'
    (folder / name).write_bytes(content)
    share.end(PICTURE_COST)
    return Picture(figure.name, figure.title, case.title, caption, content, name)


def _tell(folder: Path, name: str, share: Progress) -> tuple[Statement, Picture | None]:
    """Judge one statement, and draw its picture if it has one."""
    statement = STATEMENTS[name]()
    picture = None
    if statement.figure is not None:
        figure = new_figure(ONE)
        draw_styled(statement.figure, figure)
        content, file = png(figure), f'statement_{name}.png'
        (folder / file).write_bytes(content)
        picture = Picture(name, statement.claim, statement.where, statement.reason, content, file)
    share.end(STATEMENT_COST)
    return statement, picture


def _mask() -> int:
    """Return the mask of new files' rights."""
    mask = os.umask(0)
    os.umask(mask)
    return mask
