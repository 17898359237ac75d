# SPDX-License-Identifier: Apache-2.0
"""All cases, by name, in the order in which they are told."""

from hydra_actuator.verification import (
    cell_crossing,
    conservation,
    figure_adelaide,
    figure_budget,
    figure_cavitation,
    figure_moving_wall,
    figure_waves,
    free_stream,
    friction_blocked,
    friction_transient,
    grid,
    mirror,
    oil_column,
    passes,
    servo_loop,
    spool_response,
)
from hydra_actuator.verification.case import Case

CASES: dict[str, Case] = {
    **figure_waves.CASES,
    **conservation.CASES,
    **figure_budget.CASES,
    **figure_moving_wall.CASES,
    **free_stream.CASES,
    **cell_crossing.CASES,
    **mirror.CASES,
    **oil_column.CASES,
    **spool_response.CASES,
    **servo_loop.CASES,
    **friction_transient.CASES,
    **friction_blocked.CASES,
    **figure_cavitation.CASES,
    **figure_adelaide.CASES,
    **passes.CASES,
    **grid.CASES,
}
