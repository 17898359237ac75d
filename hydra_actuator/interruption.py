# SPDX-License-Identifier: Apache-2.0
"""
Ctrl-C between two pieces of work instead of in the midst of one.

Python raises KeyboardInterrupt wherever the program happens to be: halfway through a record of a
file, or inside a library that swallows it, as compilers do. Here it is noted, and raised where
the file is whole.
"""

import signal
import sys
import threading
import time

PATIENCE = 1.0


class Interruption:
    """
    Notes Ctrl-C while a block runs, so that none is lost, and from `hold` on puts it off.

    Held, it comes at the next `raise_if_asked` or at the block's end. A second one more than
    PATIENCE [s] after the first is not held: whatever hangs can be left. Nothing changes outside
    the main thread, or where someone else handles the signal.
    """

    def __init__(self) -> None:
        self._asked: float | None = None
        self._holding = False
        self._installed = False

    def __enter__(self) -> 'Interruption':
        main = threading.current_thread() is threading.main_thread()
        if main and signal.getsignal(signal.SIGINT) is signal.default_int_handler:
            self._installed = True
            signal.signal(signal.SIGINT, self._note)
            self._hook, sys.unraisablehook = sys.unraisablehook, self._report
        return self

    def __exit__(self, kind: type[BaseException] | None, *_) -> None:
        if self._installed:
            signal.signal(signal.SIGINT, signal.default_int_handler)
            sys.unraisablehook = self._hook
        if kind is None or not self._holding:
            # Before `hold` an error is what became of the KeyboardInterrupt.
            self.raise_if_asked()

    def hold(self) -> None:
        """Put off from now on; what came before and was swallowed comes here."""
        self.raise_if_asked()
        self._holding = True

    def raise_if_asked(self) -> None:
        """Raise KeyboardInterrupt if there was a Ctrl-C."""
        if self._asked is not None:
            raise KeyboardInterrupt from None

    def _note(self, *_) -> None:
        now = time.monotonic()
        if self._asked is None:
            self._asked = now
        if not self._holding or now - self._asked > PATIENCE:
            raise KeyboardInterrupt

    def _report(self, unraisable: 'sys.UnraisableHookArgs') -> None:
        """Report what a callback from C could not raise, but for a Ctrl-C, which is noted."""
        if unraisable.exc_type is not KeyboardInterrupt:
            self._hook(unraisable)
