# SPDX-License-Identifier: Apache-2.0
"""Figures of free gas and vapour in a lone line."""

from hydra_actuator.verification import cavitation
from hydra_actuator.verification.case import illustrated
from hydra_actuator.verification.drawing import (
    band,
    bar,
    EXACT_LINE,
    MARKERS,
    MEGAPASCAL,
    MILLI,
    SERIES,
)
import numpy as np

MILLILITRE = 1e6        # in a cubic metre


def draw_gas_wave_speed(figure) -> None:
    """Draw wave speed over pressure for each share of gas, and the errors."""
    above, below = figure.subplots(2, height_ratios=(3, 1.4))
    pressures = np.geomspace(5e4, 2e7, 200)
    ticks = []
    for k, (share, pressure) in enumerate(cavitation.MIXTURES):
        exact = [cavitation.mixture_speed(share, one) for one in pressures]
        above.plot(MEGAPASCAL * pressures, exact, **{**EXACT_LINE, 'label': '_' if k else 'exact'})
        speed = cavitation.mixture_speed(share, pressure)
        for n, courant in enumerate(cavitation.COURANTS):
            got = cavitation.quarter_wave_speed(share, pressure, courant, speed)
            style = {'color': SERIES[k], 'marker': MARKERS[n], 'fillstyle': 'none',
                     'linestyle': 'none', 'markersize': 5 + 3 * n}
            above.plot(MEGAPASCAL * pressure, got, **style,
                       label='_' if k else f'solver, Courant {courant}')
            below.plot(3 * k + n, got / speed - 1.0, **style)
            ticks.append(f'{share:g} of gas\nCourant {courant}')
        above.annotate(f'{share:g} of gas at gauge pressure 0', (MEGAPASCAL * pressure, speed),
                       (12, -16), textcoords='offset points', color=SERIES[k])
    above.axhline(cavitation.WAVE_SPEED, color='#7a838c', linewidth=0.8, linestyle=':',
                  label='oil without gas')
    above.set_xscale('log')
    above.set_xlabel('gauge pressure [MPa]')
    above.set_ylabel('wave speed [m/s]')
    above.legend()
    band(below, cavitation.SPEED_BAR)
    below.set_xticks(range(len(ticks)), ticks, fontsize=7.5)
    below.set_ylabel('error, relative')
    for axes in (above, below):
        axes.grid(True)


def draw_vapour_pressure(figure) -> None:
    """Draw the pressure at the valve that is slammed, and the lowest in the line."""
    above, below = figure.subplots(2, sharex=True)
    for colour, courant in zip(SERIES, cavitation.COURANTS):
        time, lowest, at_valve = cavitation.boil(courant)
        style = {'color': colour, 'linewidth': 1.0, 'label': f'Courant {courant}'}
        above.plot(MILLI * time, MEGAPASCAL * (at_valve + cavitation.VAPOUR_PRESSURE), **style)
        below.plot(MILLI * time, lowest, **style)
    above.axhline(0.0, color='#59636e', linewidth=0.8)
    above.set_ylabel('absolute pressure at the valve [MPa]')
    bar(below, 2.0 * cavitation.VAPOUR_BAR, label='where it boils: 0 to 100 Pa')
    below.set_yscale('log')
    below.set_ylim(1.0, 3e7)
    below.set_ylabel('lowest p - p$_v$ anywhere [Pa]')
    below.set_xlabel('time [ms]')
    for axes in (above, below):
        axes.grid(True)
        axes.legend(ncols=4, loc='upper right')


def draw_cavity_mass(figure) -> None:
    """Draw the gas against the oil that is missing, and the balance of the oil."""
    above, below = figure.subplots(2, sharex=True)
    density = cavitation.DENSITY
    for colour, courant in zip(SERIES, cavitation.COURANTS):
        missing, gas, _, time = cavitation.weigh(cavitation.CELLS, courant).T
        above.plot(MILLI * time, MILLILITRE * (gas - missing / density), **{
            **EXACT_LINE, 'label': '_' if above.lines else 'oil displaced: in - out'})
        above.plot(MILLI * time, MILLILITRE * gas, color=colour, linewidth=1.2,
                   label=f'gas, Courant {courant}')
        below.plot(MILLI * time, missing / cavitation.FRONT, color=colour, linewidth=0.9,
                   label=f'Courant {courant}')
    band(below, 1.0)
    above.set_ylabel('volume [ml]')
    below.set_ylabel('in - out - stored [cells of a front]')
    below.set_xlabel('time [ms]')
    for axes in (above, below):
        axes.grid(True)
        axes.legend(ncols=4, loc='upper right')


def draw_alternate_nodes(figure) -> None:
    """Draw the gas node by node beside the valve, and the size of a pattern over time."""
    left, right = figure.subplots(1, 2)
    for k, (colour, courant) in enumerate(zip(SERIES, cavitation.COURANTS)):
        time, size, gas = cavitation.growing_zone(courant)
        left.plot(range(1, 41), 1e9 * gas[:40], color=colour, marker=MARKERS[k], markersize=3.5,
                  linewidth=0.8, label=f'Courant {courant}')
        right.plot(MILLI * time, size, color=colour, linewidth=1.2, label=f'Courant {courant}')
    left.set_title(f'gas at each node, {MILLI * time[-1]:.1f} ms', loc='left')
    left.set_xlabel('nodes from the valve')
    left.set_ylabel('gas [mm$^3$]')
    bar(right, cavitation.PATTERN_BAR)
    right.set_title('odd against even nodes, in parts of the mean', loc='left')
    right.set_yscale('log')
    right.set_ylim(1e-6, 2e-2)
    right.set_xlabel('time [ms]')
    for axes in (left, right):
        axes.grid(True)
        axes.legend()


CASES = illustrated(
    cavitation.CASES, gas_wave_speed=draw_gas_wave_speed, vapour_pressure=draw_vapour_pressure,
    cavity_mass=draw_cavity_mass, alternate_nodes=draw_alternate_nodes)
