# SPDX-License-Identifier: Apache-2.0
"""
Draw the design study: `python examples/design_study/draw.py build/study docs/design_study.png`.

Reads the results of the sweep and prints how many designs meet the requirement, and the one that
takes the least power.
"""

import sys

from hydra_actuator.analysis.palette import BLUE, GREEN, INK, ORANGE, PURPLE, VERMILION
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, NullFormatter
import numpy as np
from pyarrow import parquet

# 2 mm peak to peak of 30 kg at 100 Hz, no cavity, no more than a third above the supply.
BANDWIDTH, TRAVEL, PRESSURE = 100.0, 2e-3, 28e6
AREA, GRADIENT, LENGTH = 'cylinder.area_1', 'valve.area_gradient', 'line_1.length'


def verdicts(d: dict) -> dict[str, np.ndarray]:
    """Return masks of the designs: why each is out, first reason first, and those that are in."""
    reasons = {
        'cavitates': d['cavity_volume'] > 0.0, 'bandwidth too low': d['bandwidth'] < BANDWIDTH,
        'travel too short': d['travel'] < TRAVEL,
        'pressure too high': d['peak_pressure'] > PRESSURE}
    left, found = np.ones(len(d['run']), bool), {}
    for name, out in reasons.items():
        found[name] = left & out
        left = left & ~out
    return {**found, 'meets all': left}


def draw(d: dict) -> Figure:
    """Return the picture."""
    figure = Figure(figsize=(10.5, 8.0), layout='constrained')
    (bandwidth, travel), (pressure, choice) = figure.subplots(2, 2)
    area, gradient, length = 1e4 * d[AREA], 1e3 * d[GRADIENT], 1e3 * d[LENGTH]
    scatter(bandwidth, (area, d['bandwidth']), (length, 'line length [mm]'))
    bandwidth.set(xscale='log', xlabel='piston area [cm²]', ylabel='bandwidth [Hz]',
                  title='The bore sets the bandwidth, long lines take some of it')
    bandwidth.axhline(BANDWIDTH, color=INK, linestyle=':', linewidth=1)
    scatter(travel, (gradient, 1e3 * d['travel']), (area, 'piston area [cm²]'))
    travel.set(xscale='log', xlabel='valve area gradient [mm]',
               ylabel='travel at 100 Hz, full command [mm]',
               title='Small valves are short of flow, small pistons of force')
    travel.axhline(1e3 * TRAVEL, color=INK, linestyle=':', linewidth=1)
    scatter(pressure, (gradient, 1e-6 * d['peak_pressure']), (length, 'line length [mm]'))
    pressure.set(xscale='log', xlabel='valve area gradient [mm]',
                 ylabel='peak pressure anywhere [MPa]',
                 title='The valve sets the peak pressure')
    pressure.axhline(1e-6 * PRESSURE, color=INK, linestyle=':', linewidth=1)
    for (name, mask), colour in zip(verdicts(d).items(), (VERMILION, PURPLE, ORANGE, INK, GREEN)):
        if not mask.any():
            continue
        good = name == 'meets all'
        choice.scatter(area[mask], gradient[mask], color=colour, s=34 if good else 16,
                       marker='o' if good else 'x', linewidths=1.0,
                       label=f'{name} ({mask.sum()})', zorder=3 if good else 2)
    best = least_power(d)
    choice.scatter(area[best], gradient[best], s=110, facecolors='none', edgecolors=BLUE,
                   linewidths=1.8, label=f'least power, {1e-3 * d["supply_power"][best]:.1f} kW')
    choice.set(xscale='log', yscale='log', xlabel='piston area [cm²]',
               ylabel='valve area gradient [mm]', title='Which designs are left')
    choice.legend(fontsize=8, loc='upper left', framealpha=0.9)
    for axes in (bandwidth, travel, pressure, choice):
        axes.title.set_size(10)
        axes.grid(True, color='#dde1e5', linewidth=0.6)
        axes.set_axisbelow(True)
        label(axes.xaxis)
    label(choice.yaxis)
    return figure


def scatter(axes, points: tuple, colour: tuple) -> None:
    """Draw points coloured by a third quantity, its name beside the bar."""
    values, name = colour
    drawn = axes.scatter(*points, c=values, cmap='cividis', norm=LogNorm(), s=14)
    bar = axes.figure.colorbar(drawn, ax=axes, label=name)
    label(bar.ax.yaxis)


def label(axis) -> None:
    """Label a logarithmic axis 1, 2, 5, 10, plainly."""
    axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    axis.set_major_formatter('{x:g}')
    axis.set_minor_formatter(NullFormatter())


def least_power(d: dict) -> int:
    """Return the row of the design that meets all with the least power."""
    return int(np.argmin(np.where(verdicts(d)['meets all'], d['supply_power'], np.inf)))


def main() -> None:
    """Read, draw, tell."""
    table = parquet.read_table(f'{sys.argv[1]}/results.parquet')
    d = {name: table[name].to_numpy() for name in table.column_names}
    draw(d).savefig(sys.argv[2], dpi=110)
    for name, mask in verdicts(d).items():
        print(f'{name}: {mask.sum()} of {len(mask)}')
    best = least_power(d)
    print(f'least power: run {d["run"][best]}, area {1e4 * d[AREA][best]:.2f} cm², gradient '
          f'{1e3 * d[GRADIENT][best]:.1f} mm, lines {1e3 * d[LENGTH][best]:.0f} mm: '
          f'{d["bandwidth"][best]:.0f} Hz, {1e3 * d["travel"][best]:.2f} mm, '
          f'{1e-6 * d["peak_pressure"][best]:.1f} MPa, {1e-3 * d["supply_power"][best]:.2f} kW')


if __name__ == '__main__':
    main()
