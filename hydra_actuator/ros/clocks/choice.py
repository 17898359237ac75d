# SPDX-License-Identifier: Apache-2.0
"""The clock source that `timing.mode` asks for."""

from collections.abc import Callable

from hydra_actuator.parameters import Parameters
from hydra_actuator.realtime.pacer import Pacer
from hydra_actuator.ros.clocks.free import Free
from hydra_actuator.ros.clocks.paced import Paced
from hydra_actuator.ros.clocks.slaved import Slaved
from hydra_actuator.ros.clocks.source import ClockSource
from hydra_actuator.ros.clocks.stepped import Stepped


def clock_source(parameters: Parameters) -> ClockSource:
    """Return the source that `timing.mode` names."""
    return _SOURCES[parameters['timing.mode']](parameters)


def _paced(p: Parameters) -> ClockSource:
    pacer = Pacer(p['timing.period'] / p['timing.speed'], p['timing.overrun_policy'],
                  p['timing.max_burst'])
    return Paced(p['timing.period'], pacer)


def _stepped(p: Parameters) -> ClockSource:
    period = p['timing.lockstep_period']
    return Stepped(period, period / p['timing.speed'] if p['timing.free_wheel'] else 0.0)


def _slaved(p: Parameters) -> ClockSource:
    return Slaved(p['timing.period'], p['timing.max_burst'])


def _free(p: Parameters) -> ClockSource:
    return Free(p['timing.period'])


_SOURCES: dict[str, Callable[[Parameters], ClockSource]] = {
    'realtime': _paced, 'lockstep': _stepped, 'follow_clock': _slaved, 'free_run': _free}
