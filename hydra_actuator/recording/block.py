# SPDX-License-Identifier: Apache-2.0
"""
The bytes of a file that is larger than memory, a block at a time.

A file is mapped, so nothing is read before it is looked at; a block that has been looked at is
given back to the system when it is closed, and a compressed one is unpacked anew each time it is
opened. However long a file is, no more than what is open takes memory.
"""

from collections import OrderedDict
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from itertools import count
import mmap
from pathlib import Path

import numpy as np

PAGE = mmap.PAGESIZE
# Chunks are joined up to this size [byte]: arrays of a few thousand messages at once.
JOINED = 4 << 20
# Unpacked blocks of a file that are kept for the next topic that is read.
KEPT = 4


class MappedFile:
    """The bytes of a file; `forget` gives back the memory of those between two places."""

    _numbers = count()

    def __init__(self, path: Path):
        """Map a file; OSError if it cannot be read."""
        with path.open('rb') as file:
            empty = not path.stat().st_size
            self._map = None if empty else mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ)
        self.bytes = np.frombuffer(b'' if empty else self._map, np.uint8)
        self.number = next(self._numbers)
        self.unpacked: OrderedDict[int, np.ndarray] = OrderedDict()

    def forget(self, start: int, stop: int) -> None:
        """Let the system take the memory of these bytes; they are read again if looked at."""
        start -= start % PAGE
        if self._map is not None and stop > start and hasattr(mmap, 'MADV_DONTNEED'):
            self._map.madvise(mmap.MADV_DONTNEED, start, stop - start)


class Block:
    """Records that lie together; `offsets` are those of its messages by channel id."""

    def __init__(self, file: MappedFile, start: int, stop: int, size: int = 0,
                 unpack: Callable[[np.ndarray], np.ndarray] | None = None):
        """Take the bytes from start to stop; `unpack` makes `size` bytes of them."""
        self._file = file
        self._start, self._stop = start, stop
        self._unpack = unpack
        self.size = size if unpack else stop - start
        self.offsets: dict[int, np.ndarray] = {}

    @property
    def place(self) -> tuple[int, int]:
        """What blocks are sorted by: the file, and the place in it."""
        return self._file.number, self._start

    @contextmanager
    def opened(self) -> Iterator[np.ndarray]:
        """Give the records, of which nothing may be kept without a copy."""
        kept = self._file.unpacked
        if self._start in kept:
            yield kept[self._start]
            return
        content = self._file.bytes[self._start: self._stop]
        try:
            if self._unpack:
                kept[self._start] = content = self._unpack(content)
                if len(kept) > KEPT:
                    kept.popitem(last=False)
            yield content
        finally:
            self._file.forget(self._start, self._stop)

    def follows(self, other: 'Block') -> bool:
        """Tell whether both are plain parts of one file that make one block of a fair size."""
        return (self._unpack is None and other._unpack is None and self._file is other._file
                and other._stop <= self._start and self._stop - other._start <= JOINED)

    @classmethod
    def joined(cls, blocks: list['Block']) -> 'Block':
        """Return one block of several that follow each other."""
        if len(blocks) == 1:
            return blocks[0]
        start = blocks[0]._start
        result = cls(blocks[0]._file, start, blocks[-1]._stop)
        for channel in dict.fromkeys(key for block in blocks for key in block.offsets):
            result.offsets[channel] = np.concatenate([
                block.offsets[channel] + (block._start - start)
                for block in blocks if channel in block.offsets])
        return result


def join(blocks: list[Block]) -> list[Block]:
    """Return the same messages in fewer blocks; what is compressed stays as it is."""
    runs: list[list[Block]] = []
    for block in blocks:
        if runs and block.follows(runs[-1][-1]) and block.follows(runs[-1][0]):
            runs[-1].append(block)
        else:
            runs.append([block])
    return [Block.joined(run) for run in runs]
