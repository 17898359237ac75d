# SPDX-License-Identifier: Apache-2.0
"""
The report's figures on paper: a `Figure` drawn by matplotlib instead of by plotly in a browser.

Lines in stacked panels, heat maps and surfaces: what the figures of this room are made of. Data,
colours, labels and ranges are the figure's own, so a picture and the page show the same. Of
several views behind buttons the one that is visible at first is drawn.
"""

from hydra_actuator.analysis.figure import Figure
from hydra_actuator.analysis.palette import INK, PRESSURE_SCALE, VELOCITY_STOPS
from hydra_actuator.analysis.surface import shaded, with_walls
import numpy as np

STYLE = {
    'font.family': 'sans-serif', 'font.size': 9, 'axes.spines.top': False,
    'axes.spines.right': False, 'axes.linewidth': 0.8, 'axes.edgecolor': '#59636e',
    'xtick.color': '#3b444c', 'ytick.color': '#3b444c', 'axes.labelcolor': '#1c2126',
    'grid.color': '#dde1e5', 'grid.linewidth': 0.6, 'axes.axisbelow': True,
    'axes.formatter.useoffset': False, 'svg.fonttype': 'none', 'pdf.fonttype': 42,
}
FINEST = 240                # rows and columns of a surface
STEEPNESS = 12.0            # of a surface over its whole range, in the light's eyes
LETTER = 0.075              # [inch], of a legend
DASHES = {'solid': '-', 'dash': '--', 'dot': ':', 'dashdot': '-.'}
MARKERS = {'line-ns-open': '|'}


def draw(container, figure: Figure) -> None:
    """Draw a figure into a matplotlib figure or subfigure."""
    kinds = {trace['type'] for trace in figure.traces}
    if 'surface' in kinds:
        draw_surface(container, figure)
    elif 'heatmap' in kinds:
        draw_map(container, figure)
    else:
        draw_panels(container, figure)


def draw_surface(container, figure: Figure) -> None:
    """Draw a surface over streamline and time, shaded so that waves show."""
    (trace,), scene = figure.traces, figure.layout['scene']
    x, values = with_walls(trace['x'], trace['z'])
    time = np.tile(trace['y'][:, :1], (1, x.shape[1]))
    limits = trace['cmin'], trace['cmax']
    axes = container.add_subplot(projection='3d', computed_zorder=False)
    steepness = STEEPNESS / max(limits[1] - limits[0], 1e-30)
    axes.plot_surface(
        x, time, values, shade=False, rcount=FINEST, ccount=FINEST, linewidth=0,
        facecolors=shaded(values, _colours(trace), limits, steepness), antialiased=False,
        rasterized=True)
    axes.set_xticks(scene['xaxis']['tickvals'], scene['xaxis']['ticktext'])
    for axis, words in (('x', 'xaxis'), ('y', 'yaxis'), ('z', 'zaxis')):
        getattr(axes, f'set_{axis}label')(scene[words]['title']['text'], labelpad=4)
        getattr(axes, f'{axis}axis').pane.set_visible(False)
    axes.tick_params(pad=0, labelsize=8)
    axes.set_box_aspect((1.55, 1.25, 0.8), zoom=1.08)
    axes.view_init(elev=28, azim=-58)


def draw_map(container, figure: Figure) -> None:
    """Draw a heat map with the lines over it."""
    axes = container.subplots()
    for trace in figure.traces:
        if trace.get('visible', True) and trace['type'] == 'heatmap':
            image = axes.pcolormesh(
                trace['x'], trace['y'], trace['z'], cmap=_colours(trace), vmin=trace['zmin'],
                vmax=trace['zmax'], shading='gouraud', rasterized=True)
            _colour_bar(container, axes, image, trace)
        elif trace.get('visible', True):
            _line(axes, trace)
    _axis(axes, 'x', figure.layout['xaxis'])
    _axis(axes, 'y', figure.layout['yaxis'])


