# SPDX-License-Identifier: Apache-2.0
"""The last seconds in memory."""

from hydra_actuator.recording.memory import Memory

SECOND = 1_000_000_000


def batch(stamp, size=100, count=3):
    return [(f'/t{k}', stamp - k, stamp, bytes(size)) for k in range(count)]


def test_what_is_older_than_the_duration_is_forgotten():
    memory = Memory(2.0)
    for tenth in range(100):
        memory.put_batch(batch(tenth * SECOND // 10 + 10))
    stamps = [message[1] for message in memory.messages()]
    newest = 99 * SECOND // 10 + 10
    assert max(stamps) == newest
    assert min(stamps) >= newest - 2 * SECOND
    assert len(stamps) == 20 * 3 + 1
    assert 1.9 <= memory.kept.span <= 2.0


def test_the_order_is_that_of_coming():
    memory = Memory(10.0)
    sent = [message for k in range(50) for message in batch(k * 1000 + 10)]
    for first in range(0, 150, 3):
        memory.put_batch(sent[first:first + 3])
    assert memory.messages() == sent


def test_memory_is_bounded_whatever_the_duration():
    memory = Memory(3600.0, capacity=100_000)
    for k in range(1000):
        memory.put_batch(batch(k * SECOND // 1000 + 10, size=1000))
        assert memory.kept.bytes <= 100_000
    kept = memory.kept
    assert kept.messages == len(memory.messages()) == 100_000 // (3 * 1150) * 3
    assert memory.messages()[-1][1] == 999 * SECOND // 1000 + 8


def test_what_is_too_large_alone_is_not_kept():
    memory = Memory(1.0, capacity=1000)
    memory.put_batch(batch(10, size=5000))
    assert memory.messages() == []
    assert memory.kept.bytes == memory.kept.messages == 0


def test_a_time_that_begins_anew_begins_with_nothing():
    memory = Memory(1.0)
    memory.put_batch(batch(100 * SECOND))
    memory.clear()
    memory.put_batch(batch(SECOND))
    assert len(memory.messages()) == 3
