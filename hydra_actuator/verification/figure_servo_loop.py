# SPDX-License-Identifier: Apache-2.0
"""Figures of the position servo in the lumped limit."""

from hydra_actuator.verification import servo_loop
from hydra_actuator.verification.case import illustrated
from hydra_actuator.verification.drawing import band, EXACT_POINT, SIMPLER, SOLVER
import numpy as np

BOILS = 0.053           # s, when chamber 1 does for the first time
WHOLE = 3.01            # s


def draw_published(figure) -> None:
    """Draw the position beside the published points: all of it, and what is judged."""
    trace = servo_loop.published_trace(WHOLE)
    judged = (*servo_loop.BEFORE_VAPOUR, servo_loop.FIRST_PEAK, servo_loop.AFTER_FIRST,
              servo_loop.SECOND_PEAK)
    grid = figure.add_gridspec(2, 2)
    whole, first, second = (figure.add_subplot(grid[place]) for place in (
        (0, slice(None)), (1, 0), (1, 1)))
    for axes in (whole, first, second):
        axes.plot(*trace, **SOLVER)
        axes.plot(*np.array(judged).T, **{**EXACT_POINT, 'label': 'published, judged'})
        axes.plot(*np.array(servo_loop.LATER).T, **{
            **EXACT_POINT, 'fillstyle': 'none', 'label': 'published, shown'})
        axes.axvline(BOILS, **SIMPLER)
        axes.set_xlabel('time [s]')
        axes.set_ylabel('position [m]')
        axes.grid(True)
    before, after, instant = servo_loop.published_loop().reference
    whole.step([0.0, instant, WHOLE], [before, after, after], where='post',
               **{**SIMPLER, 'label': 'reference'})
    whole.legend(ncols=4, loc='lower right')
    first.set_xlim(0.0, 0.2)
    second.set_xlim(0.98, 1.22)
    first.annotate('chamber 1 boils from here', (BOILS, 0.0), (4, 4),
                   textcoords='offset points', fontsize=8)


def draw_gentle(figure) -> None:
    """Draw the position beside the lumped solution, and how far apart they are."""
    trace = servo_loop.gentle_trace()
    times, expected = np.array(servo_loop.GENTLE).T
    above, below = figure.subplots(2, height_ratios=(3, 1.4), sharex=True)
    above.plot(*trace, **SOLVER)
    above.plot(times, expected, **{**EXACT_POINT, 'label': 'lumped solution'})
    above.set_ylabel('position [m]')
    above.legend(loc='lower right')
    below.plot(times, np.interp(times, *trace) / expected - 1.0, **{**SOLVER, 'marker': 'o'})
    band(below, 0.005)
    below.set_ylabel('error, relative')
    below.set_xlabel('time [s]')
    for axes in (above, below):
        axes.grid(True)


CASES = illustrated(servo_loop.CASES, servo_published=draw_published, servo_gentle=draw_gentle)
