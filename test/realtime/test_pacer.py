# SPDX-License-Identifier: Apache-2.0
"""The pacer's grid, counts and statistics, on a clock that is told what time it is."""

import math

from hydra_actuator.realtime.durations import DurationHistogram
from hydra_actuator.realtime.pacer import Pacer
from hypothesis import given, settings
from hypothesis import strategies as st
import numpy as np
import pytest

MS = 1_000_000


class Time:
    """A clock [ns] that moves only by sleeping and by being told to."""

    def __init__(self):
        self.now = 5_000_000_123
        self.sleeps = 0
        self.oversleep = 0

    def clock(self) -> int:
        return self.now

    def sleep(self, seconds: float) -> None:
        self.now += round(seconds * 1e9) + self.oversleep
        self.oversleep = 0
        self.sleeps += 1


def paced(policy='burst', max_burst=10, period=0.001):
    time = Time()
    pacer = Pacer(period, policy, max_burst, clock=time.clock, sleep=time.sleep)
    pacer.start()
    return time, pacer


def test_ticks_on_time_stand_on_the_grid():
    time, pacer = paced()
    origin = time.now
    for index in range(1, 2001):
        assert pacer.wait() == index
        assert time.now == origin + index * MS
        time.now += 300_000
    assert (pacer.ticks, pacer.missed, pacer.slipped) == (2000, 0, 0)
    assert pacer.lateness.maximum == 0
    assert pacer.execution.maximum == 300_000


def test_a_period_that_is_no_whole_number_of_nanoseconds_does_not_drift():
    time, pacer = paced(period=1.0 / 3000.0)
    origin = time.now
    for _ in range(30_000):
        pacer.wait()
    assert abs(time.now - origin - 10_000_000_000) <= 1


@pytest.mark.parametrize('delay_ns, missed', [
    (1, 1), (MS - 1, 1), (MS, 1), (MS + 1, 2), (7 * MS + 1, 8), (500 * MS, 500)])
def test_missed_ticks_are_the_lateness_over_the_period_rounded_up(delay_ns, missed):
    for policy in ('burst', 'slip', 'halt'):
        time, pacer = paced(policy)
        pacer.wait()
        time.now += MS + delay_ns
        pacer.wait()
        assert pacer.missed == missed, policy


def test_a_tick_that_ends_at_the_next_release_missed_nothing():
    time, pacer = paced()
    pacer.wait()
    time.now += MS
    pacer.wait()
    assert pacer.missed == 0


def test_a_late_wake_up_is_counted_once():
    time, pacer = paced()
    pacer.wait()
    time.oversleep = int(2.3 * MS)
    pacer.wait()
    assert pacer.lateness.maximum == int(2.3 * MS)
    for _ in range(20):
        pacer.wait()
    assert (pacer.missed, pacer.slipped) == (2, 0)


def test_burst_catches_up_without_sleeping_and_without_slip():
    time, pacer = paced('burst', max_burst=10)
    pacer.wait()
    time.now += 6 * MS
    sleeps = time.sleeps
    assert [pacer.wait() for _ in range(5)] == [2, 3, 4, 5, 6]
    assert time.sleeps == sleeps
    pacer.wait()
    # The sixth starts on its grid instant, where the clock stands: nothing is left to catch up.
    assert time.now == 5_000_000_123 + 7 * MS
    assert (pacer.missed, pacer.slipped) == (5, 0)


def test_what_exceeds_the_burst_is_slip_of_whole_periods():
    time, pacer = paced('burst', max_burst=4)
    pacer.wait()
    time.now += 100 * MS + 500_000
    # Grid instants 2 to 101 passed: 96 are slip, 98 to 101 are caught up, 102 is waited for.
    assert [pacer.wait() for _ in range(5)] == [98, 99, 100, 101, 102]
    assert (pacer.missed, pacer.slipped, time.sleeps) == (100, 96, 2)
    assert pacer.slip == pytest.approx(0.096)


def test_slip_starts_anew_at_the_next_grid_instant():
    time, pacer = paced('slip')
    pacer.wait()
    time.now += 3 * MS + 200_000
    assert pacer.wait() == 5
    assert time.now == 5_000_000_123 + 5 * MS
    assert (pacer.missed, pacer.slipped) == (3, 3)


def test_halt_grants_nothing_after_a_miss():
    time, pacer = paced('halt')
    pacer.wait()
    time.now += 2 * MS
    assert pacer.wait() is None
    assert pacer.halted
    assert pacer.ticks == 1
    pacer.start()
    assert not pacer.halted
    assert pacer.wait() == 1


def test_ticks_slower_than_the_period_miss_every_second_instant_only_once():
    time, pacer = paced('burst', max_burst=1)
    for _ in range(100):
        pacer.wait()
        time.now += 2 * MS
    # 100 ticks of 2 ms took 200 ms of a 1 ms grid.
    assert pacer.ticks + pacer.slipped <= 200
    assert pacer.missed == pytest.approx(198, abs=1)


