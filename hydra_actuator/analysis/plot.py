# SPDX-License-Identifier: Apache-2.0
"""
One figure of a recording as a file: PNG, SVG or PDF, by matplotlib.

The figures are those of the report; a part of the run, instants and units can be chosen.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from hydra_actuator.analysis import (
    boiling,
    figure_cavities,
    figure_events,
    figure_fields,
    figure_lines,
    figure_net,
    figure_profiles,
    figure_ranges,
    figure_spectrum,
    streamline,
)
from hydra_actuator.analysis.figure import Figure
from hydra_actuator.analysis.picture_files import check_picture, write_whole
from hydra_actuator.analysis.printing import draw, STYLE
from hydra_actuator.analysis.report import net_figure, timing_figures
from hydra_actuator.analysis.series import Field, Series
from hydra_actuator.analysis.units import SI, Units
from hydra_actuator.analysis.window import (
    active_span,
    best_field,
    wave_window,
    Window,
    window_of,
)
from hydra_actuator.errors import InputError

DOTS_PER_INCH = 200
SUFFIXES = ('.png', '.svg', '.pdf')


@dataclass(frozen=True)
class View:
    """What of a run is shown: the part chosen (None: the figure's own), instants [s], units."""

    series: Series
    part: Window | None = None
    instants: tuple[float, ...] = ()
    units: Units = SI

    @property
    def shown(self) -> Window:
        """The part chosen, else the one that the report shows first."""
        return self.part or window_of(self.series)

    @property
    def whole(self) -> Window:
        """The part chosen, else the whole run."""
        time = self.series.time
        return self.part or Window(float(time[0]), float(time[-1]))

    @property
    def field(self) -> Field:
        """The field, or the stations as one; InputError where there is neither."""
        found = best_field(self.series.field, streamline.field_of_stations(self.series),
                           self.shown)
        if found is None:
            raise InputError(
                f'{self.series.name} holds neither the field nor enough stations for this')
        return found


def view_of(series: Series, start: float | None = None, end: float | None = None,
            instants: Sequence[float] = (), units: Units = SI) -> View:
    """Return a view of a run from start to end [s]; InputError for what is not in the run."""
    first, last = float(series.time[0]), float(series.time[-1])
    for t in instants:
        if not first <= t <= last:
            raise InputError(f'--at {t:g} s is not in the run, {first:g} to {last:g} s')
    if start is None and end is None:
        return View(series, None, tuple(instants), units)
    low, high = first if start is None else start, last if end is None else end
    if not first <= low < high <= last + 1e-9:
        raise InputError(f'--from {low:g} --to {high:g} s is no part of the run, '
                         f'{first:g} to {last:g} s')
    # The frequency of a periodic motion is that of the run.
    return View(series, Window(low, high, window_of(series).frequency), tuple(instants), units)


def _surface(quantity: str) -> Callable[[View], list[Figure]]:
    def build(view: View) -> list[Figure]:
        field = view.field.having(quantity)
        return [figure_fields.surface(view.series, field, view.shown, quantity, view.units)]
    return build


def _map(view: View) -> list[Figure]:
    """Return the maps of both quantities: of waves, where the frames resolve some."""
    full, shown = view.series.field, view.shown
    waves = full and wave_window(view.series, full, shown)
    field = full if waves else view.field
    window = waves if waves and view.part is None else shown
    return [figure_fields.wave_map(view.series, field.having(quantity), window, quantity,
                                   bool(waves), view.units)
            for quantity in figure_fields.QUANTITIES]


def _net(view: View) -> list[Figure]:
    moving = view.field.having('velocity')
    if view.part is None:
        return [net_figure(view.series, moving, view.shown, view.units)]
    return [figure_net.net(view.series, moving, view.part, view.units)]


def _spectrum(view: View) -> list[Figure]:
    part = view.part or Window(*active_span(view.series))
    return [figure_spectrum.spectrum(view.series, part, view.units)]


def _cavities(view: View) -> list[Figure]:
    if not boiling.cavitation_was_on(view.series):
        raise InputError(f'{view.series.name} was made without fluid.cavitation')
    return figure_cavities.cavities(view.series, view.shown, view.units)[:2]


def _ranges(view: View) -> list[Figure]:
    stations = streamline.field_of_stations(view.series)
    field = view.series.field or view.field
    return [figure_ranges.ranges(field, stations, view.units)]


@dataclass(frozen=True)
class Plot:
    """A figure that can be asked for: in words, size [inch], how it is made, its parts' rows."""

    words: str
    size: tuple[float, float]
    build: Callable[[View], list[Figure]]
    stacked: bool = False


PLOTS = {
    'surface-pressure': Plot('pressure over streamline and time', (7.0, 5.0),
                             _surface('pressure')),
    'surface-velocity': Plot('velocity over streamline and time', (7.0, 5.0),
                             _surface('velocity')),
    'xt': Plot('maps over streamline and time, in which waves are lines', (11.0, 5.0), _map),
    'stations': Plot('pressures and velocities of the sections over time', (8.0, 6.0),
                     lambda v: [figure_lines.sections(v.series, v.shown, v.units)]),
    'piston': Plot('position, velocity, pressures on the two faces', (7.0, 5.5),
                   lambda v: [figure_lines.piston(v.series, v.shown, v.units)]),
    'command': Plot('commands, spool and load', (7.0, 4.0),
                    lambda v: [figure_lines.command(v.series, v.shown, v.units)]),
    'streamline': Plot('along the streamline at instants (--at)', (8.0, 5.5),
                       lambda v: [figure_profiles.at_instants(
                           v.series, v.field.having('velocity'), v.shown, v.instants,
                           v.units)]),
    'net': Plot('characteristics and the moving piston', (8.0, 5.0), _net),
    'spectrum': Plot('spectra, natural frequencies marked', (8.0, 5.5), _spectrum),
    'ranges': Plot('lowest and highest along the streamline', (8.0, 5.0), _ranges),
    'timing': Plot('real time of a node: lateness, sending, stamps', (9.0, 9.5),
                   lambda v: timing_figures(v.series), True),
    'cavities': Plot('volume and number of cavities, and where the oil boils', (11.0, 5.0),
                     _cavities),
    'faults': Plot('faults and events', (9.0, 4.5),
                   lambda v: [figure_events.events(v.series, v.whole, v.units)]),
}


def plot(name: str, view: View, size: Sequence[float] | None = None):
    """Return a figure by its name as a matplotlib figure of a size [inch]."""
    from matplotlib import rc_context
    from matplotlib.figure import Figure as Sheet

    if name not in PLOTS:
        raise InputError(f'no figure {name!r}; there are {", ".join(PLOTS)}')
    chosen = PLOTS[name]
    figures = chosen.build(view)
    present = [one for one in figures if not one.missing]
    if not present:
        raise InputError(f'{view.series.name} gives no {name}: {figures[0].missing}')
    with rc_context(STYLE):
        sheet = Sheet(figsize=tuple(size or chosen.size), facecolor='white',
                      layout='constrained')
        shape = (len(present), 1) if chosen.stacked else (1, len(present))
        # What lies one above the other shares the height as on the page.
        heights = [one.height for one in present] if chosen.stacked else None
        parts = sheet.subfigures(*shape, squeeze=False, height_ratios=heights).ravel()
        for part, one in zip(parts, present):
            if chosen.stacked:
                part.suptitle(one.title, fontsize=9)
            draw(part, one)
    return sheet


def write_plot(name: str, view: View, output: str | Path,
               size: Sequence[float] | None = None, dots_per_inch: int = DOTS_PER_INCH) -> Path:
    """Write a figure, its format by the suffix of the file; an existing one is replaced."""
    from matplotlib import rc_context

    path = check_picture(output, SUFFIXES)
    sheet = plot(name, view, size)
    with rc_context(STYLE), write_whole(path) as draft:
        sheet.savefig(draft, dpi=dots_per_inch, format=path.suffix[1:])
    return path
