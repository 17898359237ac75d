# SPDX-License-Identifier: Apache-2.0
"""
Ask Linux for punctuality, as far as it grants it; what came of each wish is told, not raised.

Of each wish NAME is told `NAME_requested`, `NAME_obtained` as the system itself says it holds
now, and, where the system would not, `NAME_refused` with the reason and the limit that stands in
the way. The thread's timer slack is set to its least: with the usual 50 us every sleep ends as
much late. Source: prctl(2), sched(7), mlockall(2), getrlimit(2).
"""

from collections.abc import Callable, Iterable, Mapping, Sequence
import ctypes
import os
from pathlib import Path
import resource
import threading

from hydra_actuator.parameters import Parameters

WISHES = ('timer_slack', 'thread_priority', 'cpu_affinity', 'lock_memory')
_REFUSED = '_refused'

_PR_SET_TIMERSLACK, _PR_GET_TIMERSLACK = 29, 30
_MCL_CURRENT, _MCL_FUTURE = 1, 2
_CAP_IPC_LOCK = 14
_POLICIES = {os.SCHED_OTHER: 'SCHED_OTHER', os.SCHED_FIFO: 'SCHED_FIFO', os.SCHED_RR: 'SCHED_RR',
             os.SCHED_BATCH: 'SCHED_BATCH', os.SCHED_IDLE: 'SCHED_IDLE'}


def prepare_thread(parameters: Parameters) -> dict[str, str]:
    """Make the calling thread a punctual one; return what was requested, obtained, refused."""
    told = _told('timer_slack', '1 ns', _least_timer_slack, timer_slack)
    priority = parameters['timing.thread_priority']
    if priority:
        told |= _told(
            'thread_priority', f'SCHED_FIFO {priority}', lambda: _set_priority(priority),
            thread_priority)
    cores = parameters['timing.cpu_affinity']
    if cores:
        told |= _told(
            'cpu_affinity', _listed(cores), lambda: _set_affinity(cores), cpu_affinity)
    return told


def lock_memory(parameters: Parameters) -> dict[str, str]:
    """Keep the process in RAM if that is wanted; return what was requested, obtained, refused."""
    if not parameters['timing.lock_memory']:
        return {}
    return _told('lock_memory', 'all memory', _lock_all_memory, locked_memory)


def refusals(told: Mapping[str, str]) -> list[str]:
    """Return one line for each wish that was not granted."""
    return [f'{wish.replace("_", " ")} refused: {told[wish + _REFUSED]}'
            for wish in WISHES if wish + _REFUSED in told]


def thread_priority() -> str:
    """Return policy and, under a real-time one, priority of the calling thread."""
    policy = os.sched_getscheduler(0)
    priority = os.sched_getparam(0).sched_priority
    return f'{_POLICIES.get(policy, policy)} {priority}' if priority else _POLICIES[policy]


def cpu_affinity() -> str:
    """Return the cores on which the calling thread may run."""
    return _listed(os.sched_getaffinity(0))


def timer_slack() -> str:
    """Return by how much the calling thread's sleeps may end late."""
    return f'{_call("prctl", _PR_GET_TIMERSLACK, 0, 0, 0, 0)} ns'


def locked_memory() -> str:
    """Return how much of the process is locked into RAM."""
    return _proc_status('VmLck')


def _told(
    name: str, requested: str, wish: Callable[[], None], obtained: Callable[[], str]
) -> dict[str, str]:
    told = {f'{name}_requested': requested}
    try:
        wish()
    except (OSError, ValueError, OverflowError) as error:
        told[name + _REFUSED] = str(error)
    told[f'{name}_obtained'] = obtained()
    return told


def _least_timer_slack() -> None:
    _call('prctl', _PR_SET_TIMERSLACK, 1, 0, 0, 0)


def _set_priority(priority: int) -> None:
    """
    Give the calling thread its priority, and all others of the process the one below.

    Whoever has the interpreter when the solver needs it must not be kept from a processor.
    """
    own, below = threading.get_native_id(), os.sched_param(max(1, priority - 1))
    try:
        os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(priority))
        for thread in map(int, os.listdir('/proc/self/task')):
            if thread != own:
                _set_if_alive(thread, below)
    except PermissionError as error:
        limit = resource.getrlimit(resource.RLIMIT_RTPRIO)[0]
        raise PermissionError(f'{error.strerror}; the limit rtprio is {_limit(limit)}') from None


def _set_if_alive(thread: int, priority: os.sched_param) -> None:
    try:
        os.sched_setscheduler(thread, os.SCHED_FIFO, priority)
    except ProcessLookupError:
        return


def _set_affinity(cores: Sequence[int]) -> None:
    # The kernel takes the cores that there are and is silent about others.
    os.sched_setaffinity(0, cores)
    lacking = set(cores) - os.sched_getaffinity(0)
    if lacking:
        raise OSError(f'not to be had: {_listed(lacking)}')


def _lock_all_memory() -> None:
    # Under a limit, memory to come must stay unlocked, or getting any would fail one day.
    limit = resource.getrlimit(resource.RLIMIT_MEMLOCK)[0]
    unlimited = limit == resource.RLIM_INFINITY or _may_lock_without_limit()
    try:
        _call('mlockall', _MCL_CURRENT | (_MCL_FUTURE if unlimited else 0))
    except OSError as error:
        raise OSError(
            f'{error.strerror}; the limit memlock is {_limit(limit)} bytes') from None


def _may_lock_without_limit() -> bool:
    return bool(int(_proc_status('CapEff'), 16) >> _CAP_IPC_LOCK & 1)


def _limit(limit: int) -> str:
    return 'unlimited' if limit == resource.RLIM_INFINITY else str(limit)


def _listed(cores: Iterable[int]) -> str:
    return ', '.join(map(str, sorted(cores)))


def _proc_status(key: str) -> str:
    """Return what the kernel says of this process under a key."""
    for line in Path('/proc/self/status').read_text().splitlines():
        if line.startswith(f'{key}:'):
            return line.partition(':')[2].strip()
    return ''


def _call(function: str, *arguments: int) -> int:
    """Call the C library; OSError if it refuses."""
    library = ctypes.CDLL(None, use_errno=True)
    answer = getattr(library, function)(*map(ctypes.c_ulong, arguments))
    if answer < 0:
        code = ctypes.get_errno()
        raise OSError(code, os.strerror(code))
    return answer
