# SPDX-License-Identifier: Apache-2.0
"""
SIGINT and SIGTERM from the first moment on, before anything heavy is imported.

The signals are blocked and the main thread waits for them; the work goes on in another thread.
So there is no handler that could run in the middle of something, none that waits for the end of
a long call, and none that rclpy or numba could replace.
"""

import signal
import threading

SIGNALS = (signal.SIGINT, signal.SIGTERM)


def take_signals() -> None:
    """Block the signals in this thread and in those it starts; they wait to be collected."""
    for number in SIGNALS:
        # A shell ignores SIGINT for what it starts in the background, and an ignored signal
        # does not wait: it needs a handler, which is never called.
        signal.signal(number, lambda *_: None)
    signal.pthread_sigmask(signal.SIG_BLOCK, SIGNALS)


def wait_for_signal() -> None:
    """Wait in the main thread for a signal, or for `end_waiting`."""
    # Not sigtimedwait: stopped and continued past its time limit, Python's returns as if there
    # had been a signal.
    signal.sigwait(SIGNALS)


def end_waiting() -> None:
    """End the main thread's wait from another thread, now or as soon as it begins."""
    signal.pthread_kill(threading.main_thread().ident, signal.SIGTERM)
