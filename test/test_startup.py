# SPDX-License-Identifier: Apache-2.0
"""The measurement of a start: a second start compiles nothing."""

import os

from hydra_actuator.actuator import Actuator
from hydra_actuator.kernels import cache_root
from hydra_actuator.startup import measure_start
import pytest

pytestmark = pytest.mark.once


def test_a_warm_start_is_measured_by_its_parts():
    Actuator()
    warm = measure_start(os.fspath(cache_root()))
    assert warm.compiled == 0
    assert list(warm.times) == ['interpreter', 'import of numba', 'import of the actuator',
                                'kernels and state', 'first period']
    assert 0.0 < warm.total and warm.memory > 50.0
