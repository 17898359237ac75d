# SPDX-License-Identifier: Apache-2.0
"""The command that holds, and what silence does to it."""

from hydra_actuator.ros.setpoint import Setpoint
import pytest

SECOND = 1_000_000_000


class Clock:
    now = 7 * SECOND

    def __call__(self):
        return self.now


@pytest.fixture
def clock():
    return Clock()


def test_command_and_load_hold_for_ever_without_a_timeout(clock):
    setpoint = Setpoint(clock=clock)
    assert setpoint.sample() == (0.0, 0.0, 0.0)
    setpoint.accept((0.5, -0.5))
    setpoint.accept_load(100.0)
    clock.now += 1000 * SECOND
    assert setpoint.sample() == (0.5, -0.5, 100.0)
    assert not setpoint.timed_out


@pytest.mark.parametrize('on_timeout, spools', [('hold', (0.5, 0.5)), ('centre', (0.0, 0.0))])
def test_silence_longer_than_the_timeout_acts_and_is_counted_once(clock, on_timeout, spools):
    setpoint = Setpoint(0.1, on_timeout, clock)
    setpoint.accept((0.5, 0.5))
    setpoint.accept_load(100.0)
    clock.now += SECOND // 10
    assert setpoint.sample() == (0.5, 0.5, 100.0)
    clock.now += 1
    assert setpoint.sample() == (*spools, 100.0)
    assert setpoint.sample() == (*spools, 100.0)
    assert (setpoint.timed_out, setpoint.timeouts) == (True, 1)


def test_a_new_command_ends_the_timeout(clock):
    setpoint = Setpoint(0.1, 'centre', clock)
    clock.now += SECOND
    setpoint.sample()
    setpoint.accept((0.25, 0.25))
    assert setpoint.sample() == (0.25, 0.25, 0.0)
    assert (setpoint.timed_out, setpoint.timeouts) == (False, 1)


def test_centring_forgets_the_command_and_keeps_the_load(clock):
    setpoint = Setpoint(clock=clock)
    setpoint.accept((1.0, 1.0))
    setpoint.accept_load(-5.0)
    setpoint.centre()
    assert setpoint.sample() == (0.0, 0.0, -5.0)


def test_of_several_commands_within_a_tick_one_is_applied(clock):
    setpoint = Setpoint(clock=clock)
    setpoint.sample()
    assert (setpoint.applied, setpoint.commanded) == (0, False)
    setpoint.accept((0.25, 0.25))
    setpoint.accept((0.5, 0.5))
    assert (setpoint.sampled, setpoint.applied) == ((0.0, 0.0, 0.0), 0)
    setpoint.sample()
    setpoint.sample()
    assert setpoint.sampled == (0.5, 0.5, 0.0)
    assert (setpoint.applied, setpoint.commanded) == (1, True)
    setpoint.centre()
    setpoint.sample()
    assert (setpoint.applied, setpoint.commanded) == (1, False)
