# SPDX-License-Identifier: Apache-2.0
"""
The full actuator against its own solution on finer grids: errors and orders of convergence.

Position and the pressures of all twelve stations, each millisecond, on 100, 200, 400 and 800 cells
against 3200. Three commands: an offset sine, whose valve never crosses zero; a full-stroke sine,
whose valve reverses, with a kink in the flow through each edge at zero; a valve that closes
in 0.5 ms. Commands are functions of time, evaluated at every step.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache

from hydra_actuator.actuator import Actuator, SolverError
from hydra_actuator.parameters import Parameters
from hydra_actuator.verification.case import Case, Row
from hydra_actuator.verification.drawing import (
    cells_axis,
    MARKERS,
    MILLI,
    SERIES,
    slope,
    TOLERANCE,
)
from hydra_actuator.verification.spool_response import soft_step
import numpy as np

CELLS = (100, 200, 400, 800)
REFERENCE = 3200
FREQUENCY = 50.0
CLOSURE = 0.5e-3
POSITION_BAR = 5e-8     # [m], at 200 cells


def offset_sine(times: np.ndarray) -> np.ndarray:
    """Return the spool command (-1 to 1) of a valve that moves but does not reverse."""
    return soft_step(times / 0.01) * (0.5 + 0.4 * np.sin(2.0 * np.pi * FREQUENCY * times))


def full_sine(times: np.ndarray) -> np.ndarray:
    """Return the full-stroke sine, reversing the valve each 10 ms."""
    return np.sin(2.0 * np.pi * FREQUENCY * times)


def smooth_closure(times: np.ndarray) -> np.ndarray:
    """Return an opening that closes softly from 20 ms on, within 0.5 ms."""
    return 0.2 * soft_step(times / 0.01) * (1.0 - soft_step((times - 0.02) / CLOSURE))


def straight_closure(times: np.ndarray) -> np.ndarray:
    """Return the same with constant spool speed: kinks at both ends of the closure."""
    return 0.2 * soft_step(times / 0.01) * (1.0 - np.clip((times - 0.02) / CLOSURE, 0.0, 1.0))


@dataclass(frozen=True)
class Convergence:
    """Largest errors over a run on each of CELLS, and their observed orders between two."""

    position: np.ndarray
    pressure: np.ndarray

    @property
    def position_orders(self) -> np.ndarray:
        """Observed orders of the position."""
        return np.log2(self.position[:-1] / self.position[1:])

    @property
    def pressure_orders(self) -> np.ndarray:
        """Observed orders of the pressures."""
        return np.log2(self.pressure[:-1] / self.pressure[1:])


def rows_of(command: Callable, duration: float, cells: int) -> tuple[np.ndarray, Actuator]:
    """Return the observations each millisecond under a command, and their actuator."""
    actuator = Actuator(Parameters().replace({'solver.cells': cells}))
    steps, rows = actuator.steps_per_period, []
    for period in range(round(duration / actuator.period)):
        times = np.arange(period * steps + 1, (period + 1) * steps + 1) * actuator.step_time
        spool = command(times)
        code = actuator.follow((times, np.column_stack((spool, spool, 0.0 * spool)), True), steps)
        if code:
            raise SolverError(actuator.status_message(code))
        rows.append(actuator.row.copy())
    return np.array(rows), actuator


@cache
def converge(command: Callable, duration: float) -> Convergence:
    """Return the errors [m], [Pa] on CELLS against REFERENCE."""
    exact, actuator = rows_of(command, duration, REFERENCE)
    channels, errors = actuator.channels, []
    for cells in CELLS:
        error = np.abs(rows_of(command, duration, cells)[0] - exact)
        errors.append((error[:, channels.POSITION].max(), error[:, channels.pressure].max()))
    return Convergence(*np.array(errors).T)


def _bars(name: str, found: Convergence, pressure_bar: float, reason: str,
          which: str = '') -> list[Row]:
    """Return the errors at 200 cells against their bars, and the position's orders."""
    at = CELLS.index(200)
    rows = [
        Row(name, f'{which}position at 200 cells', 'm', 0.0, float(found.position[at]),
            POSITION_BAR, False, 'the bar of the converged solution'),
        Row(name, f'{which}pressures at 200 cells', 'Pa', 0.0, float(found.pressure[at]),
            pressure_bar, False, reason),
    ]
    for coarse, order in zip(CELLS, found.position_orders):
        rows.append(Row(name, f'{which}order of the position, {coarse} to {2 * coarse} cells', '-',
                        2.0, float(order), 0.2, False, 'second order; at least 1.8 is asked'))
    return rows


