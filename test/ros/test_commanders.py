# SPDX-License-Identifier: Apache-2.0
"""Rivals are the nodes that publish on those of the valve's topics on which something came."""

from collections import Counter

from hydra_actuator.ros.commanders import Commanders, INTERVAL
import pytest

TOPICS = {'~/spool_command': '/a/spool_command', 'joint_commands': '/joint_commands',
          '~/load_force': '/a/load_force'}


class Graph:
    """Publishers by topic, messages by label, and the time."""

    def __init__(self):
        self.publishers = {topic: [] for topic in TOPICS.values()}
        self.taken = Counter()
        self.now = 0.0
        self.asked = 0
        self.commanders = Commanders(
            TOPICS, self.taken, '~/load_force', self._names, lambda: self.now)

    def _names(self, topic):
        self.asked += 1
        return self.publishers[topic]

    def rivals(self):
        """Return the rivals after another look."""
        self.now += INTERVAL
        self.commanders.look()
        return self.commanders.rivals


@pytest.fixture
def graph():
    return Graph()


def test_all_publishers_are_named_by_topic(graph):
    graph.publishers['/joint_commands'] = ['/b', '/a']
    assert graph.rivals() == ()
    assert graph.commanders.names == {
        '~/spool_command': (), 'joint_commands': ('/a', '/b'), '~/load_force': ()}


def test_two_nodes_on_one_topic_are_rivals_while_something_comes(graph):
    graph.publishers['/joint_commands'] = ['/b', '/a']
    graph.taken['joint_commands'] += 1
    assert graph.rivals() == ('/a', '/b')
    assert graph.rivals() == ()


def test_two_topics_of_different_nodes_are_rivals_of_one_node_they_are_not(graph):
    graph.publishers.update({'/joint_commands': ['/a'], '/a/spool_command': ['/b']})
    graph.taken.update(['joint_commands', '~/spool_command'])
    assert graph.rivals() == ('/a', '/b')
    graph.publishers['/a/spool_command'] = ['/a']
    graph.taken.update(['joint_commands', '~/spool_command'])
    assert graph.rivals() == ()


def test_a_silent_publisher_and_one_of_the_load_are_no_rivals(graph):
    graph.publishers.update({
        '/joint_commands': ['/a'], '/a/spool_command': ['/silent'], '/a/load_force': ['/load']})
    graph.taken.update(['joint_commands', '~/load_force'])
    assert graph.rivals() == ()


def test_the_graph_is_asked_once_an_interval(graph):
    graph.rivals()
    for _ in range(10):
        graph.commanders.look()
    assert graph.asked == len(TOPICS)
