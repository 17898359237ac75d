# SPDX-License-Identifier: Apache-2.0
"""
Figures 2a, 2b, 3a, 3b: over streamline and time, as a surface and as a map.

The surface shows the beginning, as long as the paper's run; the map the whole run. Frames are
every 72 steps, at 200 Hz every sixth. 3a and 3b show what a second pass over slope and friction
changes: the run with two passes less the run with one. Nodes that only one of the two moving
meshes has are taken as their piston's face.
"""

from dataclasses import dataclass, replace

from hydra_actuator.analysis import streamline
from hydra_actuator.analysis.series import Field
from hydra_actuator.analysis.surface import shaded, with_walls
from hydra_actuator.paper.canvas import (
    about_cavities,
    PRESSURE,
    Quantity,
    SMALL,
    station_ticks,
    TAU_LABEL,
    VELOCITY,
    velocity_colours,
)
from hydra_actuator.paper.case import Case
from hydra_actuator.paper.runs import Run
import numpy as np

COLUMNS = 400
FINEST = 260                # rows and columns of a surface


@dataclass(frozen=True)
class Layer:
    """Values (frames, nodes) in the paper's units over x/L and t c/L, and how to colour them."""

    run: Run
    field: Field
    values: np.ndarray
    label: str
    signed: bool

    @property
    def tau(self) -> np.ndarray:
        """Time of the frames [L/c]."""
        return self.field.time / self.run.time_unit

    @property
    def x(self) -> np.ndarray:
        """x/L of every node in every frame."""
        return self.run.positions_of(self.field) / self.run.length_unit

    @property
    def limits(self) -> tuple[float, float]:
        """Return the range of the colours; of what has a sign, symmetric about zero."""
        low, high = float(self.values.min()), float(self.values.max())
        if self.signed:
            low, high = -max(-low, high, 1e-30), max(-low, high, 1e-30)
        return low, high

    @property
    def colours(self):
        """Return the colour map."""
        from matplotlib import colormaps
        return velocity_colours() if self.signed else colormaps['cividis']

    def until(self, tau: float) -> 'Layer':
        """Return the frames up to a time [L/c]."""
        count = int(np.searchsorted(self.tau, tau, side='right'))
        field = replace(self.field, time=self.field.time[:count])
        return replace(self, field=field, values=self.values[:count])


def layer_of(run: Run, quantity: Quantity) -> Layer:
    """Return velocity or pressure of a run's field."""
    values = streamline.gapless(run.field, quantity.field(run, run.field))
    return Layer(run, run.field, values, quantity.label, quantity.velocity)


def difference_of(run: Run, one_pass: Run, quantity: Quantity) -> Layer:
    """Return what the second pass changes, run less one_pass."""
    change = quantity.field(run, run.field) - quantity.field(one_pass, one_pass.field)
    label = f'change of {quantity.symbol} [-]'
    return Layer(run, run.field, streamline.gapless(run.field, change), label, True)


def draw_layer(figure, layer: Layer, shown: float) -> None:
    """Draw a layer: left its surface up to `shown` [L/c], right the map of all of it."""
    surface = figure.add_subplot(1, 2, 1, projection='3d', computed_zorder=False)
    draw_surface(surface, layer.until(shown))
    axes = figure.add_subplot(1, 2, 2)
    image = draw_map(axes, layer)
    bar = figure.colorbar(image, ax=axes, pad=0.015, aspect=32)
    bar.set_label(layer.label if layer.signed else f'{layer.label[:-4]} less its mean [-]')
    bar.outline.set_visible(False)


