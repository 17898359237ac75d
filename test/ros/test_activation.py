# SPDX-License-Identifier: Apache-2.0
"""The measurement of a node's start."""

import os

from hydra_actuator.actuator import Actuator
from hydra_actuator.kernels import cache_root
from hydra_actuator.ros.activation import measure_activation


def test_a_start_is_measured_up_to_the_line_that_says_active():
    Actuator()
    before = dict(os.environ)
    took = measure_activation(os.fspath(cache_root()))
    assert 0.0 < took.processor_time < 1.0 + os.cpu_count() * took.elapsed
    assert dict(os.environ) == before
