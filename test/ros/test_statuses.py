# SPDX-License-Identifier: Apache-2.0
"""What diagnostics say of counts and figures."""

from hydra_actuator.realtime.pacer import Pacer
from hydra_actuator.ros import statuses
import pytest

PERIOD = 1e-3
REFUSED = {
    'thread_priority_requested': 'SCHED_FIFO 80', 'thread_priority_obtained': 'SCHED_OTHER',
    'thread_priority_refused': 'Operation not permitted; the limit rtprio is 0'}


class Clock:
    """Time [ns] that passes in sleep, and as much more as is set."""

    def __init__(self):
        self.now = 0
        self.late = 0

    def __call__(self):
        return self.now

    def sleep(self, seconds):
        self.now += round(seconds * 1e9) + self.late


@pytest.fixture
def pacer():
    """Return a pacer that was 5 us late 1999 times, then 700 us once."""
    clock = Clock()
    pacer = Pacer(PERIOD, clock=clock, sleep=clock.sleep)
    pacer.start()
    clock.late = 5_000
    for _ in range(1999):
        pacer.wait()
    clock.late = 700_000
    pacer.wait()
    return pacer


def test_real_time_shows_percentiles_and_maximum(pacer):
    values = statuses.real_time(pacer, PERIOD, False).values
    assert float(values['lateness_p50']) == pytest.approx(5.0, rel=0.04)
    assert float(values['lateness_p99']) == pytest.approx(5.0, rel=0.04)
    assert float(values['lateness_p99.9']) == pytest.approx(5.0, rel=0.04)
    assert values['lateness_max'] == '700.0'
    assert {f'execution_{name}' for name in ('p50', 'p99', 'p99.9', 'max')} <= values.keys()


def test_what_was_refused_is_a_warning_with_its_reason(pacer):
    ticks = statuses.real_time(pacer, PERIOD, False)
    status = statuses.scheduled(ticks, REFUSED)
    assert status.level == statuses.WARN
    assert status.message == (
        'on time; thread priority refused: Operation not permitted; the limit rtprio is 0')
    assert status.values['thread_priority_obtained'] == 'SCHED_OTHER'
    assert status.values['ticks'] == ticks.values['ticks']
    granted = statuses.scheduled(ticks, {'timer_slack_obtained': '1 ns'})
    assert (granted.level, granted.message) == (statuses.OK, 'on time')


def test_a_missed_tick_comes_before_what_was_refused(pacer):
    status = statuses.scheduled(statuses.real_time(pacer, PERIOD, True), REFUSED)
    assert (status.level, status.message) == (statuses.WARN, '0 ticks missed in all')


def test_values_are_put_together_when_looked_at_and_once():
    made = []
    values = statuses.OnDemand(lambda: made.append(1) or {'ticks': '7'})
    assert not made
    assert values['ticks'] == '7'
    assert dict(values) == {'ticks': '7'}
    assert len(made) == 1
