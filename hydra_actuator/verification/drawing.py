# SPDX-License-Identifier: Apache-2.0
"""
What the figures of cases have in common: styles of lines, bars of tolerance, numbered panels.

What is expected lies below, wide and pale; what the solver gives lies on it, thin and dark.
Functions take matplotlib Axes and import nothing of it.
"""

from hydra_actuator.analysis.palette import BLUE, GREEN, INK, ORANGE, PURPLE, VERMILION
from hydra_actuator.verification.case import Row
import numpy as np

MILLI, MEGAPASCAL = 1e3, 1e-6       # factors to ms or mm, to MPa
EXACT_LINE = {'color': ORANGE, 'linewidth': 4.5, 'alpha': 0.55, 'label': 'exact'}
EXACT_POINT = {'color': ORANGE, 'marker': 'o', 'markersize': 8, 'alpha': 0.75, 'linestyle': 'none',
               'label': 'exact'}
SOLVER = {'color': BLUE, 'linewidth': 1.2, 'label': 'solver'}
SOLVER_POINT = {'color': BLUE, 'marker': '+', 'markersize': 9, 'markeredgewidth': 1.6,
                'linestyle': 'none', 'label': 'solver'}
# what a simpler model would give
SIMPLER = {'color': '#7a838c', 'linewidth': 1.0, 'linestyle': ':'}
TOLERANCE = {'color': VERMILION, 'linewidth': 1.1, 'linestyle': '--', 'label': 'tolerance'}
SERIES = (BLUE, GREEN, PURPLE, INK)
MARKERS = ('o', 's', '^', 'D')
# smallest part of a tolerance that is told apart from nothing
LEAST_USED = 1e-6


def band(axes, tolerance: float) -> None:
    """Draw a tolerance to both sides of zero, and make room for it and the lines there are."""
    largest = max((float(np.nanmax(np.abs(line.get_ydata()))) for line in axes.get_lines()),
                  default=0.0)
    axes.axhline(tolerance, **TOLERANCE)
    axes.axhline(-tolerance, **{**TOLERANCE, 'label': '_'})
    reach = 1.8 * max(tolerance, largest)
    axes.set_ylim(-reach, reach)


def bar(axes, tolerance: float, **style) -> None:
    """Draw the largest size an error may have."""
    axes.axhline(tolerance, **{**TOLERANCE, **style})


def slope(axes, x: np.ndarray, start: float, order: float, label: str) -> None:
    """Draw a straight line of an order of convergence, through its start, on log-log axes."""
    x = np.asarray(x, float)
    axes.plot(x, start * (x[0] / x) ** order, label=label, **SIMPLER)


def cells_axis(axes, cells) -> None:
    """Make axes log-log over a few numbers of cells, each with its tick."""
    axes.set_xscale('log')
    axes.set_yscale('log')
    axes.set_xticks(cells, [str(one) for one in cells])
    axes.set_xticks([], minor=True)
    axes.set_xlabel('cells')
    axes.grid(True)


def tolerance_used(axes, rows: list[Row]) -> None:
    """Draw the error of each row in parts of its tolerance, on a log axis with the bar at 1."""
    used = np.array([row.used for row in rows], float)
    known = np.isfinite(used)
    shown = np.where(known, np.clip(used, LEAST_USED, 1e6), 1e6)
    place = np.arange(len(rows))
    for kind, chosen, style in (
            ('within', [row.passed for row in rows], {'color': BLUE}),
            ('missed', [not row.passed for row in rows], {'color': VERMILION, 'marker': 'X'})):
        chosen = np.array(chosen, bool)
        if chosen.any():
            axes.hlines(place[chosen], LEAST_USED, shown[chosen], color=style['color'],
                        linewidth=1.0, alpha=0.5)
            axes.plot(shown[chosen], place[chosen], **{
                'marker': 'o', 'markersize': 5, 'linestyle': 'none', 'label': kind, **style})
    axes.axvline(1.0, **TOLERANCE)
    axes.set_xscale('log')
    axes.set_xlim(0.7 * LEAST_USED, max(10.0, 3.0 * float(shown.max())))
    axes.set_yticks(place, [
        f'{row.quantity}: {row.got:.6g}, expected {row.expected:.6g} {row.unit}' for row in rows])
    axes.set_ylim(len(rows) - 0.4, -0.6)
    axes.set_xlabel(f'error / tolerance (left edge: {LEAST_USED:g} or less)')
    axes.grid(True, axis='x')
