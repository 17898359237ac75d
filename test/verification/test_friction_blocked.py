# SPDX-License-Identifier: Apache-2.0
"""Resonances of a blocked line with unsteady friction against the exact ones."""

from hydra_actuator.verification import friction_blocked
from hydra_actuator.verification.case import failures
import pytest


def test_blocked_line_resonates_at_the_exact_frequencies_and_heights():
    assert not failures(friction_blocked.blocked_line())


def test_steady_friction_alone_leaves_the_lossless_frequency_and_four_times_the_height():
    response = friction_blocked.pulse_response('steady', cells=50)
    frequency, height = friction_blocked.peak_near(164.133, *response)
    assert frequency == pytest.approx(164.133, rel=1e-4)
    assert height > 4.0 * friction_blocked.PEAKS[0][1]
