# SPDX-License-Identifier: Apache-2.0
"""
One wide picture of a run, for a page or a paper.

The pressure over streamline and time, the same as a map below the drawn actuator, the piston, the
pressures on its faces, the command. Shows the part of the run that the report shows first.
Needs matplotlib, no browser.
"""

from pathlib import Path

from hydra_actuator.analysis import boiling, streamline
from hydra_actuator.analysis.figure import MEGAPASCAL, MILLI
from hydra_actuator.analysis.palette import BLUE, INK, ORANGE, VELOCITY_STOPS, VERMILION
from hydra_actuator.analysis.series import Field, Series
from hydra_actuator.analysis.surface import shaded, with_walls
from hydra_actuator.analysis.window import best_field, wave_window, Window, window_of
from hydra_actuator.errors import InputError
import numpy as np

SIZE = (13.0, 5.0)      # [inch]
DOTS_PER_INCH = 160
MAP_PLACE = (0.485, 0.125, 0.22, 0.63)     # left, bottom, width, height
COLUMNS, FRAMES = 360, 240
COLOURS = 'cividis'
LEGEND = {'frameon': False, 'ncols': 2, 'fontsize': 8, 'loc': 'lower right',
          'bbox_to_anchor': (1.0, 0.97), 'borderpad': 0}
STYLE = {
    'font.family': 'sans-serif', 'font.size': 9, 'axes.spines.top': False,
    'axes.spines.right': False, 'axes.linewidth': 0.8, 'axes.edgecolor': '#59636e',
    'xtick.color': '#3b444c', 'ytick.color': '#3b444c', 'axes.labelcolor': '#1c2126',
    'grid.color': '#dde1e5', 'grid.linewidth': 0.6,
}


def write_picture(recording: str | Path, output: str | Path) -> Path:
    """
    Draw a recording as one wide picture and return its path; an existing file is replaced.

    The ending of `output` names the format: png, svg or pdf. Raises InputError for a recording
    without a field and without enough stations, a directory that is not there, an unknown
    format, or where matplotlib is missing.
    """
    from hydra_actuator.analysis.extraction import series_of

    output = Path(output)
    if output.suffix not in ('.png', '.svg', '.pdf'):
        raise InputError(f'{output}: a picture ends in .png, .svg or .pdf')
    if not output.parent.is_dir():
        raise InputError(f'no directory {output.parent} for the picture')
    figure = picture(series_of(recording))
    try:
        figure.savefig(output, dpi=DOTS_PER_INCH)
    except OSError as error:
        raise InputError(f'cannot write {output}: {error.strerror}') from error
    return output


def picture(series: Series):
    """Return the picture of a run as a matplotlib figure."""
    try:
        from matplotlib import rc_context
        from matplotlib.figure import Figure
    except ImportError as error:
        raise InputError(
            'the picture needs matplotlib: pip install hydra_actuator[report]'
        ) from error
    shown = window_of(series)
    field = best_field(series.field, streamline.field_of_stations(series), shown)
    if field is None:
        raise InputError(f'{series.name} holds neither the field nor enough stations')
    with rc_context(STYLE):
        figure = Figure(figsize=SIZE, facecolor='white')
        _draw_surface(figure, series, field, shown)
        _draw_map(figure, series, field, shown)
        _draw_lines(figure, series, shown)
        for k, words in enumerate(boiling.warnings(series)):
            figure.text(0.01, 0.98 - 0.04 * k, words, color=VERMILION, fontsize=9, va='top')
    return figure


def _frames(series: Series, field: Field, shown: Window) -> tuple:
    """Return time [ms] from the window's start, x [m] and gapless pressure [MPa] of the frames."""
    part = field.between(shown.start, shown.end)
    x = streamline.node_positions(part, np.interp(part.time, series.time, series.position))
    pressure = streamline.gapless(part, part.pressure) * MEGAPASCAL
    return (part.time - shown.start) * MILLI, x, pressure


def _draw_surface(figure, series: Series, field: Field, shown: Window) -> None:
    """Draw the pressure over streamline and time as a surface."""
    time, x, pressure = _frames(series, field, shown)
    x, pressure = with_walls(x, pressure)
    axes = figure.add_axes((-0.015, -0.03, 0.45, 1.08), projection='3d', computed_zorder=False)
    axes.plot_surface(
        x, np.tile(time[:, None], (1, x.shape[1])), pressure,
        facecolors=shaded(pressure, COLOURS, _limits(pressure)), shade=False, rcount=FRAMES,
        ccount=FRAMES, linewidth=0, antialiased=False,
    )
    ends = streamline.boundaries(field)
    axes.set_xticks([place for place, _ in ends], [letters for _, letters in ends])
    axes.set_xlabel('streamline', labelpad=4)
    axes.set_ylabel('time [ms]', labelpad=4)
    axes.text2D(0.985, 0.73, 'MPa', transform=axes.transAxes, ha='center', fontsize=8)
    axes.tick_params(pad=0, labelsize=8)
    axes.set_box_aspect((1.55, 1.25, 0.8), zoom=0.98)
    axes.view_init(elev=28, azim=-58)
    for axis in (axes.xaxis, axes.yaxis, axes.zaxis):
        axis.pane.set_visible(False)


