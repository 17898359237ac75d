# SPDX-License-Identifier: Apache-2.0
"""
The same controller against a real node over DDS, in lockstep.

Each command advances the plant by one period: the same figures at any speed of the machine.
"""

from hydra_actuator.testing import step_metrics
from position_controller import PositionController

TARGET = 0.01
PERIOD = 1e-3
STEPS = 600


def seconds(state):
    """Return the instant of a joint state [s]."""
    return state.header.stamp.sec + 1e-9 * state.header.stamp.nanosec


def step_response(client, **settings):
    """Return the figures of a step to the target."""
    controller = PositionController(TARGET, PERIOD, **settings)
    states = [client.state]
    for _ in range(STEPS):
        states.append(client.step(controller.command(states[-1].position[0])))
    return step_metrics(
        [seconds(state) for state in states], [state.position[0] for state in states], TARGET)


def test_proportional_control_reaches_the_target_without_overshoot(make_actuator_node):
    # A coarse mesh: quick, and still the position of the fine one to a few micrometres.
    metrics = step_response(make_actuator_node({'solver.cells': 100}))
    assert metrics.rise_time < 0.07
    assert metrics.overshoot < 0.02
    assert metrics.settling_time < 0.15
    assert abs(metrics.steady_error) < 1e-3 * TARGET


def test_a_shifted_valve_is_held_by_an_integral(make_actuator_node):
    client = make_actuator_node(
        {'solver.cells': 100, 'fault.enabled': True, 'fault.null_shift': 0.06})
    metrics = step_response(client, integral_time=0.1)
    assert metrics.overshoot < 0.4
    assert abs(metrics.steady_error) < 0.01 * TARGET
