# SPDX-License-Identifier: Apache-2.0
"""What an actuator shows of itself at one instant."""

from dataclasses import dataclass

from hydra_actuator.channels import Channels
import numpy as np


@dataclass(frozen=True)
class ActuatorState:
    """
    What the actuator shows at one instant.

    time [s], position [m], velocity [m/s], effort [N] (hydraulic force), spool_position [m]
    (one per spool), pressure [Pa, absolute] and flow_velocity [m/s] by section. With cavitation
    cavity_volume [m^3] of the whole streamline and void_fraction by section, else 0; see
    hydra_actuator.core.boiling.
    """

    time: float
    position: float
    velocity: float
    effort: float
    spool_position: tuple[float, ...]
    pressure: dict[str, float]
    flow_velocity: dict[str, float]
    cavity_volume: float
    void_fraction: dict[str, float]


def state_of(row: np.ndarray, channels: Channels, void_fractions: np.ndarray) -> ActuatorState:
    """Return the state that an observation row tells; void_fractions: gas of each section."""
    names = channels.section_names
    return ActuatorState(
        *(float(x) for x in row[:channels.SPOOL_1]),
        tuple(float(x) for x in row[channels.SPOOL_1:channels.SPOOL_1 + channels.spools]),
        dict(zip(names, row[channels.pressure].tolist())),
        dict(zip(names, row[channels.flow_velocity].tolist())),
        float(row[channels.cavity_volume]),
        dict(zip(names, void_fractions.tolist())))
