# SPDX-License-Identifier: Apache-2.0
"""Lockstep: a tick for each command, in order; waiting is reported and never skipped."""

import threading

from hydra_actuator.ros import statuses
from hydra_actuator.ros.clocks import stepped, waiting
from hydra_actuator.ros.clocks.source import Act, START
from hydra_actuator.ros.clocks.stepped import Stepped
import pytest

PERIOD = 2e-3
PERIOD_NS = 2_000_000


@pytest.fixture
def impatient(monkeypatch):
    monkeypatch.setattr(stepped, 'REPETITION', 0.02)
    monkeypatch.setattr(waiting, 'LONG_WAIT', 0.05)


def source(free_wheel=0.0):
    own = Stepped(PERIOD, free_wheel)
    assert own.start(0) == START
    return own


def test_each_command_is_a_tick_with_its_own_inputs_in_the_order_they_came():
    own = source()
    commands = [(0.1 * k, 0.1 * k, float(k)) for k in range(5)]
    for inputs in commands:
        own.command(inputs)
    grants = [own.wait() for _ in commands]
    assert [grant.inputs for grant in grants] == commands
    assert [grant.stamp for grant in grants] == [START + k * PERIOD_NS for k in range(1, 6)]
    assert {grant.act for grant in grants} == {Act.SOLVE}


def test_a_command_ends_the_wait():
    own = source()
    sender = threading.Timer(0.05, own.command, [(0.5, 0.5, 0.0)])
    sender.start()
    assert own.wait().inputs == (0.5, 0.5, 0.0)
    sender.join()


def test_stamps_do_not_drift_with_a_period_of_no_whole_nanoseconds():
    own = Stepped(1e-3 / 3.0)
    own.start(0)
    for _ in range(3000):
        own.command((0.0, 0.0, 0.0))
    assert [own.wait() for _ in range(3000)][-1].stamp == START + 1_000_000_000


def test_the_initial_state_is_shown_again_with_its_stamp_until_the_first_command(impatient):
    own = source()
    shown = [grant for grant in (own.wait() for _ in range(6)) if grant is not None]
    assert len(shown) >= 2
    assert {(grant.stamp, grant.act) for grant in shown} == {(START, Act.REPEAT)}
    own.command((0.0, 0.0, 0.0))
    assert own.wait().act is Act.SOLVE
    assert [own.wait() for _ in range(3)] == [None] * 3


def test_waiting_is_reported_while_it_lasts_and_counted_once(impatient):
    own = source()
    while not own.watched()[0].count():
        own.wait()
    assert own.status().level == statuses.WARN
    assert 'waiting for a command' in own.status().message
    own.wait()
    assert own.watched()[0].count() == 1
    own.command((0.0, 0.0, 0.0))
    own.wait()
    assert own.status().level == statuses.OK
    while own.watched()[0].count() < 2:
        assert own.wait() is None


def test_free_wheeling_it_ticks_with_what_holds_until_the_first_command():
    own = source(free_wheel=1e-3)
    ticks = [grant for grant in (own.wait() for _ in range(5)) if grant is not None]
    assert {grant.inputs for grant in ticks} == {None}
    assert [grant.stamp for grant in ticks] == [
        START + k * PERIOD_NS for k in range(1, len(ticks) + 1)]
    own.command((1.0, 1.0, 0.0))
    last = own.wait()
    assert (last.inputs, last.stamp) == ((1.0, 1.0, 0.0), ticks[-1].stamp + PERIOD_NS)


def test_a_reset_puts_time_back_and_forgets_the_commands_before_it(impatient):
    own = source()
    for _ in range(3):
        own.command((0.5, 0.5, 0.0))
    own.wait()
    own.restart()
    assert own.wait() == (START, Act.RESET, None)
    own.command((0.7, 0.7, 0.0))
    assert own.wait() == (START + PERIOD_NS, Act.SOLVE, (0.7, 0.7, 0.0))


def test_a_wake_ends_the_wait_and_loses_no_command():
    own = source()
    own.wake()
    assert own.wait() is None
    own.command((0.5, 0.5, 0.0))
    own.wake()
    assert own.wait().inputs == (0.5, 0.5, 0.0)


def test_stopped_a_step_takes_the_next_command_or_what_holds():
    own = source()
    own.command((0.5, 0.5, 0.0))
    assert own.out_of_turn(START) == (START + PERIOD_NS, Act.SOLVE, (0.5, 0.5, 0.0))
    assert own.out_of_turn(START) == (START + 2 * PERIOD_NS, Act.SOLVE, None)
    own.command((0.5, 0.5, 0.0))
    own.forget()
    own.wake()
    assert own.wait() is None
