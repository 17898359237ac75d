# SPDX-License-Identifier: Apache-2.0
"""What to say when a condition breaks the method."""

from hydra_actuator.channels import DOMAINS
from hydra_actuator.core.observe import NOT_A_NUMBER, TOO_FAST
from hydra_actuator.core.records import Model, State
from hydra_actuator.errors import Failure


class SolverError(Failure):
    """A condition broke the method; the message names it and its place."""


def broken_limit(model: Model, state: State, code: int, time: float) -> str:
    """Return what a status code at a time [s] means, with place and limit."""
    _, domain, value = state.fault
    place = DOMAINS[int(domain)]
    if code == NOT_A_NUMBER:
        return f'NaN in {place} at {time:.6f} s'
    if code == TOO_FAST:
        return (f'|u|/c = {value:.4g} in {place} at {time:.6f} s exceeds '
                f'solver.max_mach {model.max_mach:g}')
    return (f'{place} is {value:.4g} m long at {time:.6f} s, shorter than one cell of '
            f'{model.spacing[int(domain)]:.4g} m; raise solver.cells')
