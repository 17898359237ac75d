# SPDX-License-Identifier: Apache-2.0
"""A minute in real time, beside a bare sleeper on the same machine; prints the figures (-s)."""

import threading
import time

from hydra_actuator import load_recording
from hydra_actuator.realtime.pacer import Pacer
import numpy as np
import pytest

DURATION = 60.0
PERIOD = 1e-3
# Share of the ticks that have to be there.
COMPLETE = 0.995


class Sleeper:
    """A loop of the same period that does nothing."""

    def __init__(self):
        self.pacer = Pacer(PERIOD)
        self._stopping = False
        self._thread = threading.Thread(target=self._run)

    def _run(self):
        self.pacer.start()
        while not self._stopping:
            self.pacer.wait()

    def __enter__(self):
        self._thread.start()
        return self

    def __exit__(self, *_):
        self._stopping = True
        self._thread.join()


def processor_time(pid):
    """Return the processor time [s] that a process has used."""
    fields = open(f'/proc/{pid}/stat').read().rpartition(')')[2].split()
    return (int(fields[11]) + int(fields[12])) / 100.0


def shown(histogram):
    return ' / '.join(f'{histogram.percentile(p) / 1e3:.0f}' for p in (50.0, 99.0, 100.0))


@pytest.mark.soak
def test_a_minute_idle_loses_no_tick_of_joint_states_and_pressures(node_process):
    node = node_process('-p', 'solver.cells:=200')
    before = processor_time(node.popen.pid)
    with Sleeper() as sleeper:
        time.sleep(DURATION)
    share = (processor_time(node.popen.pid) - before) / DURATION
    assert node.end()[0] == 0
    recording = load_recording(node.recording)
    status = next(
        status for message in reversed(list(recording.messages('/diagnostics')))
        for status in message['status'] if status['name'].endswith(': Real time'))
    figures = {one['key']: one['value'] for one in status['values']}
    print(f'\nnode     lateness p50 / p99 / max [us] {figures["lateness_p50"]} / '
          f'{figures["lateness_p99"]} / {figures["lateness_max"]}, overruns '
          f'{figures["overruns"]} of {figures["ticks"]}, {share:.0%} of a core\n'
          f'sleeper  lateness p50 / p99 / max [us] {shown(sleeper.pacer.lateness)}, overruns '
          f'{sleeper.pacer.missed} of {sleeper.pacer.ticks}')
    stamps = recording.row_stamps
    ticks = round((stamps[-1] - stamps[0]) * 1e-9 / PERIOD) + 1
    assert np.all(np.diff(stamps) > 0)
    for name, topic in recording.topics.items():
        if name == '/joint_states' or '/pressure/' in name:
            assert topic.count >= COMPLETE * ticks, name