def draw_panels(container, figure: Figure) -> None:
    """Draw lines and marks in stacked panels, with one legend above."""
    names = sorted((key for key in figure.layout if key.startswith('yaxis')),
                   key=lambda key: int(key[5:] or 1))
    column = container.subplots(len(names), 1, sharex=True, squeeze=False)[:, 0]
    panels = {f'y{name[5:]}': axes for name, axes in zip(names, column)}
    handles: dict = {}
    for trace in figure.traces:
        line = _line(panels[trace.get('yaxis', 'y')], trace)
        if trace.get('showlegend', True):
            handles.setdefault(trace['name'], line)
    for name, axes in zip(names, column):
        axes.grid(True)
        for shape in figure.layout.get('shapes', ()):
            _shape(axes, shape)
        _axis(axes, 'y', figure.layout[name])
    _axis(column[-1], 'x', figure.layout['xaxis'])
    container.align_ylabels(column)
    if len(handles) > 1 or (len(column) > 1 and handles):
        column[0].legend(
            handles.values(), handles.keys(), loc='lower left', bbox_to_anchor=(0.0, 1.0),
            ncols=_columns(column[0], list(handles)), frameon=False, fontsize=8,
            handlelength=2.2, columnspacing=1.2, borderaxespad=0.2)


def _columns(axes, names: list[str]) -> int:
    """Return how many columns of a legend fit into the width of a figure."""
    width = 0.85 * axes.figure.bbox.width / axes.figure.dpi
    return max(1, min(len(names), int(width / (LETTER * (max(map(len, names)) + 7)))))


def _line(axes, trace: dict):
    """Draw one trace of lines or of marks and return it."""
    style, marker = trace.get('line', {}), trace.get('marker', {})
    look = {}
    if 'lines' not in trace['mode']:
        look = {'linestyle': 'none', 'color': marker.get('color'), 'clip_on': False,
                'marker': MARKERS.get(marker.get('symbol'), 'o'), 'markeredgewidth': 1.6,
                'markersize': marker.get('size', 4.0)}
    else:
        look = {'color': style.get('color'), 'linewidth': 0.8 * style.get('width', 1.5),
                'linestyle': DASHES[style.get('dash', 'solid')],
                'drawstyle': 'steps-post' if style.get('shape') == 'hv' else 'default'}
        if 'markers' in trace['mode']:
            look.update(marker='o', markersize=2.5)
    x, y = (np.array([np.nan if v is None else v for v in trace[axis]], float)
            for axis in 'xy')
    # Gouraud meshes and long lines alike are drawn beneath what marks places.
    return axes.plot(x, y, label=trace['name'], rasterized=len(x) > 30_000, **look)[0]


def _shape(axes, shape: dict) -> None:
    """Draw a vertical line or a span over the whole height of a panel."""
    if shape['type'] == 'line':
        axes.axvline(shape['x0'], color=shape['line']['color'], zorder=0.5,
                     linewidth=0.8 * shape['line']['width'],
                     linestyle=DASHES[shape['line'].get('dash', 'solid')])
    else:
        axes.axvspan(shape['x0'], shape['x1'], color=shape['fillcolor'], linewidth=0,
                     alpha=shape['opacity'], zorder=0.4)


def _axis(axes, which: str, layout: dict) -> None:
    """Give an axis its title, type, ticks and range."""
    from matplotlib.ticker import FixedLocator, NullLocator

    getattr(axes, f'set_{which}label')(layout.get('title', {}).get('text', ''))
    logarithmic = layout.get('type') == 'log'
    if logarithmic:
        getattr(axes, f'set_{which}scale')('log')
        if 'tickvals' in layout:
            axis = getattr(axes, f'{which}axis')
            axis.set_major_locator(FixedLocator(layout['tickvals']))
            axis.set_major_formatter('{x:g}')
            axis.set_minor_locator(NullLocator())
    elif 'tickvals' in layout:
        getattr(axes, f'set_{which}ticks')(
            layout['tickvals'], [text.replace('<br>', '\n') for text in layout['ticktext']])
    if 'range' in layout:
        ends = layout['range']
        limits = [10.0**end for end in ends] if logarithmic else ends
        getattr(axes, f'set_{which}lim')(*limits)


def _colour_bar(container, axes, image, trace: dict) -> None:
    """Draw the colour bar of a map, with its own ticks if it has some."""
    bar = container.colorbar(image, ax=axes, pad=0.02, aspect=32)
    bar.outline.set_visible(False)
    words = trace['colorbar']
    bar.set_label(f'{trace["name"]} [{words["title"]["text"]}]', color=INK)
    if 'tickvals' in words:
        bar.set_label(trace['name'], color=INK)
        bar.set_ticks(words['tickvals'], labels=words['ticktext'])


def _colours(trace: dict):
    """Return the colour map of a trace."""
    from matplotlib import colormaps
    from matplotlib.colors import LinearSegmentedColormap

    if trace['colorscale'] == PRESSURE_SCALE:
        return colormaps['cividis']
    return LinearSegmentedColormap.from_list('signed', VELOCITY_STOPS)
