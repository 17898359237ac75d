# SPDX-License-Identifier: Apache-2.0
"""The supply is switched over a ramp, and is not touched while it is on."""

from hydra_actuator.supply import RAMP, Supply
import numpy as np
import pytest

TICKS = round(RAMP / 1e-3)


def supply():
    return Supply(21e6, 2.5e6, 1e-3)


def test_a_supply_that_is_on_gives_nothing_to_set():
    own = supply()
    assert [own.tick() for _ in range(100)] == [None] * 100


def test_switched_off_it_falls_monotonically_to_the_tank_within_the_ramp():
    own = supply()
    own.on = False
    given = [own.tick() for _ in range(TICKS + 1)]
    assert np.all(np.diff([one for one in given if one is not None]) < 0.0)
    assert given[TICKS - 1] == 2.5e6
    assert own.tick() is None


def test_switched_on_again_it_returns_to_exactly_its_pressure():
    own = supply()
    for own.on in (False, True):
        given = [own.tick() for _ in range(TICKS + 5)]
    assert [one for one in given if one is not None][-1] == 21e6


def test_a_new_pressure_acts_at_once():
    own = supply()
    own.pressure = 15e6
    assert own.tick() == 15e6
    assert own.tick() is None


def test_a_part_is_lost_over_the_ramp_and_comes_back_exactly():
    own = supply()
    own.loss = 0.25
    assert not own.resting
    given = [one for one in (own.tick() for _ in range(TICKS)) if one is not None]
    assert given[-1] == pytest.approx(21e6 - 0.25 * 18.5e6, rel=1e-15)
    assert own.resting
    own.loss = 0.0
    assert [one for one in (own.tick() for _ in range(TICKS)) if one is not None][-1] == 21e6


def test_off_is_off_whatever_is_lost():
    own = supply()
    own.loss, own.on = 0.5, False
    assert [one for one in (own.tick() for _ in range(TICKS)) if one is not None][-1] == 2.5e6


def test_a_new_beginning_is_at_the_first_pressure_and_ramps_to_what_is_wanted():
    own = supply()
    own.on, own.pressure = False, 15e6
    for _ in range(TICKS):
        own.tick()
    own.begin()
    assert own.pressure == 21e6
    first = own.tick()
    assert 0.99 * 21e6 < first < 21e6
