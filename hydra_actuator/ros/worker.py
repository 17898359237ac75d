# SPDX-License-Identifier: Apache-2.0
"""A thread that is started, asked to end, and joined; and then perhaps started again."""

from collections.abc import Callable
import threading


class Worker:
    """
    Runs a function in a thread of its own.

    The function looks at `stopping` and returns when it is set.
    """

    def __init__(self, name: str, run: Callable[..., None]):
        self.stopping = False
        self._name = name
        self._run = run
        self._thread: threading.Thread | None = None

    @property
    def running(self) -> bool:
        """Tell whether the thread was started and not yet joined."""
        return self._thread is not None

    def start(self, *arguments) -> None:
        """Begin, with arguments for the function."""
        self.stopping = False
        self._thread = threading.Thread(
            target=self._run, args=arguments, name=self._name, daemon=True)
        self._thread.start()

    def stop(self, wake: Callable[[], None] = lambda: None) -> None:
        """Ask the function to return, wake it if it waits, and join; nothing if not running."""
        if self._thread is not None:
            self.stopping = True
            wake()
            self._thread.join()
            self._thread = None