def _draw_map(figure, series: Series, field: Field, shown: Window) -> None:
    """
    Draw the pressure as an x-t map with the path of the piston, and the actuator above it.

    Where the frames are dense enough for waves the map shows those: a few travel times, and the
    pressure less its mean at each place.
    """
    from hydra_actuator.analysis.sketch import draw_actuator

    waves = wave_window(series, field, shown)
    time, x, pressure = _frames(series, field, waves or shown)
    grid = np.linspace(field.positions.min(), field.positions.max(), COLUMNS)
    values = streamline.on_even_grid(x, pressure, grid)
    axes = figure.add_axes(MAP_PLACE)
    image = _paint(axes, grid, time, values, bool(waves))
    if field.faces is not None:
        axes.plot(x[:, field.faces[0]], time, color=INK if waves else 'white', linewidth=1.2)
    ends = streamline.boundaries(field)
    since = (waves or shown).start - shown.start
    label = f'time [ms] after {since * MILLI:.3g} ms' if since > 0 else 'time [ms]'
    axes.set(xlabel='streamline, pump to tank [m]', ylabel=label, ylim=(time[0], time[-1]),
             xlim=(grid[0], grid[-1]))
    axes.set_xticks([place for place, _ in ends],
                    [f'{letters}\n{place:.3g}' for place, letters in ends], fontsize=8)
    left, bottom, width, height = MAP_PLACE
    beside = figure.add_axes((left + width + 0.006, bottom, 0.006, height))
    bar = figure.colorbar(image, cax=beside)
    bar.outline.set_visible(False)
    bar.set_label('pressure less its mean [MPa]' if waves else 'pressure [MPa]', fontsize=8)
    bar.ax.tick_params(labelsize=8, length=2)
    if len(ends) == 6 and field.faces is not None:
        head = figure.add_axes((left, 0.775, width, 0.19), sharex=axes)
        face = float(x[:, field.faces[0]].mean())
        draw_actuator(head, ends, face, _oil_colours(series, field, shown))


def _paint(axes, grid: np.ndarray, time: np.ndarray, values: np.ndarray, waves: bool):
    """Paint the map, less the mean at each place for waves, and return the image."""
    from matplotlib.colors import LinearSegmentedColormap

    if waves:
        values = values - values.mean(axis=0)
        most = float(np.abs(values).max())
        colours, limits = LinearSegmentedColormap.from_list('waves', VELOCITY_STOPS), (-most, most)
    else:
        colours, limits = COLOURS, _limits(values)
    return axes.pcolormesh(grid, time, values, cmap=colours, vmin=limits[0], vmax=limits[1],
                           shading='gouraud', rasterized=True)


def _oil_colours(series: Series, field: Field, shown: Window) -> dict:
    """Return the colour of the oil by domain, of its mean pressure in the shown part."""
    from matplotlib import colormaps

    _, _, pressure = _frames(series, field, shown)
    low, high = _limits(pressure)
    labels = np.array(field.labels)
    means = {domain: pressure[:, labels == domain].mean() for domain in streamline.DOMAINS}
    return {domain: colormaps[COLOURS]((mean - low) / max(high - low, 1e-12))
            for domain, mean in means.items()}


def _draw_lines(figure, series: Series, shown: Window) -> None:
    """Draw position, pressures at the piston's faces, command and spool over time."""
    part = slice(*np.searchsorted(series.time, [shown.start, shown.end + 1e-9]))
    time = (series.time[part] - shown.start) * MILLI
    faces = [name for name in 'EF' if name in series.section_names]
    rows = 3 if faces else 2
    axes = [
        figure.add_axes((0.802, 0.125 + k * 0.85 / rows, 0.185, 0.85 / rows - 0.06))
        for k in range(rows - 1, -1, -1)
    ]
    axes[0].plot(time, series.position[part] * MILLI, color=BLUE)
    axes[0].set_ylabel('piston [mm]')
    for name, colour in zip(faces, (ORANGE, VERMILION)):
        column = series.section_names.index(name)
        axes[1].plot(time, series.pressure[part, column] * MEGAPASCAL, color=colour, label=name)
        axes[1].set_ylabel('faces [MPa]')
        axes[1].legend(**LEGEND)
    stroke = series.parameters.get('valve.stroke') or 1.0
    _draw_commands(axes[-1], series, shown)
    axes[-1].plot(time, series.spool[part, 0] / stroke, color=VERMILION, label='spool')
    axes[-1].set(ylabel='valve [1]' if stroke != 1.0 else 'spool [m]', xlabel='time [ms]')
    axes[-1].legend(**LEGEND)
    figure.align_ylabels(axes)
    for one in axes:
        one.set_xlim(0, (shown.end - shown.start) * MILLI)
        one.grid(True)
        one.tick_params(labelsize=8, labelbottom=one is axes[-1])


def _draw_commands(axes, series: Series, shown: Window) -> None:
    """Draw the received spool commands as a staircase."""
    for command in series.commands:
        if command.topic.endswith(('/spool_command', '/commands')):
            part = slice(*np.searchsorted(command.time, [shown.start, shown.end]))
            axes.step((command.time[part] - shown.start) * MILLI, command.values[part, 0],
                      where='post', color='#b9c2cb', linewidth=2.6, label='command')


def _limits(pressure: np.ndarray) -> tuple[float, float]:
    """Return the range of the colours [MPa]."""
    return float(np.nanmin(pressure)), float(np.nanmax(pressure))
