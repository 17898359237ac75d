# SPDX-License-Identifier: Apache-2.0
"""
Random numbers that belong to an instant, not to a sequence.

A draw is a function of (seed, signal, purpose, step) alone: whatever else is read, how often and
when, the same instant of the same signal gives the same number. It is SplitMix64 (Steele, Lea
and Flood 2014) entered at a counter: draw n of a stream is the mix of key + n golden gammas. A
normal deviate takes two of them, by Box and Muller (1958).
"""

from collections.abc import Sequence
import hashlib
import math

import numpy as np

_GAMMA = np.uint64(0x9E3779B97F4A7C15)
_FIRST, _SECOND = np.uint64(0xBF58476D1CE4E5B9), np.uint64(0x94D049BB133111EB)
_UNIT = 2.0 ** -53
# Instants whose draws are made at once.
BLOCK = 64


class Draws:
    """
    Independent numbers for several signals at any step, for one purpose.

    stride: steps from one reading to the next, for which the draws are made ahead.
    """

    def __init__(self, seed: int, purpose: str, signals: Sequence[str], stride: int):
        self._keys = np.array([
            int.from_bytes(hashlib.sha256(f'{seed} {purpose} {name}'.encode()).digest()[:8])
            for name in signals], np.uint64)
        self._stride = stride
        self._first = -1
        self._block = np.empty((0, len(signals)))

    def normal(self, step: int) -> np.ndarray:
        """Return a standard normal deviate for each signal, shape (signals,)."""
        if step % self._stride:
            return self._normal(np.array([step], np.uint64))[0]
        place = step // self._stride
        first = place - place % BLOCK
        if first != self._first:
            self._first = first
            self._block = self._normal(
                np.arange(first, first + BLOCK, dtype=np.uint64) * np.uint64(self._stride))
        return self._block[place - first]

    def uniform(self, step: int) -> np.ndarray:
        """Return a number in (0, 1) for each signal, shape (signals,)."""
        return self._uniform(np.array([2 * step], np.uint64))[0]

    def _normal(self, steps: np.ndarray) -> np.ndarray:
        twice = steps * np.uint64(2)
        radius = np.sqrt(-2.0 * np.log(self._uniform(twice)))
        return radius * np.cos(2.0 * math.pi * self._uniform(twice + np.uint64(1)))

    def _uniform(self, counts: np.ndarray) -> np.ndarray:
        z = self._keys + counts[:, None] * _GAMMA
        z = (z ^ (z >> np.uint64(30))) * _FIRST
        z = (z ^ (z >> np.uint64(27))) * _SECOND
        z ^= z >> np.uint64(31)
        return ((z >> np.uint64(11)).astype(float) + 0.5) * _UNIT
