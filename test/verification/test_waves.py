# SPDX-License-Identifier: Apache-2.0
"""Waves in lone lines against their exact solutions."""

from hydra_actuator.core.records import CLOSED
from hydra_actuator.verification import waves
from hydra_actuator.verification.case import failures
import pytest


def test_sudden_stop_gives_the_joukowsky_rise_at_the_right_time():
    assert not failures(waves.joukowsky())


def test_pipes_ring_at_their_organ_pipe_periods():
    assert not failures(waves.organ_pipe())


def test_pulse_keeps_its_height_to_the_order_of_the_interpolation():
    assert not failures(waves.gaussian())


def test_a_pipe_of_another_length_misses_the_period():
    period = waves.ringing_period((CLOSED, CLOSED), 0.5 / waves.LENGTH)
    assert period != pytest.approx(2.0 * 1.01 * waves.LENGTH / waves.WAVE_SPEED, rel=2e-3)
