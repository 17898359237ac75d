# SPDX-License-Identifier: Apache-2.0
"""
Calls of the system for compiled code: the clock, sleep, a wake-up, order in memory. Linux, 64 bit.

Source: clock_gettime(2), clock_nanosleep(2), eventfd(2); all in the C library, which every
process of Python has.
"""

from hydra_actuator.core.compilation import formula
from llvmlite import ir
from numba import types
from numba.extending import intrinsic
import numpy as np

NS = 1_000_000_000
_MONOTONIC, _ABSOLUTE = 1, 1
_words = types.CPointer(types.int64)
_gettime = types.ExternalFunction('clock_gettime', types.int32(types.int32, _words))
_nanosleep = types.ExternalFunction(
    'clock_nanosleep', types.int32(types.int32, types.int32, _words, _words))
_write = types.ExternalFunction('write', types.int64(types.int32, _words, types.int64))


def words() -> np.ndarray:
    """Return the memory that the calls need, (4,) int64; each thread its own."""
    return np.array([0, 0, 1, 0], np.int64)


@formula
def monotonic(words):
    """Return the steady time [ns]."""
    _gettime(_MONOTONIC, words.ctypes)
    return words[0] * NS + words[1]


@formula
def sleep_until(words, instant):
    """Sleep until an instant of the steady clock [ns], or until a signal."""
    words[0], words[1] = instant // NS, instant % NS
    _nanosleep(_MONOTONIC, _ABSOLUTE, words.ctypes, words.ctypes)


@formula
def wake(words, descriptor):
    """Wake who waits for an event descriptor."""
    _write(descriptor, words[2:].ctypes, 8)


@intrinsic
def publish_stores(typing_context):
    """Have all stores before be seen before any after; for whoever reads without a lock."""
    def code(context, builder, signature, arguments):
        builder.fence('release')
        return ir.Constant(ir.IntType(64), 0)
    return types.int64(), code
