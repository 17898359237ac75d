# SPDX-License-Identifier: Apache-2.0
"""
The actuator in motion along its streamline: oil coloured by pressure, spool and piston moving.

    (pump) ==== [valve] == |  chamber_1 ]piston[ chamber_2  | == [valve] ==== (tank)

x is to scale, widths are not. A land of the spool shuts the passage at null and slides away from
it by the opening: up for positive spool (A to B, I to J), down for negative (A to I, B to J).
"""

from hydra_actuator.analysis.palette import INK
from hydra_actuator.analysis.sketch import (
    CYLINDER_WIDTH,
    draw_ends,
    draw_names,
    LINE_WIDTH,
    STEEL,
)
from matplotlib.patches import Rectangle
import numpy as np

VALVE_HEIGHT, LAND, TRAVEL = 0.62, 1.15 * LINE_WIDTH, 0.2


class Scene:
    """The drawing in axes whose x is the streamline; `show` moves it."""

    def __init__(self, axes, ends: np.ndarray, grid: np.ndarray, colours) -> None:
        """
        Draw what stands still.

        ends: x of O, A|B, C|D, G|H, I|J, K; grid: even x of the oil's columns; colours: a
        matplotlib ScalarMappable of pressures.
        """
        self._colours, self._grid = colours, grid
        self._within = (grid >= ends[2]) & (grid <= ends[3])
        axes.set(xlim=(ends[0], ends[5]), ylim=(-1.05, 0.62))
        axes.axis('off')
        self._oil = [self._image(axes, span, width) for span, width in (
            ((ends[0], ends[2]), LINE_WIDTH), ((ends[2], ends[3]), CYLINDER_WIDTH),
            ((ends[3], ends[5]), LINE_WIDTH))]
        unit = (ends[5] - ends[0]) / 100
        self._unit = unit
        self._piston = axes.add_patch(Rectangle(
            (0, -CYLINDER_WIDTH / 2), 2 * unit, CYLINDER_WIDTH, facecolor=STEEL, edgecolor=INK,
            linewidth=0.9, zorder=3))
        self._lands = [self._valve(axes, ends[k], unit) for k in (1, 4)]
        self._path, self._back = (
            axes.text(ends[k], 0.42, '', ha='center', fontsize=8, color=INK) for k in (1, 4))
        draw_ends(axes, ends[0], ends[5], unit)
        draw_names(axes, ends)

    def _image(self, axes, span: tuple[float, float], width: float):
        """Return the image of the oil between two places, one row of colours, with its walls."""
        inside = (self._grid >= span[0]) & (self._grid <= span[1])
        image = axes.imshow(
            np.zeros((1, max(int(inside.sum()), 1), 4)), aspect='auto', interpolation='nearest',
            extent=(*span, -width / 2, width / 2), zorder=1)
        axes.add_patch(Rectangle((span[0], -width / 2), span[1] - span[0], width, fill=False,
                                 edgecolor=INK, linewidth=0.9, zorder=2))
        return image, inside

    def _valve(self, axes, place: float, unit: float):
        """Draw a valve's housing and return its land."""
        axes.add_patch(Rectangle(
            (place - 1.5 * unit, -VALVE_HEIGHT / 2), 3 * unit, VALVE_HEIGHT, fill=False,
            edgecolor=INK, linewidth=0.9, zorder=4))
        return axes.add_patch(Rectangle(
            (place - 0.9 * unit, -LAND / 2), 1.8 * unit, LAND, facecolor=STEEL, edgecolor=INK,
            linewidth=0.8, zorder=4))

    def show(self, pressure: np.ndarray, faces: tuple[float, float],
             openings: np.ndarray) -> None:
        """
        Show an instant.

        pressure: on the grid; faces: x of E and F; openings: of the spools over their stroke.
        """
        colours = self._colours.to_rgba(pressure)
        for image, inside in self._oil:
            image.set_data(colours[None, inside])
        self._piston.set_x(0.5 * (faces[0] + faces[1]) - self._unit)
        for land, opening in zip(self._lands, (openings[0], openings[-1])):
            land.set_y(TRAVEL * float(np.clip(opening, -1, 1)) - LAND / 2)
        self._path.set_text('A to B' if openings[0] > 0 else 'A to I' if openings[0] < 0 else '')
        self._back.set_text('I to J' if openings[-1] > 0 else 'B to J' if openings[-1] < 0 else '')
