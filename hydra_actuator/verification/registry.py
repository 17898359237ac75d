# SPDX-License-Identifier: Apache-2.0
"""All cases, by name, in the order in which they are told."""

from hydra_actuator.verification import waves
from hydra_actuator.verification.case import Case

CASES: dict[str, Case] = {**waves.CASES}
