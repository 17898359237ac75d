# SPDX-License-Identifier: Apache-2.0
"""What the solver puts into the ring comes out in order, or is counted as lost."""

import threading
import time

from hydra_actuator.ros.ring import Ring
import numpy as np


def fill(ring, first, last):
    for number in range(first, last):
        ring.push(number, 1000 + number, number, (0.1, 0.2, 3.0), np.full(4, float(number)))


def test_ticks_come_out_once_and_in_order():
    ring = Ring(4, 1, length=8)
    fill(ring, 0, 3)
    first = list(ring.ticks())
    fill(ring, 3, 8)
    ticks = first + list(ring.ticks())
    assert [tick.number for tick in ticks] == list(range(8))
    assert [tick.stamp for tick in ticks] == list(range(1000, 1008))
    assert [tick.row for tick in ticks] == [[float(n)] * 4 for n in range(8)]
    assert ticks[0].inputs == [0.1, 0.2, 3.0]
    assert not list(ring.ticks())
    assert ring.lost == 0


def test_a_reader_that_is_late_loses_the_oldest_and_knows_how_many():
    ring = Ring(4, 1, length=8)
    fill(ring, 0, 20)
    numbers = [tick.number for tick in ring.ticks()]
    assert numbers == list(range(13, 20))
    assert ring.lost == 13


def test_a_writer_with_time_waits_until_half_is_read():
    ring = Ring(4, 1, length=8)
    fill(ring, 0, 4)
    assert ring.has_room(0.0)
    fill(ring, 4, 5)
    assert not ring.has_room(0.0)
    reader = threading.Timer(0.05, lambda: list(ring.ticks()))
    reader.start()
    assert ring.has_room(10.0)
    assert ring.is_read(0.0)
    reader.join()


def test_a_reader_that_always_lags_has_read_what_was_there_when_it_was_asked():
    ring, answers = Ring(4, 1, length=8), []
    fill(ring, 0, 3)
    asking = threading.Thread(target=lambda: answers.append(ring.is_read(5.0)))
    asking.start()
    number = 3
    while asking.is_alive():
        reading = ring.ticks()
        next(reading)
        fill(ring, number, number + 1)
        list(reading)
        number += 1
    assert answers == [True]


def test_frames_keep_their_own_values():
    ring = Ring(4, 3, frames=4)
    for number in range(3):
        ring.frame()[:] = number
        ring.push_frame(100 + number, 0.5 * number)
    frames = list(ring.frames())
    assert [(frame.stamp, frame.time, frame.values[2, 1]) for frame in frames] == [
        (100, 0.0, 0.0), (101, 0.5, 1.0), (102, 1.0, 2.0)]


def test_signals_do_not_pile_up():
    ring = Ring(4, 1)
    ring.signal()
    ring.signal()
    begin = time.monotonic()
    ring.wait(30.0)
    assert time.monotonic() - begin < 30.0
    begin = time.monotonic()
    ring.wait(0.05)
    assert time.monotonic() - begin >= 0.05
