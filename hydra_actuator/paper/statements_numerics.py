# SPDX-License-Identifier: Apache-2.0
"""Statements on the method: how many steps, how long they hold, how many passes they need."""

from functools import cache
from typing import NamedTuple

from hydra_actuator.actuator import Actuator
from hydra_actuator.channels import Channels
from hydra_actuator.paper.drawing import BLUE, panels, VERMILION
from hydra_actuator.paper.drive import drive, frames, FREQUENCY, PERIOD, sine, unit_time
from hydra_actuator.paper.statement import Finding, Statement
from hydra_actuator.verification.passes import LIMIT, pass_difference, SINES
from hydra_actuator.verification.spool_response import paper_parameters
import numpy as np

# 65 periods of the paper's sine are 4 s, a whole number of steps: states then compare bit by bit.
BLOCK = 4.0             # [s]
FORGOTTEN = 2           # blocks, after which the start is below rounding
MANY = 10_000_000       # steps
ROUNDING = 1e-9         # relative: what may pile up of 1e-16 in each step
# The paper states it of a 100 Hz actuator, and draws 16.25 Hz.
DRIVES = (*SINES[:2], (100.0, 1.0, 10), *SINES[2:])
OF_PRESENT = 3e-3       # of the velocities present, the paper's second measure
BENT_DIAMETER = 0.007  # of the lines [m]: the reference's flow then bends slopes by 2.5 %
BENT_MACH = 0.05        # largest |u|/c that mesh has room for
MOST_PASSES = 5
MICRO = 1e6


class Blocks(NamedTuple):
    """States at the end of each block: steps (N,), positions [m] (N,), pressures [Pa] (N, 12)."""

    steps: np.ndarray
    position: np.ndarray
    pressure: np.ndarray

    def drift(self) -> tuple[float, float]:
        """Return the largest change of position [m] and pressure [Pa] after the start faded."""
        return tuple(float(np.abs(values[FORGOTTEN:] - values[FORGOTTEN - 1]).max())
                     for values in (self.position, self.pressure))


