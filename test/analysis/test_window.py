# SPDX-License-Identifier: Apache-2.0
"""What is shown first: the last periods, or the largest step; waves only where they are seen."""

from dataclasses import replace

from hydra_actuator.analysis import streamline
from hydra_actuator.analysis.window import (
    best_field,
    dominant_frequency,
    wave_window,
    window_of,
)
import numpy as np
import pytest

TIME = np.arange(5000) / 1000


@pytest.mark.parametrize('frequency', [3.0, 16.25, 50.0, 123.4])
def test_a_sine_has_its_frequency(frequency):
    # The window's ends are both zero, which misplaces a line by less than 1/40 bin of 0.2 Hz.
    found = dominant_frequency(TIME, 0.3 + np.sin(2 * np.pi * frequency * TIME))
    assert found == pytest.approx(frequency, abs=0.005)


def test_a_step_noise_or_rest_have_none():
    assert dominant_frequency(TIME, np.where(TIME > 2, 1.0, 0.0)) == 0
    assert dominant_frequency(TIME, np.random.default_rng(1).normal(size=5000)) == 0
    assert dominant_frequency(TIME, np.zeros(5000)) == 0


def test_a_slow_drift_does_not_hide_a_sine():
    assert dominant_frequency(TIME, 5 * TIME + np.sin(2 * np.pi * 50 * TIME)) == pytest.approx(
        50, abs=0.005)


def test_a_periodic_run_shows_its_last_three_periods(run):
    shown = window_of(run)
    assert shown.end == run.time[-1]
    assert shown.end - shown.start == pytest.approx(3 / 50, rel=1e-3)


def test_idle_before_and_after_a_motion_is_not_shown(run):
    moving = (run.time > 0.3) & (run.time < 0.7)
    still = replace(run, position=np.where(moving, run.position, 0.0),
                    velocity=np.where(moving, run.velocity, 0.0))
    shown = window_of(still)
    assert shown.frequency == pytest.approx(50, abs=0.1)
    assert shown.end == pytest.approx(0.7 - 0.02, abs=0.005)
    assert shown.end - shown.start == pytest.approx(3 / 50, rel=1e-2)


def test_another_run_shows_its_largest_pressure_step(run):
    pressure = np.full_like(run.pressure, 1e7)
    pressure[700:, 3] = 2e7
    still = replace(run, position=np.zeros_like(run.time), pressure=pressure)
    shown = window_of(still)
    assert shown.start < 0.7 < shown.end
    assert shown.end - shown.start == pytest.approx(0.1)


def test_waves_are_shown_only_where_frames_are_dense_enough(run, make_run):
    shown = window_of(run)
    assert wave_window(run, run.field, shown) is None
    dense = make_run(0.2, field_rate=20_000)
    waves = wave_window(dense, dense.field, window_of(dense))
    assert waves.end - waves.start == pytest.approx(8 * 2.0 / 1300, rel=1e-3)


@pytest.mark.parametrize('field_rate, from_field', [(200, False), (1000, True), (5000, True)])
def test_frames_too_far_apart_give_way_to_the_stations(make_run, field_rate, from_field):
    run = make_run(0.5, field_rate)
    stations = streamline.field_of_stations(run)
    assert (best_field(run.field, stations, window_of(run)) is run.field) == from_field


def test_a_ramp_has_no_frequency():
    time = np.arange(600) / 20_000
    assert dominant_frequency(time, 0.03 * (time / 0.03) ** 1.2) == 0.0