def grid_without_reversal() -> list[Row]:
    """Drive with the offset sine."""
    found = converge(offset_sine, 0.06)
    rows = _bars('grid_without_reversal', found, 200.0, 'the bar of the converged solution')
    for coarse, order in zip(CELLS, found.pressure_orders):
        rows.append(Row('grid_without_reversal', f'order of the pressures, {coarse} to '
                        f'{2 * coarse} cells', '-', 2.0, float(order), 0.2, False,
                        'second order'))
    return rows


def grid_with_reversal() -> list[Row]:
    """Drive with the full-stroke sine."""
    return _bars('grid_with_reversal', converge(full_sine, 0.06), 8e3,
                 'the kink at spool zero, in a field of 20 MPa')


def grid_closing_valve() -> list[Row]:
    """Close the valve in 0.5 ms, softly and at constant speed."""
    name = 'grid_closing_valve'
    soft, straight = converge(smooth_closure, 0.04), converge(straight_closure, 0.04)
    rows = _bars(name, soft, 1e3, 'a thousandth of the 1.1 MPa it raises', 'soft: ')
    rows += _bars(name, straight, 2e4, 'corners of the fronts are first order: 1.5 % of 1.1 MPa',
                  'straight: ')[:2]
    for coarse, order in zip(CELLS, straight.pressure_orders):
        rows.append(Row(name, f'straight: order of the pressures, {coarse} to {2 * coarse} cells',
                        '-', 1.0, float(order), 0.3, False, 'corners: first order'))
    return rows


def draw_errors(figure, shown: tuple[float, float],
                runs: dict[str, tuple[Callable, float, float, float]]) -> None:
    """
    Draw commands, as far as shown (from, to) [s], and errors over cells.

    runs: by name (command, duration [s], bar of the pressures [Pa], their order).
    """
    command_axes, left, right = figure.subplots(1, 3)
    for axes in (left, right):
        cells_axis(axes, CELLS)
    for k, (name, (command, duration, pressure_bar, order)) in enumerate(runs.items()):
        found, style = converge(command, duration), {
            'color': SERIES[k], 'marker': MARKERS[k], 'linewidth': 1.2, 'label': name}
        times = np.linspace(*shown, 1201)
        command_axes.plot(MILLI * times, command(times), color=SERIES[k], linewidth=1.2,
                          label=name)
        left.plot(CELLS, found.position, **style)
        right.plot(CELLS, found.pressure, **style)
        slope(right, CELLS, 1.6 * found.pressure[0], order, f'order {order:g}')
        right.plot(200, pressure_bar, color=SERIES[k], marker='_', markersize=16,
                   markeredgewidth=2.0, linestyle='none', label=f'tolerance, {name}')
    slope(left, CELLS, 1.6 * found.position[0], 2.0, 'order 2')
    left.plot(200, POSITION_BAR, color=TOLERANCE['color'], marker='_', markersize=16,
              markeredgewidth=2.0, linestyle='none', label='tolerance')
    command_axes.set_title('spool command, of full stroke', loc='left')
    command_axes.set_xlabel('time [ms]')
    command_axes.grid(True)
    left.set_title(f'position against {REFERENCE} cells', loc='left')
    left.set_ylabel('largest error [m]')
    right.set_title(f'pressures at O to K against {REFERENCE} cells', loc='left')
    right.set_ylabel('largest error [Pa]')
    left.legend(loc='lower left')
    right.legend(loc='lower left')
    if len(runs) > 1:
        command_axes.legend()


def draw_without_reversal(figure) -> None:
    """Draw the errors under the offset sine."""
    draw_errors(figure, (0.0, 0.06), {'offset sine': (offset_sine, 0.06, 200.0, 2.0)})


def draw_with_reversal(figure) -> None:
    """Draw the errors under the full-stroke sine."""
    draw_errors(figure, (0.0, 0.06), {'full-stroke sine': (full_sine, 0.06, 8e3, 1.0)})


def draw_closing_valve(figure) -> None:
    """Draw the errors under both closures."""
    draw_errors(figure, (0.0198, 0.0208), {
        'soft': (smooth_closure, 0.04, 1e3, 2.0), 'straight': (straight_closure, 0.04, 2e4, 1.0)})


CASES = {
    'grid_without_reversal': Case(grid_without_reversal, 'convergence, offset sine',
                                  figure=draw_without_reversal),
    'grid_with_reversal': Case(grid_with_reversal, 'convergence, sine that reverses the valve',
                               figure=draw_with_reversal),
    'grid_closing_valve': Case(grid_closing_valve, 'convergence, a valve closes in 0.5 ms',
                               figure=draw_closing_valve),
}
