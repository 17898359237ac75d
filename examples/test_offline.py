# SPDX-License-Identifier: Apache-2.0
"""A position controller tested without any middleware."""

from hydra_actuator.testing import run_loop, step_metrics
from position_controller import PositionController
import pytest

TARGET = 0.01
PERIOD = 1e-3
DURATION = 0.6


def step_response(actuator, **settings):
    """Return the figures of a step to the target."""
    controller = PositionController(TARGET, PERIOD, **settings)
    run = run_loop(actuator, lambda state: controller.command(state.position), DURATION, PERIOD)
    return step_metrics(run.time, run.position, TARGET)


def test_proportional_control_reaches_the_target_without_overshoot(actuator):
    metrics = step_response(actuator)
    assert metrics.rise_time < 0.07
    assert metrics.overshoot < 0.02
    assert metrics.settling_time < 0.15
    assert abs(metrics.steady_error) < 1e-3 * TARGET


def test_proportional_control_cannot_hold_a_shifted_valve(make_actuator):
    """A spool that is off its centre by a part of its stroke costs that part over the gain."""
    metrics = step_response(make_actuator({'fault.enabled': True, 'fault.null_shift': 0.06}))
    assert metrics.steady_error == pytest.approx(-0.06 / 30.0, rel=1e-3)


def test_an_integral_holds_it(make_actuator):
    metrics = step_response(
        make_actuator({'fault.enabled': True, 'fault.null_shift': 0.06}), integral_time=0.1)
    assert metrics.overshoot < 0.4
    assert abs(metrics.steady_error) < 0.01 * TARGET
