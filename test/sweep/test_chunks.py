# SPDX-License-Identifier: Apache-2.0
"""Chunks: every run once, few tasks, none that holds many when one is to blame."""

from hydra_actuator.sweep.chunks import AT_LEAST, Chunks, PER_WORKER
import pytest


def dealt(chunks):
    found = []
    while chunk := chunks.deal():
        found.append(chunk)
    return found


def test_the_first_chunks_hold_one_run():
    assert [len(chunk) for chunk in dealt(Chunks(list(range(5)), 2))] == [1] * 5


def test_every_run_is_dealt_once_in_order():
    chunks = Chunks(list(range(1000)), 4)
    chunks.learn(10, 0.1)
    assert [run for chunk in dealt(chunks) for run in chunk] == list(range(1000))


@pytest.mark.parametrize('workers', [1, 1000])
def test_chunks_take_as_long_as_asking_can_keep_up_with(workers):
    chunks = Chunks(list(range(10_000_000)), workers)
    chunks.learn(10, 1.0)
    assert 0.1 * chunks.size == pytest.approx(max(AT_LEAST, PER_WORKER * workers), abs=0.1)


def test_towards_the_end_every_worker_has_some():
    chunks = Chunks(list(range(24)), 4)
    chunks.learn(10, 0.001)
    assert chunks.size == 2
    assert len(dealt(chunks)[-1]) == 1


def test_runs_of_a_lost_chunk_come_back_alone_and_first():
    chunks = Chunks(list(range(100)), 1)
    chunks.learn(1, 0.05)
    lost = chunks.deal()
    assert len(lost) > 1
    chunks.give_back(lost)
    assert [chunks.deal() for _ in lost] == [(run,) for run in lost]
