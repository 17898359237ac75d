# SPDX-License-Identifier: Apache-2.0
"""All cases, by name, in the order in which they are told."""

from hydra_actuator.verification import (
    adelaide,
    budget,
    cavitation,
    cell_crossing,
    conservation,
    free_stream,
    friction_blocked,
    friction_transient,
    grid,
    mirror,
    moving_wall,
    oil_column,
    passes,
    spool_response,
    waves,
)
from hydra_actuator.verification.case import Case

CASES: dict[str, Case] = {
    **waves.CASES,
    **conservation.CASES,
    **budget.CASES,
    **moving_wall.CASES,
    **free_stream.CASES,
    **cell_crossing.CASES,
    **mirror.CASES,
    **oil_column.CASES,
    **spool_response.CASES,
    **friction_transient.CASES,
    **friction_blocked.CASES,
    **cavitation.CASES,
    **adelaide.CASES,
    **passes.CASES,
    **grid.CASES,
}
