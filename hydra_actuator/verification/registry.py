# SPDX-License-Identifier: Apache-2.0
"""All cases, by name, in the order in which they are told."""

from hydra_actuator.verification import budget, conservation, waves
from hydra_actuator.verification.case import Case

CASES: dict[str, Case] = {
    **waves.CASES,
    **conservation.CASES,
    **budget.CASES,
}
