# SPDX-License-Identifier: Apache-2.0
"""Many processes that need the same kernels: one compiles, the others wait and load them."""

from contextlib import ExitStack
import fcntl

from hydra_actuator.actuator import Actuator
from hydra_actuator.kernels import cache_root
from hydra_actuator.parameters import Parameters
from hydra_actuator.parameters.table_hydraulics import LINES

# The kinds of actuators that this process has made: their kernels are in memory.
_made: set[tuple] = set()


def compile_once(parameters: Parameters) -> None:
    """
    Make an actuator if it is this process's first of its kind, one process at a time.

    The first of a machine compiles the kernels that all others then load, if they share a cache.
    """
    kind = (parameters['solver.iterations'], parameters['fluid.cavitation'],
            parameters['fault.enabled'],
            any(parameters[f'{line}.friction'] in ('steady', 'unsteady') for line in LINES))
    if kind in _made:
        return
    with ExitStack() as stack:
        try:
            cache_root().mkdir(parents=True, exist_ok=True)
            lock = stack.enter_context(open(cache_root() / _lock_name(kind), 'w'))
            fcntl.flock(lock, fcntl.LOCK_EX)
        except OSError:
            # Nowhere to keep kernels: each compiles its own.
            pass
        Actuator(parameters)
    _made.add(kind)


def _lock_name(kind: tuple) -> str:
    return f'first-{"-".join(str(int(part)) for part in kind)}.lock'
