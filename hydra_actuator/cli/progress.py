# SPDX-License-Identifier: Apache-2.0
"""A progress bar on a terminal, silent in a pipe."""

import sys
import time

WIDTH = 40
REFRESH_PERIOD = 0.1


class ProgressBar:
    """Shows the share done of a long run on stderr, at most ten times a second."""

    def __init__(self, title: str) -> None:
        """Show nothing before the first call; nothing at all where stderr is no terminal."""
        self._title = title
        self._visible = sys.stderr.isatty()
        self._next = 0.0

    def __enter__(self) -> 'ProgressBar':
        return self

    def __exit__(self, *_) -> None:
        self.clear()

    def clear(self) -> None:
        """Take it away, for a line to be printed; the next call draws it again."""
        if self._visible:
            print('\r\x1b[2K', end='', file=sys.stderr, flush=True)

    def __call__(self, share: float) -> None:
        """Draw a share from 0 to 1."""
        now = time.monotonic()
        if not self._visible or now < self._next:
            return
        self._next = now + REFRESH_PERIOD
        full = int(WIDTH * share)
        bar = '#' * full + '-' * (WIDTH - full)
        print(f'\r{self._title} [{bar}] {share:4.0%}', end='', file=sys.stderr, flush=True)
