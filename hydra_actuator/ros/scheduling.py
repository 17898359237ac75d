# SPDX-License-Identifier: Apache-2.0
"""
Ask Linux for punctuality, as far as it grants it; what came of each wish is told, not raised.

The thread's timer slack is set to its least: with the usual 50 us every sleep ends as much late.
Source: prctl(2), sched(7), mlockall(2).
"""

import ctypes
import os
import resource

from hydra_actuator.parameters import Parameters

_PR_SET_TIMERSLACK = 29
_MCL_CURRENT, _MCL_FUTURE = 1, 2


def prepare_thread(parameters: Parameters) -> dict[str, str]:
    """Make the calling thread a punctual one; return what was granted."""
    told = {'timer_slack': _granted(_least_timer_slack)}
    priority = parameters['timing.thread_priority']
    if priority:
        told['thread_priority'] = _granted(
            lambda: os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(priority)))
    cores = parameters['timing.cpu_affinity']
    if cores:
        told['cpu_affinity'] = _granted(lambda: os.sched_setaffinity(0, cores))
    return told


def lock_memory(parameters: Parameters) -> dict[str, str]:
    """Keep the process in RAM if that is wanted; return what was granted."""
    if not parameters['timing.lock_memory']:
        return {}
    return {'lock_memory': _granted(_lock_all_memory)}


def _granted(wish) -> str:
    """Return 'granted', or why not."""
    try:
        wish()
    except (OSError, ValueError, AttributeError) as error:
        return f'not granted: {error}'
    return 'granted'


def _least_timer_slack() -> None:
    _call('prctl', _PR_SET_TIMERSLACK, 1, 0, 0, 0)


def _lock_all_memory() -> None:
    # Under a limit, memory to come must stay unlocked, or getting any would fail one day.
    unlimited = resource.getrlimit(resource.RLIMIT_MEMLOCK)[0] == resource.RLIM_INFINITY
    _call('mlockall', _MCL_CURRENT | (_MCL_FUTURE if unlimited else 0))


def _call(function: str, *arguments: int) -> None:
    """Call the C library; OSError if it refuses."""
    library = ctypes.CDLL(None, use_errno=True)
    if getattr(library, function)(*map(ctypes.c_ulong, arguments)) != 0:
        code = ctypes.get_errno()
        raise OSError(code, f'{function}: {os.strerror(code)}')
