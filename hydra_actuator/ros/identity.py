# SPDX-License-Identifier: Apache-2.0
"""What a node is made of, for whoever compares two of them: versions and a parameter hash."""

from functools import lru_cache
import hashlib

from hydra_actuator.parameters import Parameters
from hydra_actuator.recording.run_data import versions
import rclpy


@lru_cache(maxsize=1)
def software() -> dict[str, str]:
    """Return the versions of what makes the numbers, and the middleware."""
    return {
        **{f'version: {name}': version for name, version in versions().items()},
        'rmw': rclpy.get_rmw_implementation_identifier()}


def parameter_hash(parameters: Parameters) -> str:
    """Return 16 hexadecimal digits, alike for alike values of all parameters."""
    return hashlib.sha256(parameters.as_yaml().encode()).hexdigest()[:16]