def draw_surface(axes, layer: Layer) -> None:
    """Draw a layer as a surface over x/L and t c/L."""
    x, values = with_walls(layer.x, layer.values)
    limits = layer.limits
    # The light sees heights in cells: the same steepness whatever the unit is.
    steepness = 12.0 / max(limits[1] - limits[0], 1e-30)
    axes.plot_surface(
        x, np.tile(layer.tau[:, None], (1, x.shape[1])), values,
        facecolors=shaded(values, layer.colours, limits, steepness), shade=False,
        rcount=FINEST, ccount=FINEST, linewidth=0, antialiased=False)
    ends = streamline.boundaries(layer.field)
    unit = layer.run.length_unit
    axes.set_xticks([place / unit for place, _ in ends], [letters for _, letters in ends])
    axes.set_xlabel('x/L [-], O is 0, K is 1', labelpad=2)
    axes.set_ylabel(TAU_LABEL, labelpad=4)
    axes.set_title(layer.label, fontsize=9, y=1.0)
    axes.tick_params(pad=0, labelsize=8)
    axes.set_box_aspect((1.5, 1.3, 0.8), zoom=1.08)
    axes.view_init(elev=30, azim=-58)
    for axis in (axes.xaxis, axes.yaxis, axes.zaxis):
        axis.pane.set_visible(False)


def draw_map(axes, layer: Layer):
    """
    Draw a layer as a map, time upwards, the piston dotted; return the image.

    Pressures less their mean at each place: the levels of the domains would hide all else.
    """
    x = layer.x
    grid = np.linspace(x.min(), x.max(), COLUMNS)
    values = streamline.on_even_grid(x, layer.values, grid)
    if not layer.signed:
        values = values - values.mean(axis=0)
    most = float(np.abs(values).max())
    image = axes.pcolormesh(grid, layer.tau, values, cmap=velocity_colours(), vmin=-most,
                            vmax=most, shading='nearest', rasterized=True)
    axes.plot(x[:, layer.field.faces[0]], layer.tau, color='black', linewidth=0.8, linestyle=':')
    station_ticks(axes, layer.run)
    axes.set(ylabel=TAU_LABEL, ylim=(layer.tau[0], layer.tau[-1]))
    return image


def _draw(figure, case: Case, quantity: Quantity) -> str:
    run = case.run()
    layer = layer_of(run, quantity)
    draw_layer(figure, layer, run.tau[case.shown(run)][-1])
    outer = np.isin(np.array(run.field.labels), ('supply_line', 'return_line'))
    end = run.tau[case.shown(run)][-1]
    words = (f'Left the first {end:.4g} units, right the whole run, the piston dotted; '
             f'{quantity.unit_in_words(run)}. ')
    if quantity.velocity:
        back = -layer.values[:, outer].min() / layer.values.max()
        words += (f'Largest reverse flow in the outer domains O-A and J-K: {100 * back:.2g} % of '
                  'the largest velocity.')
    else:
        words += ('At the right less its mean at each place. Range over the whole run: '
                  f'{layer.values.min():.4g} to {layer.values.max():.4g}.')
    return words


def _draw_change(figure, case: Case, quantity: Quantity) -> str:
    run = case.run()
    layer = difference_of(run, case.run(passes=1), quantity)
    draw_layer(figure, layer, run.tau[case.shown(run)][-1])
    worst = np.abs(layer.values).max()
    largest = np.nanmax(np.abs(quantity.field(run, run.field)))
    unit, label = quantity.small_unit(run, worst)
    grain = not quantity.velocity and worst < SMALL
    kept = ' Fields are kept to 1e-7 of the unit, seen as grain.' if grain else ''
    return (f'Largest change {worst:.2g} of {quantity.symbol.split("/")[1]} '
            f'({float(f"{worst * unit:.2g}"):g} {label}), {worst / largest:.2g} of the largest '
            f'{quantity.name} there is; the paper: below 1e-4 of the unit.'
            f'{about_cavities(case)}{kept}')


def figure_2a(figure, case: Case) -> str:
    """Draw velocity over streamline and time."""
    return _draw(figure, case, VELOCITY)


def figure_2b(figure, case: Case) -> str:
    """Draw pressure over streamline and time."""
    return _draw(figure, case, PRESSURE)


def figure_3a(figure, case: Case) -> str:
    """Draw what a second pass changes of the velocity, over streamline and time."""
    return _draw_change(figure, case, VELOCITY)


def figure_3b(figure, case: Case) -> str:
    """Draw what a second pass changes of the pressure, over streamline and time."""
    return _draw_change(figure, case, PRESSURE)
