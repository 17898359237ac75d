# SPDX-License-Identifier: Apache-2.0
"""
The oil of a chain and what its friction and its gas need at every node.

A chain whose lines have constant friction or none, and no gas, is plain: its step skips all this.
"""

from dataclasses import dataclass
import math

from hydra_actuator.core.friction import (
    damping_table,
    memory_constants,
    TABLE_SIZE,
    TERMS,
)
import numpy as np


@dataclass(frozen=True)
class Oil:
    """
    Density [kg/m^3] at gauge zero, kinematic viscosity [m^2/s], free gas.

    air_fraction: by volume at ambient pressure, 0 for no gas; floor: ambient less vapour
    pressure [Pa], how far below gauge zero the oil can go.
    """

    density: float
    kinematic_viscosity: float = 0.0
    air_fraction: float = 0.0
    floor: float = 0.0


def friction_constants(oil: Oil, domains: list, step_time: float, fastest: float,
                       of_node: np.ndarray) -> dict:
    """
    Return the Model's fields of friction by node, for lines with a law beyond the constant one.

    domains: hydra_actuator.core.model.Domain's; of_node: the domain of each node; fastest: the
    largest |u| [m/s] of the method.
    """
    tables = [np.zeros(TABLE_SIZE)]
    start = np.zeros(len(domains), np.int64)
    decay, gain = np.zeros((TERMS, len(domains))), np.zeros((TERMS, len(domains)))
    inertia, loss = np.zeros(len(domains)), np.zeros(len(domains))
    for d, domain in enumerate(domains):
        radius = math.sqrt(domain.area / math.pi)
        if domain.friction == 'constant':
            loss[d] = domain.loss_coefficient
        if domain.friction in ('steady', 'unsteady'):
            start[d] = TABLE_SIZE * len(tables)
            tables.append(damping_table(
                2.0 * radius, oil.kinematic_viscosity, domain.roughness, fastest))
        if domain.friction == 'unsteady':
            decay[:, d], gain[:, d], inertia[d] = memory_constants(
                radius, oil.kinematic_viscosity, step_time)
    return {
        'loss': loss[of_node], 'damping': np.concatenate(tables),
        'table_start': start[of_node], 'table_scale': (TABLE_SIZE - 1) / math.sqrt(fastest),
        'decay': np.ascontiguousarray(decay[:, of_node]),
        'gain': np.ascontiguousarray(gain[:, of_node]), 'inertia': inertia[of_node],
        'liveliness': (inertia + gain.sum(axis=0))[of_node],
        'unsteady': int(bool(inertia.any()))}


def gas_constants(oil: Oil, wave_speed: np.ndarray, spacing: np.ndarray,
                  step_time: float) -> tuple[np.ndarray, np.ndarray]:
    """
    Return the gas's strength [Pa m/s] at inner nodes and at ends, by domain (D,).

    A whole cell's gas on the way c, half a cell's in the time dt; see
    hydra_actuator.core.cavity.
    """
    held = oil.air_fraction * oil.floor
    return 0.5 * held * wave_speed, 0.5 * held * spacing / step_time


def has_table(domains: list) -> bool:
    """Return whether a domain needs more than a constant loss coefficient."""
    return any(domain.friction in ('steady', 'unsteady') for domain in domains)
