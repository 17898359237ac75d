# SPDX-License-Identifier: Apache-2.0
"""
Ctrl-C between two pieces of work instead of in the midst of one.

Python raises KeyboardInterrupt wherever the program happens to be, also halfway through a record
of a file. Here it is noted, and raised where the file is whole.
"""

import signal
import threading
import time

PATIENCE = 1.0


class HeldInterrupt:
    """
    Holds Ctrl-C back while a block runs, until `raise_if_asked` or the block's end.

    A second Ctrl-C, more than PATIENCE [s] after the first, is not held: whatever hangs can be
    left. Nothing is held outside the main thread, or where someone else handles the signal.
    """

    def __init__(self) -> None:
        self._asked: float | None = None
        self._holding = False

    def __enter__(self) -> 'HeldInterrupt':
        main = threading.current_thread() is threading.main_thread()
        if main and signal.getsignal(signal.SIGINT) is signal.default_int_handler:
            self._holding = True
            signal.signal(signal.SIGINT, self._note)
        return self

    def __exit__(self, kind: type[BaseException] | None, *_) -> None:
        if self._holding:
            signal.signal(signal.SIGINT, signal.default_int_handler)
            self._holding = False
        if kind is None:
            self.raise_if_asked()

    def raise_if_asked(self) -> None:
        """Raise KeyboardInterrupt if there was a Ctrl-C."""
        if self._asked is not None:
            raise KeyboardInterrupt

    def _note(self, *_) -> None:
        now = time.monotonic()
        if self._asked is not None and now - self._asked > PATIENCE:
            raise KeyboardInterrupt
        self._asked = self._asked or now
