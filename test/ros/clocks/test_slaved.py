# SPDX-License-Identifier: Apache-2.0
"""Slaved to /clock: whole periods, waits, resets and slip."""

import threading

from hydra_actuator.ros import statuses
from hydra_actuator.ros.clocks import waiting
from hydra_actuator.ros.clocks.slaved import Slaved
from hydra_actuator.ros.clocks.source import Act
import pytest

PERIOD = 2e-3
PERIOD_NS = 2_000_000
FIRST = 5_000_000_000


@pytest.fixture(autouse=True)
def impatient(monkeypatch):
    monkeypatch.setattr(waiting, 'LONG_WAIT', 0.02)


def followed(*values, max_burst=10):
    """Return a source that has granted all up to the values, one after the other."""
    own = Slaved(PERIOD, max_burst)
    own.start(0)
    for value in values:
        own.hear(value)
        granted(own)
    return own


def granted(own):
    """Return what is granted until /clock has to be waited for."""
    grants = []
    while (grant := own.wait()) is not None:
        grants.append(grant)
    return grants


def test_the_initial_state_stands_where_the_clock_is_first_heard():
    own = followed()
    assert own.wait() is None
    own.hear(0)
    assert own.wait() is None
    own.hear(FIRST)
    assert granted(own) == [(FIRST, Act.RESET, None)]


def test_whole_periods_are_granted_and_the_rest_kept():
    own = followed(FIRST)
    stamps = []
    for value in range(FIRST, FIRST + 10 * PERIOD_NS + 1, 700_000):
        own.hear(value)
        new = [grant.stamp for grant in granted(own)]
        assert all(stamp <= value < stamp + 10 * PERIOD_NS for stamp in new)
        stamps += new
    assert stamps == [FIRST + k * PERIOD_NS for k in range(1, 10)]


def test_a_clock_that_stands_is_waited_for_and_reported():
    own = followed(FIRST)
    own.hear(FIRST + PERIOD_NS - 1)
    assert granted(own) == []
    assert own.status().level == statuses.WARN
    assert 'waiting for /clock' in own.status().message
    assert own.watched()[0].count() >= 1
    own.hear(FIRST + PERIOD_NS)
    assert own.wait().stamp == FIRST + PERIOD_NS
    assert own.status().level == statuses.OK


def test_a_value_ends_the_wait():
    own = followed(FIRST)
    sender = threading.Timer(0.005, own.hear, [FIRST + PERIOD_NS])
    sender.start()
    while (grant := own.wait()) is None:
        pass
    assert grant.stamp == FIRST + PERIOD_NS
    sender.join()


def test_backwards_is_a_reset_that_begins_there():
    own = followed(FIRST, FIRST + 5 * PERIOD_NS)
    own.hear(FIRST + 3 * PERIOD_NS + 11)
    assert granted(own) == [(FIRST + 3 * PERIOD_NS + 11, Act.RESET, None)]
    own.hear(FIRST + 4 * PERIOD_NS + 11)
    assert [grant.stamp for grant in granted(own)] == [FIRST + 4 * PERIOD_NS + 11]


def test_forward_up_to_max_burst_is_caught_up_and_beyond_is_slip():
    own = followed(FIRST)
    own.hear(FIRST + 10 * PERIOD_NS)
    assert len(granted(own)) == 10
    assert own.slipped == 0
    own.hear(FIRST + 50 * PERIOD_NS)
    assert [grant.stamp for grant in granted(own)] == [
        FIRST + k * PERIOD_NS for k in range(41, 51)]
    assert own.slipped == 30
    assert own.watched()[1].count() == 30


def test_after_a_pause_it_goes_on_from_where_the_clock_is():
    own = followed(FIRST, FIRST + 2 * PERIOD_NS)
    own.stop()
    own.hear(FIRST + 1000 * PERIOD_NS)
    own.start(FIRST + 2 * PERIOD_NS)
    assert granted(own) == []
    assert own.slipped == 0
    own.hear(FIRST + 1001 * PERIOD_NS)
    assert [grant.stamp for grant in granted(own)] == [FIRST + 1001 * PERIOD_NS]


def test_a_reset_that_is_asked_for_begins_at_the_clock():
    own = followed(FIRST, FIRST + 2 * PERIOD_NS + 5)
    own.restart()
    assert granted(own) == [(FIRST + 2 * PERIOD_NS + 5, Act.RESET, None)]


def test_stopped_a_step_is_one_period():
    own = followed(FIRST)
    assert own.out_of_turn(FIRST) == (FIRST + PERIOD_NS, Act.SOLVE, None)
    own.restart()
    assert own.out_of_turn(FIRST + PERIOD_NS).act is Act.RESET
