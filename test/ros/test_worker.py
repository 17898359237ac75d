# SPDX-License-Identifier: Apache-2.0
"""A thread that is started and stopped, more than once."""

import threading

from hydra_actuator.ros.worker import Worker


def test_a_worker_runs_until_it_is_stopped_and_can_run_again():
    news, given = threading.Event(), []

    def work(word):
        given.append(word)
        while not worker.stopping:
            news.wait(10.0)
    worker = Worker('test', work)
    assert not worker.running
    worker.stop()
    for word in ('one', 'two'):
        news.clear()
        worker.start(word)
        assert worker.running
        worker.stop(news.set)
        assert not worker.running
    assert given == ['one', 'two']
