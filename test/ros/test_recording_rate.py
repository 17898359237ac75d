# SPDX-License-Identifier: Apache-2.0
"""What the recorder of a node takes in and writes, as `bench --recorder` tells it."""

import re

from hydra_actuator.cli.main import main
from hydra_actuator.ros.recording_rate import lines, RecorderFigures


def test_bench_tells_what_became_of_the_messages_of_a_node(demo_process, tmp_path):
    small = tmp_path / 'small.yaml'
    small.write_text('/**:\n  ros__parameters:\n    solver: {cells: 100}\n')
    bench = demo_process('bench', '--recorder', '--duration', '3', '--config', small,
                         environment={'TMPDIR': str(tmp_path)})
    assert bench.popen.wait(240.0) == 0, bench.text
    _, run, size, share, _, *topics = bench.text.splitlines()
    ticks, dropped = map(int, re.search(r' (\d+) ticks when last told; .* (\d+) dropped$',
                                        run).groups())
    assert dropped == 0
    assert float(re.match(r'([\d.]+) MB, ', size).group(1)) > 0.1
    writer, node = map(float, re.match(
        r'writer thread ([\d.]+)% of a core, the whole node ([\d.]+)%$', share).groups())
    assert 0.0 < writer < node
    counts = {row.split()[0]: [int(value) for value in row.split()[1:4]] for row in topics}
    assert all(came == kept and lost == 0 for came, lost, kept in counts.values())
    # Nothing is lost on the way from the solver either: a state of every tick, with all pressures.
    states = counts['/joint_states'][2]
    assert states >= ticks
    assert all(counts[f'/actuator/pressure/{name}'][2] == states for name in 'OABCDEFGHIJK')
    assert counts['/actuator/field'][2] > 0.19 * states


def test_what_was_dropped_stands_beside_its_topic():
    found = RecorderFigures(10.0, 9000, {'/a': 3}, {'/a': 97, '/b': 5}, 2_000_000, 1000, 0.05, 0.5)
    told = lines(found)
    assert '102 messages in the file, 10 a second, 3 dropped' in told[0]
    assert told[1].startswith('2.0 MB, 0.20 MB a second')
    assert told[4].split() == ['/a', '100', '3', '97', '9.7']
    assert told[5].split() == ['/b', '5', '0', '5', '0.5']


def test_too_short_a_time_for_the_recorder_to_tell_of_itself_is_refused(capsys):
    assert main(['bench', '--recorder', '--duration', '1']) == 2
    assert '--duration 1 s is below 3 s' in capsys.readouterr().err