@settings(deadline=None)
@given(
    policy=st.sampled_from(['burst', 'slip']),
    max_burst=st.integers(1, 20),
    work=st.lists(st.integers(0, 30 * MS), min_size=1, max_size=60),
)
def test_grid_index_is_ticks_plus_slip_whatever_happens(policy, max_burst, work):
    time, pacer = paced(policy, max_burst)
    origin = time.now
    passed = set()
    for spent in work:
        index = pacer.wait()
        assert index == pacer.ticks + pacer.slipped
        assert time.now >= origin + index * MS
        begun = time.now
        time.now += spent
        # Oracle: the grid instants later than this tick's own, before the loop came back.
        late = range(index + 1, -(-(time.now - origin) // MS))
        passed.update(late)
        assert begun <= time.now
    pacer.wait()
    assert pacer.missed == len(passed)


@settings(deadline=None, max_examples=200)
@given(
    policy=st.sampled_from(['burst', 'slip', 'halt']),
    max_burst=st.integers(1, 20),
    period_ns=st.floats(1e3, 1e8),
    before=st.integers(0, 5),
    lateness=st.floats(0.0, 200.0) | st.integers(0, 200),
    nudge=st.integers(-2, 2),
)
def test_missed_is_lateness_over_period_rounded_up_for_any_period(
        policy, max_burst, period_ns, before, lateness, nudge):
    time, pacer = paced(policy, max_burst, period_ns / 1e9)
    origin = time.now
    period_ns = period_ns / 1e9 * 1e9

    def instant(index):
        return origin + round(index * period_ns)
    # A tick somewhere on the grid, and a loop that comes back so many periods after the next.
    index = 0
    for _ in range(before):
        index = pacer.wait()
    time.now = max(time.now, instant(index + 1) + round(lateness * period_ns) + nudge)
    late = time.now - instant(index + 1)
    passed = sum(1 for k in range(int(lateness) + 3) if instant(index + 1 + k) < time.now)
    next_index = pacer.wait()
    assert pacer.missed == passed
    # Rounded to whole nanoseconds, an instant is half a one off at most.
    assert math.floor((late - 1) / period_ns) <= passed <= math.ceil((late + 1) / period_ns)
    if next_index is not None:
        assert time.now >= instant(next_index)
        assert next_index == pacer.ticks + pacer.slipped
        if policy == 'slip' and passed:
            assert next_index == index + 1 + passed


@pytest.mark.parametrize('policy, period', [('slip', 1e-3), ('burst', 1.0 / 3000.0)])
def test_a_minute_drifts_by_less_than_a_tick(policy, period):
    time, pacer = paced(policy, period=period)
    origin, random = time.now, np.random.default_rng(5)
    # Mostly in time, sometimes late, seldom very late; the sleep is late as well.
    work = random.choice([0.3, 1.5, 40.0], p=[0.97, 0.025, 0.005], size=200_000) * period * 1e9
    oversleep = random.choice([0.02, 0.9], size=work.size) * period * 1e9
    for spent, over in zip(work.astype(int).tolist(), oversleep.astype(int).tolist()):
        pacer.wait()
        time.now += spent
        time.oversleep = over
        if time.now - origin > 60_000 * MS:
            break
    assert time.now - origin > 60_000 * MS
    # Time to catch up.
    time.oversleep = 0
    for _ in range(50):
        pacer.wait()
    drift = pacer.elapsed - pacer.ticks * period - pacer.slip
    assert pacer.slipped > 0
    assert 0.0 <= drift + 1e-9 < period + 1e-9


def test_figures_go_on_over_a_second_run():
    time, pacer = paced()
    for _ in range(10):
        pacer.wait()
    pacer.stop()
    time.now += 3_000 * MS
    pacer.start()
    assert pacer.wait() == 1
    pacer.stop()
    assert (pacer.ticks, pacer.missed) == (11, 0)
    assert pacer.elapsed == pytest.approx(0.011)


def test_histogram_percentiles_agree_with_sorting_to_a_bin():
    samples = np.random.default_rng(1).lognormal(11.0, 1.5, 20_000).astype(int)
    histogram = DurationHistogram()
    for sample in samples.tolist():
        histogram.add(sample)
    ordered = np.sort(samples)
    for percent in (1.0, 50.0, 90.0, 99.0, 99.9):
        exact = ordered[int(np.ceil(percent / 100.0 * ordered.size)) - 1]
        assert exact <= histogram.percentile(percent) <= exact * (1.0 + 1.0 / 32.0)
    assert histogram.percentile(100.0) == histogram.maximum == ordered[-1]


@pytest.mark.parametrize('duration_ns', [0, 1, 63, 64, 65, 127, 128, 10**9, 2**62])
def test_histogram_takes_every_duration(duration_ns):
    histogram = DurationHistogram()
    histogram.add(duration_ns)
    assert histogram.percentile(50.0) == duration_ns


def test_an_unknown_policy_is_named():
    with pytest.raises(ValueError, match='hurry'):
        Pacer(0.001, 'hurry')
