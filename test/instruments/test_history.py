# SPDX-License-Identifier: Apache-2.0
"""Past signals by tick: exact at ticks, linear between them, held beyond what is known."""

from hydra_actuator.instruments.history import History
import numpy as np


def filled(ticks, capacity=16):
    history = History(2, capacity)
    for tick in range(ticks):
        history.append(tick, np.array([float(tick) ** 2, -float(tick)]))
    return history


def at(history, places, now, values=(np.nan, np.nan)):
    return history.at(np.array(places, float), now, np.array(values)).tolist()


def test_each_signal_has_its_own_place():
    assert at(filled(10), [4.0, 7.0], 9.0) == [16.0, -7.0]


def test_between_two_ticks_a_signal_is_linear():
    assert at(filled(10), [4.5, 7.25], 9.0) == [20.5, -7.25]


def test_between_the_last_tick_and_now_it_runs_to_what_it_is_now():
    history = filled(10)
    assert at(history, [9.0, 9.5], 9.5, (100.0, 3.0)) == [81.0, 3.0]
    assert at(history, [9.25, 9.25], 9.5, (101.0, -10.0)) == [91.0, -9.5]


def test_before_the_first_tick_known_it_is_what_it_was_then():
    assert at(filled(10), [-3.0, -0.5], 9.0) == [0.0, 0.0]
    assert at(filled(40), [2.0, 24.0], 39.0) == [24.0 ** 2, -24.0]


def test_nothing_known_gives_the_signals_as_they_are():
    assert at(History(2, 4), [0.0, 0.0], 3.0, (1.0, 2.0)) == [1.0, 2.0]


def test_ticks_left_out_hold_what_came_after_them():
    history = filled(3)
    history.append(6, np.array([7.0, 8.0]))
    assert at(history, [2.0, 3.0], 6.0) == [4.0, 8.0]
    history.append(600, np.array([1.0, 2.0]))
    assert at(history, [6.0, 599.0], 600.0) == [1.0, 2.0]
