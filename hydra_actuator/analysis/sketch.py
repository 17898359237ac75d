# SPDX-License-Identifier: Apache-2.0
"""
The actuator drawn along its streamline, for the head of a map: x is to scale, widths are not.

    (pump) ==== [valve] == |  chamber_1 ]piston[ chamber_2  | == [valve] ==== (tank)
"""

from collections.abc import Sequence

from hydra_actuator.analysis.palette import INK
from matplotlib.patches import FancyBboxPatch, Rectangle

STEEL = '#aab2ba'
LINE_WIDTH, CYLINDER_WIDTH = 0.16, 0.72


def draw_actuator(axes, ends: list[tuple[float, str]], piston: float, colours: dict) -> None:
    """
    Draw lines, valve, cylinder and piston into axes whose x [m] is the streamline.

    ends: x and letters of the ends of the domains (O, A|B, C|D, G|H, I|J, K); piston: x of its
    face E; colours: of the oil by domain.
    """
    x = [place for place, _ in ends]
    axes.set_ylim(-1.05, 0.85)
    axes.axis('off')
    spans = {
        'supply_line': x[0:2], 'line_1': x[1:3], 'chamber_1': (x[2], piston),
        'chamber_2': (piston, x[3]), 'line_2': x[3:5], 'return_line': x[4:6],
    }
    for domain, (left, right) in spans.items():
        width = CYLINDER_WIDTH if 'chamber' in domain else LINE_WIDTH
        axes.add_patch(Rectangle((left, -width / 2), right - left, width,
                                 facecolor=colours[domain], edgecolor=INK, linewidth=0.8))
    unit = (x[5] - x[0]) / 100
    _draw_piston(axes, piston, unit)
    for place in (x[1], x[4]):
        axes.add_patch(FancyBboxPatch(
            (place - 1.5 * unit, -0.24), 3 * unit, 0.48, boxstyle='round,pad=0,rounding_size=0.01',
            facecolor='#e4e8ec', edgecolor=INK, linewidth=0.9))
    draw_ends(axes, x[0], x[5], unit)
    draw_names(axes, x)


def draw_names(axes, x: Sequence[float]) -> None:
    """Write under pump, valve, cylinder and tank what they are; x: of the ends of the domains."""
    for place, text in ((x[0], 'pump'), (x[1], 'valve'), ((x[2] + x[3]) / 2, 'cylinder'),
                        (x[4], 'valve'), (x[5], 'tank')):
        axes.text(place, -0.56, text, ha='center', va='top', fontsize=8, color=INK)


def _draw_piston(axes, piston: float, unit: float) -> None:
    """Draw the piston, and the arrow of its motion above."""
    axes.add_patch(Rectangle((piston - unit, -CYLINDER_WIDTH / 2), 2 * unit, CYLINDER_WIDTH,
                             facecolor=STEEL, edgecolor=INK, linewidth=0.9))
    axes.annotate('', (piston + 6 * unit, 0.6), (piston - 6 * unit, 0.6),
                  arrowprops={'arrowstyle': '<->', 'color': INK, 'linewidth': 0.9})


def draw_ends(axes, pump: float, tank: float, unit: float) -> None:
    """Draw the pump as a circle, round at any scale, and the tank as an open vessel."""
    axes.plot([pump], [0], marker='o', markersize=15, markerfacecolor='white',
              markeredgecolor=INK, clip_on=False)
    axes.plot([pump], [0], marker='>', markersize=6, color=INK, clip_on=False)
    axes.plot([tank + 2 * unit, tank, tank, tank + 2 * unit], [-0.3, -0.3, 0.3, 0.3],
              color=INK, linewidth=1.2, clip_on=False)
