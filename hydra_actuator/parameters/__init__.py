# SPDX-License-Identifier: Apache-2.0
"""What a person can set: one definition per number, and the check of all of them at the door."""

from hydra_actuator.parameters.definition import Parameter, ParameterError
from hydra_actuator.parameters.load import load_parameters, Parameters
from hydra_actuator.parameters.table import belongs_to_ros, definitions, PARAMETERS
from hydra_actuator.parameters.yaml_files import read_parameter_file

__all__ = [
    'PARAMETERS', 'Parameter', 'ParameterError', 'Parameters',
    'belongs_to_ros', 'definitions', 'load_parameters', 'read_parameter_file',
]
