# SPDX-License-Identifier: Apache-2.0
"""
All compiler options of the kernels in one place.

`contract` alone lets the compiler fuse a multiplication with an addition. Reassociation and
"no NaN" stay forbidden: results keep their bits on one machine for any split of the steps, and
a NaN stays visible. Without numba's run-time (`_nrt`) a kernel cannot allocate at all, and arrays
pass between formulas without being counted, which made the step six times faster.
"""

from numba import njit

OPTIONS = {
    'nogil': True, 'error_model': 'numpy', 'fastmath': {'contract'}, '_nrt': False}


def kernel(function):
    """Compile a function of the core that Python calls."""
    return njit(**OPTIONS)(function)


def formula(function):
    """Compile a function of the core, copied into each kernel that uses it."""
    return njit(forceinline=True, **OPTIONS)(function)
