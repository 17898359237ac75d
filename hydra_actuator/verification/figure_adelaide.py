# SPDX-License-Identifier: Apache-2.0
"""Figures of the Adelaide rig: the first plateau, the cavities."""

from hydra_actuator.verification import adelaide
from hydra_actuator.verification.case import illustrated
from hydra_actuator.verification.drawing import (
    EXACT_LINE,
    EXACT_POINT,
    MEGAPASCAL,
    MILLI,
    SERIES,
    SOLVER,
    VERMILION,
)
import numpy as np


def draw_plateau(figure) -> None:
    """Draw the pressure at the valve until the cavity opens, and what is known of it."""
    axes = figure.subplots()
    trace = adelaide.slam(adelaide.FAST, 200, 0.975)
    shown = trace.time < 0.075
    times = np.array(adelaide.PLATEAU)
    axes.plot(MILLI * trace.time[shown], trace.pressure[shown] / 1e3, **SOLVER)
    axes.plot(MILLI * times, trace.plateau(*times) / 1e3, color=SERIES[1], linestyle='--',
              linewidth=1.0, label='line through the plateau')
    axes.errorbar(MILLI * times, adelaide.KNOWN, adelaide.BAR * np.array(adelaide.KNOWN),
                  fmt='none', ecolor=VERMILION, capsize=4, label='their tolerance, 0.3 %')
    axes.plot(MILLI * times, adelaide.KNOWN, **{
        **EXACT_POINT, 'label': 'figures independent of grid'})
    axes.errorbar(MILLI * times, adelaide.PUBLISHED,
                  adelaide.TRACE_BAR * np.array(adelaide.PUBLISHED), fmt='s', color=SERIES[2],
                  markersize=5, capsize=4, label='published trace, within 5 %')
    axes.axhline(-adelaide.FLOOR / 1e3, color='#59636e', linestyle=':', linewidth=0.9,
                 label='vapour pressure')
    axes.set_xlabel('time [ms]')
    axes.set_ylabel('gauge pressure at the valve [kPa]')
    axes.grid(True)
    axes.legend(loc='center')


def draw_cavities(figure) -> None:
    """Draw pressure and gas of both experiments on all meshes, and the errors by mesh."""
    panels = figure.subplot_mosaic([['p0', 'g0'], ['p1', 'g1'], ['e', 'e']],
                                   height_ratios=(1.0, 1.0, 1.0))
    for k, run in enumerate((adelaide.FAST, adelaide.SLOW)):
        for axes, name in ((panels[f'p{k}'], 'pressure'), (panels[f'g{k}'], 'gas')):
            _draw_meshes(axes, run, name)
            for time, what in ((run.opens, 'opens'), (run.closes, 'closes')):
                axes.axvline(MILLI * time, color=EXACT_LINE['color'], linewidth=2.5, alpha=0.6,
                             label='_' if what == 'closes' else 'known: opens, closes')
            axes.set_title(f'{run.velocity} m/s', loc='left')
            axes.set_xlabel('time [ms]')
            axes.grid(True)
        panels[f'p{k}'].set_ylabel('gauge, at the valve [MPa]')
        panels[f'g{k}'].set_ylabel('gas in the line [ml]')
        panels[f'g{k}'].axhline(1e6 * run.volume, color=EXACT_LINE['color'], linewidth=2.5,
                                alpha=0.6, linestyle='--', label='known: largest volume')
    panels['p0'].legend(loc='upper right', fontsize=7)
    panels['g0'].legend(loc='lower center', fontsize=7, bbox_to_anchor=(0.52, 0.0))
    _draw_errors(panels['e'])


def _draw_meshes(axes, run, name: str) -> None:
    for colour, cells in zip(SERIES, adelaide.CELLS):
        for courant in adelaide.COURANTS:
            trace = adelaide.slam(run, cells, courant)
            axes.plot(MILLI * trace.time, 1e6 * trace.gas if name == 'gas'
                      else MEGAPASCAL * trace.pressure, color=colour, linewidth=0.6,
                      label=f'{cells} cells' if courant == adelaide.COURANTS[0] else '_')


def _draw_errors(axes) -> None:
    """Draw the errors of all rows, one place for each mesh, in parts of the tolerance."""
    rows, places = adelaide.column_separation(), {}
    for row in rows:
        mesh, _, what = row.quantity.rpartition(': ')
        place = places.setdefault(mesh, len(places))
        k = ('opens', 'closes', 'largest').index(what)
        label = {'largest': 'largest volume'}.get(what, what)
        axes.plot(place, row.used, color=SERIES[k], marker='os^'[k], linestyle='none',
                  label=label if place == 0 else '_')
    axes.axhline(1.0, color=VERMILION, linestyle='--', linewidth=1.1, label='tolerance, 0.3 %')
    axes.set_xticks(range(len(places)), [
        mesh.replace(' cells, Courant', ',\nC').replace(' m/s, ', ' m/s\n') for mesh in places],
        fontsize=6.5)
    axes.set_ylabel('error / tolerance')
    axes.set_ylim(0.0, 1.35)
    axes.grid(True)
    axes.legend(ncols=4, loc='upper right', fontsize=7)


CASES = illustrated(adelaide.CASES, adelaide_plateau=draw_plateau, adelaide_cavity=draw_cavities)
