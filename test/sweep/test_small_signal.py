# SPDX-License-Identifier: Apache-2.0
"""Bandwidth: of known filters, and of the actuator against its own response."""

import math

from hydra_actuator.parameters import load_parameters, Parameters
from hydra_actuator.sweep.small_signal import bandwidth, small_signal
import numpy as np
import pytest

FREQUENCY = np.geomspace(1.0, 3000.0, 300)
# Of interpolation between 300 frequencies.
READ_OFF = 2e-3


def second_order(natural, damping):
    ratio = 1j * FREQUENCY / natural
    return 1.0 / (1.0 + 2.0 * damping * ratio + ratio**2)


def test_a_first_order_lag_ends_at_its_corner():
    assert bandwidth(FREQUENCY, 1.0 / (1.0 + 1j * FREQUENCY / 80.0)) == \
        pytest.approx(80.0, rel=READ_OFF)


def test_a_light_resonance_ends_where_it_lags_a_right_angle():
    assert bandwidth(FREQUENCY, second_order(120.0, 0.1)) == pytest.approx(120.0, rel=READ_OFF)


def test_heavy_damping_ends_three_decibels_down():
    z = 2.0
    down = 120.0 * math.sqrt(1 - 2 * z**2 + math.sqrt(1 + (1 - 2 * z**2)**2))
    assert bandwidth(FREQUENCY, second_order(120.0, z)) == pytest.approx(down, rel=READ_OFF)


def test_a_gain_that_first_rises_to_the_plateau_counts_from_there():
    highpass = 1j * FREQUENCY / (1j * FREQUENCY + 10.0)
    assert bandwidth(FREQUENCY, highpass * second_order(120.0, 0.1)) > 100.0


def test_what_never_falls_has_no_bandwidth():
    assert math.isnan(bandwidth(FREQUENCY, np.ones(300, complex)))


def test_the_papers_actuator_resonates_where_its_exact_response_does():
    found = small_signal(load_parameters('config/paper.yaml'))
    assert found['resonance'] == pytest.approx(175.7, rel=0.015)
    assert found['bandwidth'] == pytest.approx(175.7, rel=0.03)
    # 2848.5 1/s at 10 Hz by 0.5 mm, less what the spring takes there.
    assert found['velocity_gain'] == pytest.approx(1.42, rel=0.03)


def test_overlap_leaves_no_answer_at_null():
    lapped = {f'valve.overlap_{edge}': 1e-4 for edge in ('pa', 'pb', 'at', 'bt')}
    assert all(map(math.isnan, small_signal(Parameters(lapped)).values()))
