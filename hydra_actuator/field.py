# SPDX-License-Identifier: Apache-2.0
"""The nodes of the field in the order of the streamline: which domain each is of, and where."""

from hydra_actuator.channels import DOMAINS
from hydra_actuator.core.records import Model
import numpy as np


def field_labels(model: Model) -> list[str]:
    """Return the domain of each node."""
    counts = model.capacity + 1 + model.moving
    return [name for name, count in zip(DOMAINS, counts) for _ in range(count)]


def field_positions(model: Model) -> np.ndarray:
    """Return the streamline coordinate [m] of each node; the piston's faces at mid-stroke."""
    parts = []
    for d in range(len(DOMAINS)):
        x = model.spacing[d] * np.arange(model.capacity[d] + 1)
        if model.moving[d]:
            x = np.append(x, model.piston[0][f'length_{d - 1}'])
        x = model.origin[d] + model.direction[d] * x
        parts.append(x if model.direction[d] > 0 else x[::-1])
    return np.concatenate(parts)
