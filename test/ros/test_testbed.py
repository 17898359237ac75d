# SPDX-License-Identifier: Apache-2.0
"""The fixtures that start real nodes: what a test gets, and that nothing of it is left."""

import os
from pathlib import Path

from hydra_actuator.errors import Failure, InputError
from hydra_actuator.parameters import ParameterError
from hydra_actuator.ros.testbed import Testbed
import pytest
import rclpy
from sensor_msgs.msg import JointState

COARSE = {'solver.cells': 60}


def seconds(state):
    return state.header.stamp.sec + 1e-9 * state.header.stamp.nanosec


def test_a_node_of_default_parameters_steps_as_the_actuator_does(actuator_node, actuator):
    assert seconds(actuator_node.state) == 1.0
    for k in range(20):
        state = actuator_node.step(0.02 * k)
        expected = actuator.advance(1e-3, spool=0.02 * k)
        assert state.position[0] == expected.position
        assert state.velocity[0] == expected.velocity
    assert actuator_node.state is state


def test_two_nodes_in_namespaces_of_their_own_do_not_hear_each_other(
        make_actuator_node, tmp_path):
    left = make_actuator_node({**COARSE, 'recording.enabled': True}, namespace='/left')
    right = make_actuator_node({**COARSE, 'cylinder.mass': 20.0}, namespace='/right')
    for _ in range(5):
        left.step(0.5)
    assert seconds(right.state) == 1.0
    assert 0.0 < right.step(0.5).position[0] < left.state.position[0]
    assert len(list((tmp_path / 'recordings').iterdir())) == 1


def test_a_process_ends_with_the_testbed_and_the_environment_is_as_before(tmp_path):
    before = dict(os.environ)
    with Testbed(tmp_path) as testbed:
        assert os.environ['ROS_DOMAIN_ID'] == str(testbed.domain) != '0'
        assert os.environ['ROS_AUTOMATIC_DISCOVERY_RANGE'] == 'LOCALHOST'
        process = testbed.start({**COARSE, 'timing.mode': 'free_run'})
        assert 'active: ' in process.text
        # A context of the test's own finds the node.
        context = rclpy.Context()
        rclpy.init(context=context, args=[])
        try:
            node = rclpy.create_node('listener', context=context)
            heard = []
            node.create_subscription(JointState, 'joint_states', heard.append, 10)
            executor = rclpy.executors.SingleThreadedExecutor(context=context)
            executor.add_node(node)
            while not heard:
                executor.spin_once(timeout_sec=1.0)
                process.check()
        finally:
            rclpy.try_shutdown(context=context)
    assert not Path(f'/proc/{process.pid}').exists()
    assert dict(os.environ) == before


def test_a_node_that_ends_by_itself_fails_the_test(tmp_path):
    testbed = Testbed(tmp_path)
    with pytest.raises(Failure, match='a node ended during the test; it said: '), testbed:
        process = testbed.start({**COARSE, 'timing.mode': 'lockstep'})
        os.kill(process.pid, 9)
        while not process.died:
            pass


def test_a_node_that_cannot_start_says_why(
        start_actuator, make_actuator_node, tmp_path):
    with pytest.raises(ParameterError, match=r'solver\.cels'):
        start_actuator({'solver.cels': 60})
    with pytest.raises(InputError, match='autostart is false'):
        start_actuator({'autostart': False})
    with pytest.raises(InputError, match=r'timing\.mode is free_run'):
        make_actuator_node({'timing.mode': 'free_run'})
    (tmp_path / 'file').touch()
    with pytest.raises(Failure, match=r'the node does not start; it said: .*file'):
        start_actuator({**COARSE, 'recording.enabled': True,
                        'recording.directory': str(tmp_path / 'file' / 'inside')})
