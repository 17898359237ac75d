# SPDX-License-Identifier: Apache-2.0
"""Statement on the return side's boundary: a tank at pressure zero, and oil that cannot pull."""

from hydra_actuator.paper.drawing import BLUE, GREY, panels, VERMILION
from hydra_actuator.paper.drive import PERIOD, reference, Trace
from hydra_actuator.paper.statement import Finding, Statement
import numpy as np

SPAN = 4 * PERIOD
MEGA, MILLI = 1e-6, 1e3
UNITS = 'time [L/c]'


def plain() -> Trace:
    """Return the paper's case: oil that bears any tension."""
    return reference(SPAN)


def with_gas() -> Trace:
    """Return the same with free gas and vapour at every node and end."""
    return reference(SPAN, fluid__cavitation=True)


def absolute(trace: Trace, station: str = 'J') -> np.ndarray:
    """Return the absolute pressure [Pa] at a station."""
    return trace.pressure(station) + trace.parameters['ambient_pressure']


def return_pressure() -> Statement:
    """Judge a return line that ends at pressure zero, without a model of cavities."""
    one, two = plain(), with_gas()
    lowest, with_cavities = float(absolute(one).min()), float(absolute(two).min())
    below = one.units[absolute(one) < 0.0]
    share = len(below) / len(one.units)
    apart = float(np.abs(one.position - two.position).max())
    return Statement(
        'return_pressure',
        'At the connection to the return pipeline the static pressure is zero, in oil that obeys '
        'one linear law of compression.', 'section 2, equation 6; section 4d, equation 16',
        lowest > 0.0,
        'The end K can be held at zero, but when the valve closes the oil in the return line runs '
        'on and pulls station J below vacuum, which no oil bears. With gas and vapour in the '
        'model a cavity opens there, and closes with a blow.',
        (Finding('lowest pressure at J, plain oil', 'MPa absolute', '-', f'{lowest * MEGA:.3f}'),
         Finding('time below vacuum at J, plain oil', '% of the run', '0', f'{100 * share:.1f}'),
         Finding('lowest pressure at J, with cavities', 'MPa absolute', '-',
                 f'{with_cavities * MEGA:.5f}'),
         Finding('highest pressure at J, plain and with cavities', 'MPa absolute', '-',
                 f'{absolute(one).max() * MEGA:.2f} and {absolute(two).max() * MEGA:.2f}'),
         Finding('piston, plain less with cavities, at most', 'mm', '-', f'{apart * MILLI:.3f}')),
        draw_vacuum)


def draw_vacuum(figure) -> None:
    """Draw the absolute pressure at J in the first period, and about the hardest blow."""
    left, right = panels(figure, (UNITS, 'pressure at J [MPa absolute]'),
                         (UNITS, 'pressure at J [MPa absolute]'))
    struck = with_gas().units[int(absolute(with_gas()).argmax())]
    for axes, start, end in ((left, 0.0, PERIOD), (right, struck - 2.0, struck + 2.0)):
        for trace, colour, label in ((plain(), VERMILION, 'plain oil'),
                                     (with_gas(), BLUE, 'with gas and vapour')):
            part = (trace.units >= start) & (trace.units <= end)
            axes.plot(trace.units[part], absolute(trace)[part] * MEGA, color=colour, label=label,
                      linewidth=1.0)
        axes.axhline(0.0, color=GREY, linewidth=0.8)
    left.set_ylim(-0.5, 1.5)
    left.legend(frameon=False, ncols=2, loc='lower center', bbox_to_anchor=(0.5, 1.0))


STATEMENTS = {'return_pressure': return_pressure}
