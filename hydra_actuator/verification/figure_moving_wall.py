# SPDX-License-Identifier: Apache-2.0
"""Figure of the wall that is driven into oil at rest."""

from hydra_actuator.verification import moving_wall
from hydra_actuator.verification.case import illustrated
from hydra_actuator.verification.chains import DENSITY, pressure_of, WAVE_SPEED
from hydra_actuator.verification.drawing import (
    band,
    bar,
    cells_axis,
    EXACT_LINE,
    MEGAPASCAL,
    MILLI,
    SERIES,
    SIMPLER,
    slope,
    SOLVER,
)
import numpy as np


def draw_driven_piston(figure) -> None:
    """Draw the sudden start, the smooth drive at the face and in the field, and its errors."""
    panels = figure.subplots(2, 3)
    _draw_start(panels[0, 0])
    _draw_face(panels[0, 1], panels[1, 1])
    _draw_field(panels[0, 2], panels[1, 2])
    _draw_order(panels[1, 0])
    for axes in panels.flat:
        axes.grid(True)


def _draw_start(axes) -> None:
    time, rise = moving_wall.started()
    exact = moving_wall.start_rise()
    axes.plot(MILLI * np.array((0.0, 0.0, time[-1])),
              MEGAPASCAL * exact * np.array((0.0, 1.0, 1.0)), **{
                  **EXACT_LINE, 'label': f'exact: {MEGAPASCAL * exact:.4f} MPa'})
    axes.plot(MILLI * time, MEGAPASCAL * rise, **{
        **SOLVER, 'label': f'solver: {MEGAPASCAL * rise[-1]:.4f} MPa'})
    linear = DENSITY * WAVE_SPEED * moving_wall.SPEED
    axes.axhline(MEGAPASCAL * linear, label=f'linear: {MEGAPASCAL * linear:.4f} MPa', **SIMPLER)
    axes.set_title(f'started at once, {moving_wall.SPEED:g} m/s', loc='left')
    axes.set_xlabel('time [ms]')
    axes.set_ylabel('rise at the face [MPa]')
    axes.legend(loc='lower right')


def _draw_face(axes, error_axes) -> None:
    run = moving_wall.smooth_drive(200)
    exact = pressure_of(moving_wall.MU_REST + moving_wall.wall_speed(run.time))
    axes.plot(MILLI * run.time, MEGAPASCAL * exact, **EXACT_LINE)
    axes.plot(MILLI * run.time, MEGAPASCAL * run.face, **SOLVER)
    axes.set_title('driven smoothly: at the face', loc='left')
    axes.set_xlabel('time [ms]')
    axes.set_ylabel('gauge pressure [MPa]')
    axes.legend()
    error_axes.plot(MILLI * run.time, run.face_error, **SOLVER)
    band(error_axes, moving_wall.BAR)
    error_axes.set_title('error at the face', loc='left')
    error_axes.set_xlabel('time [ms]')
    error_axes.set_ylabel('pressure error [Pa]')


def _draw_field(axes, error_axes) -> None:
    fields = moving_wall.smooth_drive(200).fields
    chosen = [fields[round(part * (len(fields) - 1))] for part in (0.2, 0.4, 0.7, 0.9)]
    for k, (time, place, pressure, error) in enumerate(chosen):
        style = {'color': SERIES[k], 'linewidth': 1.2, 'label': f'{MILLI * time:.1f} ms'}
        axes.plot(place, MEGAPASCAL * (pressure - error), **{**EXACT_LINE, 'label': '_'})
        axes.plot(place, MEGAPASCAL * pressure, **style)
        error_axes.plot(place, error, **style)
    axes.set_title('in the field, at four instants', loc='left')
    axes.set_xlabel('distance from the outlet [m]')
    axes.set_ylabel('gauge pressure [MPa]')
    axes.legend()
    band(error_axes, moving_wall.BAR)
    error_axes.set_title('error in the field', loc='left')
    error_axes.set_xlabel('distance from the outlet [m]')
    error_axes.set_ylabel('pressure error [Pa]')


def _draw_order(axes) -> None:
    errors = [moving_wall.smooth_drive(cells).field_error for cells in moving_wall.CELLS]
    cells_axis(axes, moving_wall.CELLS)
    axes.plot(moving_wall.CELLS, errors, marker='o', **SOLVER)
    slope(axes, moving_wall.CELLS, 1.5 * errors[0], 2.0, 'order 2')
    bar(axes, moving_wall.BAR, label='tolerance at 200 cells')
    axes.set_title('largest error in the field', loc='left')
    axes.set_ylabel('pressure error [Pa]')
    axes.legend()


CASES = illustrated(moving_wall.CASES, driven_piston=draw_driven_piston)
