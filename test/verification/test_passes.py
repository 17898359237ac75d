# SPDX-License-Identifier: Apache-2.0
"""A second pass changes little where the paper says so, and more the faster the drive."""

from hydra_actuator.verification import passes
from hydra_actuator.verification.case import failures


def test_one_and_two_passes_differ_by_less_than_a_ten_thousandth():
    assert not failures(passes.passes())


def test_the_difference_grows_with_the_frequency():
    slow, fast = (passes.pass_difference(frequency, 0.3, 2) for frequency in (50.0, 200.0))
    assert 0.0 < slow[0] < fast[0]
    assert 0.0 < slow[2] < fast[2]
