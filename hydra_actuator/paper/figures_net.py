# SPDX-License-Identifier: Apache-2.0
"""
Figures 3d, 4a, 4b: time levels and characteristics.

    along dx/dt = u + c and dx/dt = u - c, reflected at the ends of each domain

The paper lets its net run freely, so the nodes of one loop differ in time; here a step is common
to all nodes and values are interpolated at the feet. The lines of 4a and 4b are integrated
through the run's velocities, linear between nodes and frames; neglected: nothing else.
"""

from itertools import pairwise

from hydra_actuator.analysis import streamline
from hydra_actuator.analysis.characteristics import family, Net
from hydra_actuator.analysis.palette import BLUE, INK, ORANGE, VERMILION
from hydra_actuator.analysis.series import Field
from hydra_actuator.geometry import wave_speed
from hydra_actuator.paper.canvas import station_ticks, TAU_LABEL, X_LABEL
from hydra_actuator.paper.case import Case
from hydra_actuator.paper.runs import Run
import numpy as np

# What the paper's run ends in: the times of the nodes of its last loop [L/c].
WINDOW = (50.570, 50.577)
NET_START, NET_UNITS, ALL_UNITS = 10.0, 0.25, 0.8      # [L/c]
NET_SPACING, ALL_SPACING = 0.01, 0.02      # of the net's lines [L]


def figure_3d(figure, case: Case) -> str:
    """Draw the time levels within the window of the paper, with their characteristics."""
    run = case.run()
    whole, near = figure.subplots(1, 2, width_ratios=(1.5, 1), sharey=True)
    level = run.step_time / run.time_unit
    first = int(WINDOW[0] / level)
    levels = np.arange(first, first + 3) * level
    field = _frame_at(run.field, levels[0] * run.time_unit)
    x = run.positions_of(field)[0] / run.length_unit
    known = np.isfinite(field.velocity[0])
    face = x[field.faces[0]]
    for axes, limits, every in ((whole, (0.0, 1.0), 5), (near, (face - 0.028, face + 0.028), 1)):
        inside = known & (x >= limits[0] - 0.01) & (x <= limits[1] + 0.01)
        _draw_levels(axes, run, levels, (x[inside][::every], field.velocity[0, inside][::every]))
        axes.axhspan(*WINDOW, color=ORANGE, alpha=0.16, linewidth=0)
        axes.plot([face, face], [levels[0], levels[-1]], color=VERMILION, linewidth=2.0)
        axes.set(ylim=(levels[0] - 0.2 * level, levels[-1] + 0.2 * level), xlim=limits,
                 xlabel=X_LABEL)
        axes.yaxis.set_major_formatter('{x:.4f}')
    station_ticks(whole, run)
    whole.set_ylabel(TAU_LABEL)
    whole.set_title('all domains, every fifth node', fontsize=9)
    near.set_title('near the piston (red)', fontsize=9)
    inside = int(np.sum((levels >= WINDOW[0]) & (levels <= WINDOW[1])))
    return (f'Shaded: the window {WINDOW[0]:.3f} to {WINDOW[1]:.3f} units, over which the nodes '
            f"of the paper's last loop lie. Here all nodes share one time: levels are "
            f'{level:.5f} units = {run.step_time * 1e6:.4g} us apart and {inside} lies in the '
            'window. Lines: the characteristics u + c (blue) and u - c (orange) that '
            'arrive at the nodes (dots); velocities are those of the nearest frame.')


def _draw_levels(axes, run: Run, levels: np.ndarray, nodes: tuple) -> None:
    """Draw nodes (x/L, u) at all levels and, back from each, its two characteristics."""
    x, velocity = nodes
    speed = wave_speed(run.parameters)
    dt, unit = run.step_time, run.length_unit
    for below, above in pairwise(levels):
        for slope, colour in ((velocity + speed, BLUE), (velocity - speed, ORANGE)):
            start = x - slope * dt / unit
            axes.plot(np.stack((start, x)), [[below], [above]] * np.ones((2, len(x))),
                      color=colour, linewidth=0.6)
    for level in levels:
        axes.plot(x, np.full(x.shape, level), '.', color=INK, markersize=2.0)


def _frame_at(field: Field, time: float) -> Field:
    """Return the frame nearest to a time [s]."""
    k = int(np.abs(field.time - time).argmin())
    return Field(field.time[k:k + 1], field.positions, field.labels, field.pressure[k:k + 1],
                 field.velocity[k:k + 1], field.faces, field.source)


def net_of(run: Run, domain: str, span: tuple[int, int]) -> Net:
    """Return the net of a domain between two frames of the dense beginning of a run."""
    field, part = run.first, slice(span[0], span[1] + 1)
    inside = np.flatnonzero(np.array(field.labels) == domain)
    velocity = streamline.gapless(field, field.velocity)
    return Net(field.time[part], run.positions_of(field)[part, inside], velocity[part, inside],
               wave_speed(run.parameters, domain))


def draw_net(axes, run: Run, domains: tuple, span: tuple[int, int], spacing: float) -> None:
    """Draw the nets of some domains between two frames of the beginning, and the piston."""
    for domain in domains:
        net = net_of(run, domain, span)
        x, way = net.lines(spacing * run.length_unit)
        for sign, colour in ((1.0, BLUE), (-1.0, ORANGE)):
            axes.plot(family(x, way, sign) / run.length_unit, net.time / run.time_unit,
                      color=colour, linewidth=0.7)
    face = run.positions_of(run.first)[span[0]:span[1] + 1, run.first.faces[0]]
    tau = run.first.time[span[0]:span[1] + 1] / run.time_unit
    axes.plot(face / run.length_unit, tau, color=VERMILION, linewidth=2.0)
    axes.set(ylabel=TAU_LABEL, ylim=(tau[0], tau[-1]))


def _span(run: Run, units: float) -> tuple[int, int]:
    """Return the frames of the beginning between which a net is drawn."""
    tau = run.first.time / run.time_unit
    last = len(tau) - 1
    start = min(NET_START, max(0.0, tau[-1] - units))
    first = int(np.searchsorted(tau, start - 1e-9))
    return first, min(last, int(np.searchsorted(tau, tau[first] + units)))


def _words(run: Run, span: tuple[int, int]) -> str:
    """Return how little the net is deflected, in words."""
    face = run.positions_of(run.first)[span[0]:span[1] + 1, run.first.faces[0]]
    mach = run.rows[:, run.channels.MACH].max()
    return (f'Blue: u + c, orange: u - c, red: the piston, which moves '
            f'{np.ptp(face) / run.length_unit:.2g} L in this window. Largest |u|/c of the run: '
            f'{mach:.4f}, by which slopes are deflected.')


def figure_4a(figure, case: Case) -> str:
    """Draw the net of characteristics between the ends of the cylinder."""
    run = case.run()
    span = _span(run, NET_UNITS)
    axes = figure.subplots()
    draw_net(axes, run, ('chamber_1', 'chamber_2'), span, NET_SPACING)
    ends = streamline.boundaries(run.field)[2:4]
    unit = run.length_unit
    axes.set(xlabel=f'{X_LABEL}, D to G', xlim=[x / unit for x, _ in ends])
    return _words(run, span)


def figure_4b(figure, case: Case) -> str:
    """Draw the net of characteristics in all domains."""
    run = case.run()
    span = _span(run, ALL_UNITS)
    axes = figure.subplots()
    draw_net(axes, run, streamline.DOMAINS, span, ALL_SPACING)
    station_ticks(axes, run)
    return f'{_words(run, span)} Each domain reflects its own lines; ends are ticked.'