@cache
def run_blocks(steps: int = MANY) -> Blocks:
    """Run the paper's case for at least so many steps and keep its state every 65 periods."""
    actuator = Actuator(paper_parameters())
    each = round(BLOCK / actuator.step_time)
    count = max(FORGOTTEN + 1, -(-steps // each))
    rows = np.array([seen.row.copy() for seen in frames(
        actuator, sine(FREQUENCY), count * BLOCK, each)])
    return Blocks(each * np.arange(1, count + 1), rows[:, Channels.POSITION],
                  rows[:, actuator.channels.pressure])


def boundary_times(steps: int = MANY) -> Statement:
    """Judge how many steps the scheme carries."""
    found = run_blocks(steps)
    position, pressure = found.drift()
    p = paper_parameters()
    steady = (position < ROUNDING * p['cylinder.stroke']
              and pressure < ROUNDING * p['supply.pressure'])
    return Statement(
        'boundary_times',
        'With the midpoint of the times at two boundaries the method holds for 4e3 steps, with '
        'their maximum for 1e5.',
        'section 6', None if steady else False,
        'That limit belongs to nets that run freely, whose ends arrive at different times. Here '
        'all ends share one time step, so there is nothing to choose, and no limit was met: '
        f'{found.steps[-1]:.3g} steps end in the state they had after '
        f'{found.steps[FORGOTTEN - 1]:.3g}.',
        (Finding('steps', '-', '4e3 (midpoint), 1e5 (maximum)', f'{found.steps[-1]:.4g}'),
         Finding('change of the position, every 65 periods', 'm', '-', f'{position:.1e}'),
         Finding('change of the pressures at all stations', 'Pa', '-', f'{pressure:.1e}')),
        lambda figure: draw_blocks(figure, steps))


def draw_blocks(figure, steps: int) -> None:
    """Draw what each block's end differs from the second one's."""
    found = run_blocks(steps)
    (axes,) = panels(figure, ('steps [1e6]', 'change since the end of the second block'))
    for values, colour, label in (
            (found.position, BLUE, 'position [m]'), (found.pressure, VERMILION, 'pressure [Pa]')):
        change = np.abs(values - values[FORGOTTEN - 1]).reshape(len(values), -1).max(axis=1)
        axes.semilogy(found.steps / 1e6, np.maximum(change, 1e-18), 'o-', color=colour,
                      label=label)
    axes.legend(frameon=False)


def node_count() -> Statement:
    """Judge the paper's count of steps and nodes."""
    p = paper_parameters()
    actuator = Actuator(p)
    steps = 1.0 / actuator.step_time
    updates = steps * p['solver.cells']
    return Statement(
        'node_count',
        '200 points along the streamline need about 130 000 steps for one second, 26 million '
        'nodes in all.', 'sections 5 and 6',
        abs(steps / 1.3e5 - 1.0) < 0.05 and abs(updates / 26e6 - 1.0) < 0.05,
        'c/dx, and a few per cent more for u beside c.',
        (Finding('steps in one second', '-', '1.3e5', f'{steps:.5g}'),
         Finding('node updates in one second', '-', '26e6', f'{updates:.4g}'),
         Finding('units of L/c in one second', '-', '650', f'{1.0 / unit_time(p):.4g}')))


def pass_differences() -> Statement:
    """Judge the difference between one and two passes, in the paper's measures."""
    found = {run: pass_difference(*run) for run in DRIVES}
    good = all(velocity < LIMIT and present < OF_PRESENT and pressure < LIMIT
               for velocity, present, pressure in found.values())
    findings = []
    for (frequency, amplitude, _), (velocity, present, pressure) in found.items():
        name = f'{frequency:g} Hz, {amplitude:g} of the stroke'
        findings += [
            Finding(f'velocity over V_max, {name}', '-', '< 1e-4', f'{velocity:.1e}'),
            Finding(f'velocity over the largest present, {name}', '-', '3e-3', f'{present:.1e}'),
            Finding(f'pressure over p_max, {name}', '-', '< 1e-4', f'{pressure:.1e}')]
    return Statement(
        'pass_differences',
        'One and two passes differ by less than 1e-4 of unit velocity and pressure, about 3e-3 '
        'of the velocities present.',
        'sections 5 and 7, figures 2e, 2f, 3a, 3b', good,
        'A pass changes slopes by u/c and friction by its change within a step: both are small, '
        'and larger the faster the drive.', tuple(findings))


@cache
def bent_field(passes: int) -> tuple[np.ndarray, float]:
    """Return all stations over half a period with slopes bent by 2.5 %, and the largest u/c."""
    lines = ('supply_line', 'line_1', 'line_2', 'return_line')
    p = paper_parameters().replace({
        'solver.iterations': passes, 'solver.max_mach': BENT_MACH,
        **{f'{line}.diameter': BENT_DIAMETER for line in lines}})
    trace = drive(p, sine(FREQUENCY), 0.5 * PERIOD * unit_time(p), 10)
    velocity = trace.rows[:, trace.channels.flow_velocity]
    return velocity, float(trace.mach.max())


def five_passes() -> Statement:
    """Judge whether five passes suffice where slopes change by 2.5 %."""
    fields = {passes: bent_field(passes)[0] for passes in (1, 2, MOST_PASSES)}
    mach = bent_field(2)[1]
    largest = float(np.abs(fields[MOST_PASSES]).max())
    change = {passes: float(np.abs(fields[passes] - fields[MOST_PASSES]).max()) / largest
              for passes in (1, 2)}
    return Statement(
        'five_passes',
        'Where slopes of characteristics change by less than 2.5 %, at most five passes are '
        'needed.', 'section 5', change[2] < LIMIT,
        'Five suffice: three of them change nothing that counts. Each pass contracts what is '
        f'missing, the second to {change[2] / change[1]:.1g} of it.',
        (Finding('largest change of a slope, u/c', '-', '0.025', f'{mach:.4f}'),
         *(Finding(f'velocity with {passes} passes less that with {MOST_PASSES}, of the largest',
                   '-', '-', f'{value:.1e}') for passes, value in change.items())))


STATEMENTS = {
    'boundary_times': boundary_times, 'node_count': node_count,
    'pass_differences': pass_differences, 'five_passes': five_passes}
