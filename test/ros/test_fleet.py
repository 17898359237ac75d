# SPDX-License-Identifier: Apache-2.0
"""Several nodes side by side, with nothing of theirs in common, and how many a machine holds."""

import re

from hydra_actuator import load_recording
from hydra_actuator.cli.main import main
from hydra_actuator.ros.fleet import counts_up_to, MOST_MISSED, NodeFigures
import pytest
from rclpy.node import NodeNameNonExistentError
from rclpy.serialization import deserialize_message
from rosbags.highlevel import AnyReader
from sensor_msgs.msg import JointState

# What all nodes of a ROS domain have in common.
COMMON = {'/diagnostics', '/parameter_events', '/rosout'}


def names_of(peer, namespace):
    """Return all topics and services of the node in a namespace; none before it is found."""
    try:
        return {name for of in (
            peer.node.get_publisher_names_and_types_by_node,
            peer.node.get_subscriber_names_and_types_by_node,
            peer.node.get_service_names_and_types_by_node,
        ) for name, _ in of('actuator', namespace)}
    except NodeNameNonExistentError:
        return set()


@pytest.mark.parametrize('most, counts', [
    (1, [1]), (2, [1, 2]), (3, [1, 2, 3]), (4, [1, 2, 4]), (6, [1, 2, 4, 6])])
def test_counts_double_up_to_the_most(most, counts):
    assert counts_up_to(most) == counts


def test_a_node_holds_below_the_stated_share_of_missed_ticks():
    assert NodeFigures(0.9 * MOST_MISSED, 1.0, 1e-3, 0.1, 1.0).holds
    assert not NodeFigures(MOST_MISSED, 1.0, 1e-3, 0.1, 1.0).holds


def test_nodes_in_namespaces_have_no_name_in_common(node_process, peer):
    nodes = [node_process('-r', f'__ns:=/{name}', active=False) for name in ('left', 'right')]
    for node in nodes:
        node.wait_for_line('active: ')
    # Discovery finds them one by one.
    peer.until(lambda: len(names_of(peer, '/left')) > 30 and {
        name.replace('/left/', '/right/', 1) for name in names_of(peer, '/left')
    } == names_of(peer, '/right'))
    left, right = names_of(peer, '/left'), names_of(peer, '/right')
    assert left & right == COMMON
    assert all(name.startswith('/left/') for name in left - COMMON)


def test_nodes_of_one_name_record_into_folders_of_their_own(node_process, peer):
    nodes = [node_process(active=False) for _ in range(2)]
    for node in nodes:
        node.wait_for_line('active: ')
    first, second = (node.recording for node in nodes)
    assert first != second
    assert [node.end()[0] for node in nodes] == [0, 0]
    for path in (first, second):
        assert load_recording(path).finished
        with AnyReader([path]) as reader:
            own = [one for one in reader.connections if one.topic == '/joint_states']
            stamps = [deserialize_message(bytes(data), JointState).header.stamp.nanosec
                      for _, _, data in reader.messages(own)]
        assert len(stamps) == len(load_recording(path).row_stamps)


def test_bench_tells_for_each_count_of_nodes_what_they_reached(demo_process, tmp_path):
    small = tmp_path / 'small.yaml'
    small.write_text('/**:\n  ros__parameters:\n    solver: {cells: 100}\n')
    bench = demo_process(
        'bench', '--nodes', '2', '--duration', '1', '--config', small,
        environment={'TMPDIR': str(tmp_path)})
    assert bench.popen.wait(240.0) == 0, bench.text
    title, _, *rows = bench.text.splitlines()
    assert 'load average' in title and 'fewer than 0.5 %' in title
    assert [int(row.split()[0]) for row in rows] == [1, 2]
    for row in rows:
        missed, factor, late, share, heard = re.match(
            r' +\d+ +([\d.]+)% +([\d.]+) +(\d+) us +([\d.]+)% +([\d.]+)%', row).groups()
        assert 0.0 <= float(missed) and 0.0 < float(factor) < 1.05
        assert int(late) > 0 and 0.0 < float(share) < 200.0
        # Over DDS, from a second process, all but what a busy machine drops.
        assert 50.0 < float(heard) <= 101.0
        assert row.endswith('does not hold') == (float(missed) >= 100.0 * MOST_MISSED)
    # The recordings were in a folder that is gone.
    assert not [path for path in tmp_path.iterdir() if path.is_dir()]


def test_bench_refuses_a_bad_configuration_before_it_starts_a_node(tmp_path, capsys):
    wrong = tmp_path / 'wrong.yaml'
    wrong.write_text('/**:\n  ros__parameters:\n    solver: {cells: 1}\n')
    assert main(['bench', '--nodes', '1', '--config', str(wrong)]) == 2
    assert 'solver.cells = 1' in capsys.readouterr().err


@pytest.mark.parametrize('count', ['0', '-1', '65'])
def test_a_count_of_nodes_that_makes_no_sense_is_refused(count, capsys):
    assert main(['bench', '--nodes', count]) == 2
    assert f'--nodes {count}: 1 to 64' in capsys.readouterr().err
