# SPDX-License-Identifier: Apache-2.0
"""What Linux grants and what it refuses, in processes of their own: asked, never assumed."""

import json
import os
import subprocess
import sys

from hydra_actuator.ros.scheduling import refusals
import pytest

CORE = min(os.sched_getaffinity(0))

ASK = """
import json, os, resource, sys, threading
from hydra_actuator.parameters import Parameters
from hydra_actuator.ros.scheduling import lock_memory, prepare_thread
resource.setrlimit(resource.RLIMIT_RTPRIO, (0, 0))
resource.setrlimit(resource.RLIMIT_MEMLOCK, (65536, 65536))
if sys.argv[2] == 'without' and os.geteuid() == 0:
    os.setresuid(65534, 65534, 65534)
parameters = Parameters().replace(json.loads(sys.argv[1]))
other = threading.Thread(target=threading.Event().wait, daemon=True)
other.start()
told = lock_memory(parameters) | prepare_thread(parameters)
told['scheduler'] = [os.sched_getscheduler(0), os.sched_getparam(0).sched_priority]
told['other'] = os.sched_getparam(other.native_id).sched_priority
told['cores'] = sorted(os.sched_getaffinity(0))
print(json.dumps(told))
"""
ALL = {'timing.thread_priority': 7, 'timing.cpu_affinity': [CORE], 'timing.lock_memory': True}


def asked(wishes, privileges):
    """Return what a process was told that asked Linux, with or without privileges."""
    answer = subprocess.run(
        [sys.executable, '-c', ASK, json.dumps(wishes), privileges], check=True,
        capture_output=True, text=True)
    return json.loads(answer.stdout)


@pytest.fixture(scope='module')
def refused():
    return asked({**ALL, 'timing.cpu_affinity': [CORE, 4000]}, 'without')


def test_a_refused_priority_is_told_with_its_limit_and_what_holds_instead(refused):
    assert refused['thread_priority_requested'] == 'SCHED_FIFO 7'
    assert refused['thread_priority_obtained'] == 'SCHED_OTHER'
    assert refused['thread_priority_refused'].endswith('the limit rtprio is 0')
    assert refused['scheduler'] == [os.SCHED_OTHER, 0]


def test_memory_beyond_the_limit_is_told_with_the_limit(refused):
    assert refused['lock_memory_refused'].endswith('the limit memlock is 65536 bytes')
    assert refused['lock_memory_obtained'] == '0 kB'


def test_of_cores_those_that_exist_are_obtained(refused):
    assert refused['cpu_affinity_requested'] == f'{CORE}, 4000'
    assert refused['cpu_affinity_obtained'] == str(CORE)
    assert refused['cpu_affinity_refused'] == 'not to be had: 4000'
    assert refused['cores'] == [CORE]


def test_each_refusal_is_a_line(refused):
    lines = refusals(refused)
    assert [line.partition(' refused')[0] for line in lines] == [
        'thread priority', 'cpu affinity', 'lock memory']


def test_cores_that_do_not_exist_are_refused():
    told = asked({'timing.cpu_affinity': [4000]}, 'without')
    assert told['cpu_affinity_refused']
    assert set(told['cpu_affinity_obtained'].split(', ')) == set(map(str, told['cores']))


@pytest.mark.skipif(os.geteuid() != 0, reason='real-time priority is a privilege')
def test_what_is_granted_holds():
    told = asked(ALL, 'with')
    assert refusals(told) == []
    assert told['thread_priority_obtained'] == 'SCHED_FIFO 7'
    assert told['scheduler'] == [os.SCHED_FIFO, 7]
    # Whoever has the interpreter when the solver needs it must get a processor, too.
    assert told['other'] == 6
    assert told['cpu_affinity_obtained'] == str(CORE)
    assert int(told['lock_memory_obtained'].removesuffix(' kB')) > 1000


def test_nothing_but_timer_slack_is_asked_without_a_wish():
    told = asked({}, 'without')
    assert told['timer_slack_obtained'] == '1 ns'
    assert set(told) == {
        'timer_slack_requested', 'timer_slack_obtained', 'scheduler', 'other', 'cores'}
    assert told['other'] == 0
