# SPDX-License-Identifier: Apache-2.0
"""Faults: which are at work, by whom they are set, and the script that sets them in time."""

from hydra_actuator.faults.faults import Faults
from hydra_actuator.faults.script import read_script

__all__ = ['Faults', 'read_script']
