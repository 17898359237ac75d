# SPDX-License-Identifier: Apache-2.0
"""What a node takes from its start to being active, without and with kept kernels."""

import os
import tempfile
import time
from typing import NamedTuple

from hydra_actuator.ros.child import ChildNode
from hydra_actuator.ros.domain import alone

# The first of the two compiles.
PATIENCE = 900.0


class Activation(NamedTuple):
    """From a node's start to its line `active`: processor time [s] of all threads, elapsed [s]."""

    processor_time: float
    elapsed: float


def measure_activations() -> tuple[Activation, Activation]:
    """Start a node twice, with an empty cache and with the one that leaves: (cold, warm)."""
    with tempfile.TemporaryDirectory() as cache:
        return measure_activation(cache), measure_activation(cache)


def measure_activation(cache: str) -> Activation:
    """
    Start a node that keeps its kernels in a directory, and wait until it is active.

    It records nothing. Raises Failure, with its last words, if it does not come up.
    """
    with alone():
        os.environ['HYDRA_ACTUATOR_CACHE'] = cache
        began = time.perf_counter()
        with ChildNode(['-p', 'recording.enabled:=false']) as node:
            node.wait_until_active(PATIENCE)
            return Activation(node.processor_time, time.perf_counter() - began)
