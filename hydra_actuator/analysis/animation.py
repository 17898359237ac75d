# SPDX-License-Identifier: Apache-2.0
"""
A run as a moving picture: the drawn actuator, the pressure along it, piston and spool.

GIF by Pillow, MP4 by ffmpeg, HTML with a slider and everything inside. The frame of the field
nearest to each instant is shown; nothing is interpolated in time but the piston and the spool.
"""

from collections.abc import Callable, Sequence
import math
from pathlib import Path

from hydra_actuator.analysis import streamline
from hydra_actuator.analysis.figure_fields import x_axis
from hydra_actuator.analysis.frames import BLOCK
from hydra_actuator.analysis.movie_files import movie_writer, saving
from hydra_actuator.analysis.palette import BLUE, INK, VERMILION
from hydra_actuator.analysis.picture_files import write_whole
from hydra_actuator.analysis.plot import View
from hydra_actuator.analysis.printing import STYLE
from hydra_actuator.analysis.scene import Scene
from hydra_actuator.analysis.series import Field, Series
from hydra_actuator.analysis.window import Window
from hydra_actuator.errors import InputError
import numpy as np

SIZE, DOTS_PER_INCH = (9.0, 5.6), 100
COLUMNS = 480
FRAMES, RATE = 120, 20.0            # of the picture; rate in 1/s of the watcher's time
QUIET = '#59636e'


