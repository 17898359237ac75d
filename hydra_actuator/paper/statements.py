# SPDX-License-Identifier: Apache-2.0
"""
All statements of the paper, by name, in the order in which they are told.

Each is a function that runs the solver and judges by what it computed; runs are shared.
"""

from collections.abc import Callable

from hydra_actuator.paper import (
    statements_edges,
    statements_motion,
    statements_numerics,
    statements_throttle,
    statements_vacuum,
)
from hydra_actuator.paper.statement import Statement

STATEMENTS: dict[str, Callable[[], Statement]] = {
    **statements_edges.STATEMENTS,
    **statements_motion.STATEMENTS,
    **statements_throttle.STATEMENTS,
    **statements_vacuum.STATEMENTS,
    **statements_numerics.STATEMENTS,
}
