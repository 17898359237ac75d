# SPDX-License-Identifier: Apache-2.0
"""
The faults of the plant, put into the model between two steps.

    valve_stuck     the spools stay where they are, at speed 0
    null_shift      is added to the command of each spool, before dynamics and stroke
    command_lost    the command is 0: the valve centres, but for its null shift
    supply_loss     the supply falls towards the tank over the ramp of hydra_actuator.supply
    air_fraction    is added to the oil's free gas; without fluid.cavitation it is all there is
    leakage         is added to that past the piston

The faults of instruments act on what is published, see hydra_actuator.instruments.
"""

from collections.abc import Mapping

from hydra_actuator.assembly import oil
from hydra_actuator.core.gas import set_gas
from hydra_actuator.core.records import Model, State
from hydra_actuator.parameters import Parameters
import numpy as np

# Of absolute less vapour pressure [Pa]: without gas it can be below 0.
TINY = 1e-6


def apply_plant_faults(
    parameters: Parameters, faults: Mapping[str, object], model: Model, state: State
) -> Model:
    """
    Return the model with these faults, those at work by parameter, and no others.

    Model and state are changed in place; the supply is not theirs.
    """
    def fault(name: str) -> float:
        return float(faults.get(f'fault.{name}', 0.0))

    valve, piston = model.valve, model.piston
    valve['stuck'], valve['command_lost'] = fault('valve_stuck'), fault('command_lost')
    valve['null_shift'] = fault('null_shift') * parameters['valve.stroke']
    piston['leakage'] = parameters['cylinder.leakage'] + fault('leakage')
    return set_air(model, state, air_fraction(parameters, faults))


def air_fraction(parameters: Parameters, faults: Mapping[str, object]) -> float:
    """Return the free gas of the oil with these faults, by volume at ambient pressure."""
    return oil(parameters).air_fraction + faults.get('fault.air_fraction', 0.0)


def void_fractions(
    parameters: Parameters, faults: Mapping[str, object], model: Model, pressures: np.ndarray
) -> np.ndarray:
    """Return the gas by volume at gauge pressures [Pa], with these faults."""
    above_vapour = np.maximum(pressures + model.floor, TINY)
    return air_fraction(parameters, faults) * model.floor / above_vapour


def set_air(model: Model, state: State, fraction: float) -> Model:
    """Return the model with this much free gas, untouched where it has that already."""
    if fraction == 0.0 and model.gas == 0:
        return model
    return set_gas(model, state, fraction)