class Animation:
    """The moving picture of a view; `show(k)` draws its k-th instant."""

    def __init__(self, view: View, frames: int = FRAMES, rate: float = RATE,
                 size: Sequence[float] = SIZE) -> None:
        """
        Take `frames` instants evenly over the part shown.

        rate: frames in a second of the watcher's time, for the words about slow motion. Raises
        InputError for a recording with neither the field nor the stations A to J.
        """
        from matplotlib.figure import Figure

        series, shown, units = view.series, view.shown, view.units
        part = view.field.between(shown.start, shown.end)
        ends = streamline.boundaries(part)
        if len(ends) != 6 or part.faces is None or not len(part.time):
            raise InputError(f'{series.name} holds too little of the streamline in the part shown '
                             'to be drawn: neither the field nor all stations')
        self.instants = np.linspace(shown.start, shown.end, frames)
        self._units = units
        self._slow = (shown.end - shown.start) / max(frames - 1, 1) * rate
        self._part = part.at(np.unique([np.abs(part.time - t).argmin() for t in self.instants]))
        self._x, self._pressure = self._placed(self._part, series)
        stroke = series.parameters.get('valve.stroke') or 1.0
        self._openings = np.stack(
            [np.interp(self.instants, series.time, spool) for spool in series.spool.T], 1) / stroke
        self.figure = Figure(figsize=tuple(size), facecolor='white')
        self._grid = np.linspace(*(float(units.place(ends[k][0])) for k in (0, -1)), COLUMNS)
        self._draw_still(ends, series, part, shown, stroke)

    def __len__(self) -> int:
        """Return how many instants there are."""
        return len(self.instants)

    def show(self, k: int) -> None:
        """Draw the k-th instant."""
        time = self.instants[k]
        frame = int(np.abs(self._part.time - time).argmin())
        x, pressure = self._x[frame], self._pressure[frame]
        left, right = self._part.faces
        on_grid = streamline.on_even_grid(x[None], pressure[None], self._grid)[0]
        self._scene.show(on_grid, (x[left], x[right]), self._openings[k])
        self._line.set_data(x, pressure)
        self._cursor.set_xdata([self._units.time(time)] * 2)
        told = (f'{float(self._units.time(time)):.3f} L/c' if self._units.time.symbol
                else f'{time * 1e3:.2f} ms')
        self._words.set_text(f'{told}    slowed down {1 / max(self._slow, 1e-12):.3g} times')

    def _placed(self, part: Field, series: Series) -> tuple[np.ndarray, np.ndarray]:
        """Return place and pressure of the nodes in some frames, as they are shown."""
        piston = np.interp(part.time, series.time, series.position)
        return (self._units.place(streamline.node_positions(part, piston)),
                self._units.pressure(streamline.gapless(part, part.pressure)))

    def _envelope(self, part: Field, series: Series) -> tuple[np.ndarray, np.ndarray]:
        """Return the lowest and the highest pressure at each place of the grid."""
        lowest = highest = np.full(len(self._grid), np.nan)
        for first in range(0, len(part.time), BLOCK):
            some = self._placed(part.at(slice(first, first + BLOCK)), series)
            rows = streamline.on_even_grid(*some, self._grid)
            lowest, highest = np.fmin(lowest, rows.min(axis=0)), np.fmax(highest, rows.max(axis=0))
        return lowest, highest

    def _draw_still(self, ends: list, series: Series, part: Field, shown: Window,
                    stroke: float) -> None:
        """Draw axes, ranges and everything that does not move."""
        from matplotlib.cm import ScalarMappable
        from matplotlib.colors import Normalize

        units, figure = self._units, self.figure
        lowest, highest = self._envelope(part, series)
        _, *limits = part.extremes('pressure', 1)
        low, high = (float(choose(units.pressure(limit)))
                     for choose, limit in zip((np.nanmin, np.nanmax), limits))
        margin = 0.04 * max(high - low, 1e-9)
        colours = ScalarMappable(Normalize(low, max(high, low + 1e-9)), 'cividis')
        below = figure.add_axes((0.09, 0.40, 0.80, 0.26))
        above = figure.add_axes((0.09, 0.66, 0.80, 0.30))
        self._scene = Scene(above, units.place(np.array([x for x, _ in ends])), self._grid,
                            colours)
        bar = figure.colorbar(colours, cax=figure.add_axes((0.915, 0.40, 0.013, 0.50)))
        bar.set_label(units.pressure.label('pressure'))
        bar.outline.set_visible(False)
        below.fill_between(self._grid, lowest, highest, color='#e4e8ec', linewidth=0)
        self._line, = below.plot([], [], color=BLUE, linewidth=1.6)
        axis = x_axis(ends, units)
        below.set(xlim=axis['range'], ylim=(low - margin, high + margin),
                  xlabel=axis['title']['text'], ylabel=units.pressure.label('pressure'))
        below.set_xticks(axis['tickvals'], [t.replace('<br>', '\n') for t in axis['ticktext']])
        below.grid(True, axis='y')
        self._draw_history(figure.add_axes((0.09, 0.10, 0.80, 0.17)), series, shown, stroke)
        self._words = figure.text(0.09, 0.965, '', fontsize=10, color=INK, va='center')

    def _draw_history(self, axes, series, shown, stroke: float) -> None:
        """Draw piston and spool over time, and the cursor that runs through it."""
        units = self._units
        part = slice(*np.searchsorted(series.time, [shown.start, shown.end + 1e-9]))
        time = units.time(series.time[part])
        axes.plot(time, units.travel(series.position[part]), color=BLUE)
        axes.set(xlabel=units.time.label('time'),
                 xlim=[float(units.time(t)) for t in (shown.start, shown.end)])
        axes.set_ylabel(units.travel.label('piston'), color=BLUE)
        right = axes.twinx()
        right.plot(time, series.spool[part] / stroke, color=VERMILION, linewidth=1.0)
        right.set_ylabel('spool [1]' if stroke != 1.0 else 'spool [m]', color=VERMILION)
        self._cursor = axes.axvline(float(units.time(shown.start)), color=QUIET, linewidth=1.0)


def write_animation(view: View, path: Path, frames: int = FRAMES, rate: float = RATE,
                    size: Sequence[float] = SIZE, dots_per_inch: int = DOTS_PER_INCH,
                    progress: Callable[[float], None] = lambda share: None) -> Path:
    """
    Write a moving picture, its format by the suffix: .gif, .mp4 or .html.

    rate: frames per second; progress: called with the share done. An earlier file is replaced
    when the new one is whole, and stays if it never becomes that.
    """
    from matplotlib import rc_context

    if not math.isfinite(rate) or rate <= 0:
        raise InputError(f'{rate:g} frames per second are none')
    writer = movie_writer(path.suffix, rate)
    with rc_context(STYLE), write_whole(path) as draft:
        animation = Animation(view, frames, rate, size)
        with saving(writer, animation.figure, draft, dots_per_inch):
            for k in range(len(animation)):
                animation.show(k)
                writer.grab_frame()
                progress((k + 1) / len(animation))
    return path
