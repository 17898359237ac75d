# SPDX-License-Identifier: Apache-2.0
"""Figures of step responses against those that are known exactly."""

import math

from hydra_actuator.testing import step_metrics
import numpy as np
import pytest

# Linear interpolation between samples errs by at most y'' h^2 / 8: 1.3e-7 of the step here.
TIME = np.linspace(0.0, 20.0, 20_001)
CLOSE = 2e-6


def first_order(time, constant=1.0):
    return -np.expm1(-time / constant)


def second_order(time, zeta):
    """Return the step response at natural frequency 1 rad/s, underdamped."""
    damped = math.sqrt(1.0 - zeta**2)
    return 1.0 - np.exp(-zeta * time) * (
        np.cos(damped * time) + zeta / damped * np.sin(damped * time))


@pytest.mark.parametrize('constant', [0.3, 1.0])
def test_first_order_rises_in_ln_9_and_settles_in_ln_50_time_constants(constant):
    metrics = step_metrics(TIME, first_order(TIME, constant), 1.0)
    assert metrics.rise_time == pytest.approx(constant * math.log(9.0), abs=CLOSE)
    assert metrics.settling_time == pytest.approx(constant * math.log(50.0), abs=CLOSE)
    assert metrics.overshoot == 0.0
    assert metrics.peak == pytest.approx(1.0, abs=1e-8)
    wider = step_metrics(TIME, first_order(TIME, constant), 1.0, band=0.05)
    assert wider.settling_time == pytest.approx(constant * math.log(20.0), abs=CLOSE)


@pytest.mark.parametrize('zeta', [0.2, 0.5, 0.7])
def test_second_order_overshoots_by_the_book(zeta):
    metrics = step_metrics(TIME, second_order(TIME, zeta), 1.0)
    expected = math.exp(-math.pi * zeta / math.sqrt(1.0 - zeta**2))
    assert metrics.overshoot == pytest.approx(expected, abs=CLOSE)
    assert metrics.peak == pytest.approx(1.0 + expected, abs=CLOSE)


# omega t at 10 % and at 90 % of the step, from (1 + x) exp(-x) = 0.9 and = 0.1.
CRITICAL = 3.889720170 - 0.531811608


def test_a_critically_damped_system_rises_by_the_book():
    metrics = step_metrics(TIME, 1.0 - (1.0 + TIME) * np.exp(-TIME), 1.0)
    assert metrics.rise_time == pytest.approx(CRITICAL, abs=CLOSE)
    assert metrics.overshoot == 0.0


def test_an_oscillation_settles_when_it_leaves_the_band_for_the_last_time():
    # Without damping ratio in the way: a decaying cosine about the target.
    rate, band = 0.3, 0.02
    value = 1.0 - np.exp(-rate * TIME) * np.cos(2.0 * math.pi * TIME)
    metrics = step_metrics(TIME, value, 1.0, band)
    envelope = math.log(1.0 / band) / rate
    # It leaves the band once each half period, later than that never.
    assert envelope - 0.5 < metrics.settling_time <= envelope
    after = TIME > metrics.settling_time
    assert np.abs(value[after] - 1.0).max() <= band < np.abs(value[~after] - 1.0).max()


def test_steps_down_from_anywhere_are_as_those_up_from_zero():
    up = step_metrics(TIME, second_order(TIME, 0.3), 1.0)
    down = step_metrics(TIME + 7.0, 4.0 - 2.0 * second_order(TIME, 0.3), 2.0)
    assert down.rise_time == pytest.approx(up.rise_time, abs=1e-9)
    assert down.settling_time == pytest.approx(up.settling_time, abs=1e-9)
    assert down.overshoot == pytest.approx(up.overshoot, abs=1e-12)
    assert down.peak == pytest.approx(4.0 - 2.0 * up.peak, abs=1e-12)
    assert down.steady_error == pytest.approx(-2.0 * up.steady_error, abs=1e-12)


def test_the_steady_error_is_that_of_the_last_tenth():
    # A mean over [18, 20] of 0.9 + 0.01 t.
    metrics = step_metrics(TIME, 0.9 + 0.01 * TIME - 0.9 * (TIME < 1.0), 1.0)
    assert metrics.steady_error == pytest.approx(0.1 - 0.19, abs=1e-9)


def test_what_was_not_reached_has_no_time_and_passes_no_limit():
    metrics = step_metrics(TIME, 0.5 * first_order(TIME), 1.0)
    assert math.isnan(metrics.rise_time)
    assert math.isnan(metrics.settling_time)
    assert not metrics.rise_time < 1e9
    assert metrics.overshoot == 0.0
    assert metrics.steady_error == pytest.approx(0.5, abs=1e-6)
    wrong_way = step_metrics(TIME, -first_order(TIME), 1.0)
    assert wrong_way.overshoot == 0.0
    assert wrong_way.peak == 0.0


def test_uneven_samples_give_the_same_figures():
    rng = np.random.default_rng(1)
    time = np.sort(rng.choice(TIME, 8000, replace=False))
    time[0] = 0.0
    metrics = step_metrics(time, first_order(time), 1.0)
    assert metrics.rise_time == pytest.approx(math.log(9.0), abs=1e-4)
    assert metrics.settling_time == pytest.approx(math.log(50.0), abs=1e-4)


@pytest.mark.parametrize(('time', 'value', 'target', 'words'), [
    ([0.0, 1.0], [0.0], 1.0, r'\(2,\) and value \(1,\)'),
    ([0.0], [0.0], 1.0, 'at least 2'),
    ([0.0, 0.0], [0.0, 1.0], 1.0, 'increase'),
    ([0.0, 1.0], [0.0, math.nan], 1.0, 'finite'),
    ([0.0, 1.0], [0.0, 1.0], math.inf, 'finite'),
    ([0.0, 1.0], [1.0, 2.0], 1.0, 'no step'),
])
def test_what_is_no_step_response_is_refused(time, value, target, words):
    with pytest.raises(ValueError, match=words):
        step_metrics(time, value, target)


def test_a_band_that_is_no_part_of_the_step_is_refused():
    with pytest.raises(ValueError, match='band = 2'):
        step_metrics(TIME, first_order(TIME), 1.0, band=2.0)
