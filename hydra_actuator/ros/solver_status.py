# SPDX-License-Identifier: Apache-2.0
"""
The status `Solver`: the node's state, how the method stands to its limits, and what runs here.

`courant` is the largest |u| + c over the speed of the mesh, dx/dt, that any node can have had at
a tick: up to 1 the method reads between neighbours. `largest_mach` is that of all ticks.
"""

from collections.abc import Mapping

from hydra_actuator.ros.identity import parameter_hash, software
from hydra_actuator.ros.rig import Rig
from hydra_actuator.ros.statuses import ERROR, OK, OnDemand, Status, WARN


def solver(state: str, problem: str, active: bool, rig: Rig | None) -> Status:
    """
    Return the status from the lifecycle state, and why it failed or ''.

    active: whether the rig ticks, or would but for a pause.
    """
    if rig is None:
        values: Mapping[str, str] = {'state': state, **software()}
        return Status('Solver', ERROR if problem else OK, problem or state, values)
    oil = rig.oil()
    values = OnDemand(lambda: {'state': state, **_figures(rig), **oil.values, **software()})
    if problem:
        return Status('Solver', ERROR, problem, values)
    if not rig.plant.enabled:
        return Status('Solver', WARN, 'emergency stop: valve centred, supply off', values)
    if active and not rig.paused and oil.level:
        return Status('Solver', oil.level, oil.message, values)
    return Status('Solver', OK, 'paused' if rig.paused else state, values)


def _figures(rig: Rig) -> dict[str, str]:
    """Return counts and figures; times in s, masses in kg."""
    actuator, parameters = rig.actuator, rig.parameters
    tally = actuator.tally
    return {
        'mode': parameters['timing.mode'],
        'paused': str(rig.paused).lower(),
        'simulated_time': f'{actuator.time:.9g}',
        'resets': str(rig.plant.resets),
        'step_time': f'{actuator.step_time:.9g}',
        'steps_per_tick': str(actuator.steps_per_period),
        'courant': f'{actuator.courant * (1.0 + tally.largest_mach):.6f}',
        'largest_mach': f'{tally.largest_mach:.6f}',
        'max_mach': f'{parameters["solver.max_mach"]:g}',
        'stop_hits': str(tally.stop_hits),
        'mass_residual': f'{tally.mass.residual:.3e}',
        'mass_passed': f'{tally.mass.passed:.6g}',
        'parameter_hash': parameter_hash(parameters),
    }
