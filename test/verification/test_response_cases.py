# SPDX-License-Identifier: Apache-2.0
"""The slow limits of the responses, the valve about null and the spool hold their formulas."""

from hydra_actuator.verification.case import failures
from hydra_actuator.verification.response_low_frequency import response_low_frequency
from hydra_actuator.verification.spool_dynamics import spool_dynamics
from hydra_actuator.verification.valve_null_curves import valve_null_curves


def test_slow_responses_are_stiffness_speed_and_droop():
    assert not failures(response_low_frequency())


def test_spool_moves_as_its_equation_and_within_its_limits():
    assert not failures(spool_dynamics())


def test_valve_about_null_follows_its_orifices():
    assert not failures(valve_null_curves())
