# SPDX-License-Identifier: Apache-2.0
"""What measurements of nodes share."""

import os

from hydra_actuator.errors import Failure
from hydra_actuator.recording.messages import diagnostic_array
from hydra_actuator.recording.topics import Topic
from hydra_actuator.recording.writer import RecordingWriter
from hydra_actuator.ros import measured
from hydra_actuator.ros.domain import alone
import pytest
import rclpy


def test_a_domain_of_ones_own_is_left_with_the_environment_as_it_was(monkeypatch):
    monkeypatch.setenv('ROS_DOMAIN_ID', '0')
    monkeypatch.setenv('ROS_STATIC_PEERS', '10.0.0.1')
    before = dict(os.environ)
    with pytest.raises(KeyError), alone() as domain:
        assert os.environ['ROS_DOMAIN_ID'] == str(domain)
        assert 'ROS_STATIC_PEERS' not in os.environ
        raise KeyError
    assert dict(os.environ) == before


def test_the_last_figures_of_a_part_are_read(tmp_path):
    topic = Topic('/diagnostics', 'diagnostic_msgs/msg/DiagnosticArray')
    writer = RecordingWriter(tmp_path / 'run', [topic])
    for stamp, ticks in ((1, '5'), (2, '7')):
        for part in ('Real time', 'Command'):
            writer.write('/diagnostics', stamp, stamp, diagnostic_array(stamp, [
                (0, f'/actuator: {part}', '', '/actuator', {'ticks': f'{ticks} {part}'})]))
    writer.close()
    assert measured.last_values(tmp_path / 'run', 'Real time') == {'ticks': '7 Real time'}
    assert measured.last_values(tmp_path / 'run', 'Solver') == {}


class Dead:
    """A node that has ended."""

    last_line = 'it said: nothing more'

    def check(self):
        raise Failure(f'the node ended with code 3; {self.last_line}')


def test_a_node_that_has_ended_is_not_waited_for():
    with measured.ground():
        driver = rclpy.create_node('driver', start_parameter_services=False)
        with pytest.raises(Failure, match='ended with code 3'):
            measured.change_all(driver, {'/gone': Dead()}, 1)
