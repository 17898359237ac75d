# SPDX-License-Identifier: Apache-2.0
"""
A picture of each case: the solver against what was expected, written as PNG.

The only module of the room that imports matplotlib: a case draws into the figure it is given. A
case without a figure of its own is drawn as the error of each row in parts of its tolerance.
"""

from pathlib import Path

from hydra_actuator.errors import Failure, InputError
from hydra_actuator.verification.case import Case, nearest, Row, worst
from hydra_actuator.verification.drawing import tolerance_used

SIZE = (10.0, 6.5)      # [inch]
HEAD = 0.62             # [inch], of name, title and verdict
DOTS_PER_INCH = 110
MOST_ROWS = 50          # in a figure without curves
STYLE = {
    'font.family': 'sans-serif', 'font.size': 9, 'axes.titlesize': 9.5, 'axes.spines.top': False,
    'axes.spines.right': False, 'axes.linewidth': 0.8, 'axes.edgecolor': '#59636e',
    'xtick.color': '#3b444c', 'ytick.color': '#3b444c', 'axes.labelcolor': '#1c2126',
    'grid.color': '#dde1e5', 'grid.linewidth': 0.6, 'legend.frameon': False,
    'legend.fontsize': 8, 'axes.axisbelow': True, 'axes.formatter.limits': (-4, 5),
    'axes.formatter.useoffset': False,
}


def require_matplotlib() -> None:
    """Raise InputError where matplotlib is missing."""
    try:
        import matplotlib  # noqa: F401
    except ImportError as error:
        raise InputError(
            'the figures need matplotlib: pip install hydra_actuator[report]') from error


def write_figure(name: str, case: Case, rows: list[Row], directory: Path) -> Path:
    """Draw a case as `<name>.png` in a directory; raises Failure where it cannot be written."""
    from matplotlib import rc_context

    path = Path(directory) / f'{name}.png'
    with rc_context(STYLE):
        figure = draw_case(name, case, rows)
        try:
            figure.savefig(path, dpi=DOTS_PER_INCH)
        except OSError as error:
            raise Failure(f'cannot write {path}: {error.strerror}') from error
    return path


def draw_case(name: str, case: Case, rows: list[Row]):
    """Return the matplotlib Figure of a case with rows, headed by name, title and verdict."""
    from matplotlib.figure import Figure

    height = SIZE[1] if case.figure else max(2.5, 1.6 + 0.22 * min(len(rows), MOST_ROWS))
    figure = Figure(figsize=(SIZE[0], height), facecolor='white', layout='constrained')
    figure.get_layout_engine().set(rect=(0.0, 0.0, 1.0, 1.0 - HEAD / height))
    if case.figure:
        case.figure(figure)
    else:
        axes = figure.subplots()
        tolerance_used(axes, nearest(rows, MOST_ROWS))
        axes.legend(loc='lower left', bbox_to_anchor=(0.0, 1.0), ncols=3)
    figure.text(0.012, 1.0 - 0.1 / height, f'{name}: {case.title}', va='top', fontsize=12,
                weight='bold')
    figure.text(0.012, 1.0 - 0.37 / height, verdict(rows), va='top', fontsize=8.5,
                color='#59636e')
    return figure


def verdict(rows: list[Row]) -> str:
    """Return in one line how many rows passed and which is the worst."""
    passed, extreme = sum(row.passed for row in rows), worst(rows)
    told = 'nearest to it' if extreme.passed else 'FAILED, worst'
    return (f'{passed} of {len(rows)} quantities within tolerance; {told}: '
            f'{extreme.quantity}, at {extreme.used:.2g} of its tolerance')
