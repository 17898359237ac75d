# SPDX-License-Identifier: Apache-2.0
"""What a node says it is made of."""

from hydra_actuator import __version__
from hydra_actuator.parameters import Parameters
from hydra_actuator.ros.identity import parameter_hash, software
import numpy as np


def test_software_names_what_makes_the_numbers_and_the_middleware():
    found = software()
    assert found['version: hydra_actuator'] == __version__
    assert found['version: numpy'] == np.__version__
    assert {'version: numba', 'version: rclpy', 'version: python'} <= found.keys()
    assert found['rmw'].startswith('rmw_')


def test_alike_parameters_have_one_hash_and_others_another():
    fast = Parameters().replace({'cylinder.mass': 12.0})
    assert parameter_hash(Parameters()) == parameter_hash(Parameters())
    assert parameter_hash(fast) != parameter_hash(Parameters())
    assert parameter_hash(fast.replace({'cylinder.mass': 10})) == parameter_hash(Parameters())
