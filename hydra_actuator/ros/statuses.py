# SPDX-License-Identifier: Apache-2.0
"""
What /diagnostics says: five statuses from counts and figures. No ROS in here.

Levels as diagnostic_msgs has them. What happens once (a missed tick, a dropped command) shows as
a warning for as long as `RECENT`, so that a listener at 1 Hz cannot fail to see it.
"""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
import gc
import time
from types import MappingProxyType

from hydra_actuator.faults.announcements import NAME, standing
from hydra_actuator.realtime.pacer import Pacer
from hydra_actuator.ros.commanders import Commanders
from hydra_actuator.ros.commands import CommandDesk
from hydra_actuator.ros.recorder import Recorder
from hydra_actuator.ros.scheduling import refusals
from hydra_actuator.ros.setpoint import Setpoint
from hydra_actuator.tally import Cavities

OK, WARN, ERROR = 0, 1, 2
RECENT = 2.0
PERCENTILES = (50.0, 99.0, 99.9)
VACUUM = 'pressure below vacuum: turn fluid.cavitation on'


@dataclass(frozen=True)
class Status:
    """One line of diagnostics: its name without the node, level, text, and values."""

    name: str
    level: int
    message: str
    values: Mapping[str, str] = field(default_factory=dict)


class OnDemand(Mapping[str, str]):
    """Values that are put together when first looked at: levels are asked for far more often."""

    def __init__(self, make: Callable[[], Mapping[str, str]]):
        self._make = make
        self._made: Mapping[str, str] | None = None

    def _values(self) -> Mapping[str, str]:
        if self._made is None:
            self._made = self._make()
        return self._made

    def __getitem__(self, name: str) -> str:
        return self._values()[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._values())

    def __len__(self) -> int:
        return len(self._values())


class Recently:
    """Tells whether a count has grown within the last RECENT seconds."""

    def __init__(self):
        self._count = 0
        self._until = 0.0

    def grew(self, count: int) -> bool:
        """Take the count as it is now."""
        now = time.monotonic()
        if count > self._count:
            self._until = now + RECENT
        self._count = count
        return now < self._until


def real_time(pacer: Pacer, period: float, missed_recently: bool) -> Status:
    """Return how well the ticks keep to their grid; durations in microseconds."""
    values = OnDemand(lambda: _punctuality(pacer, period))
    if pacer.halted:
        return Status('Real time', ERROR, 'halted after a missed tick', values)
    if missed_recently:
        return Status('Real time', WARN, f'{pacer.missed} ticks missed in all', values)
    return Status('Real time', OK, 'on time', values)


def _punctuality(pacer: Pacer, period: float) -> dict[str, str]:
    elapsed = pacer.elapsed
    factor = pacer.ticks * period / elapsed if elapsed > 0.0 else 0.0
    values = {
        'ticks': str(pacer.ticks),
        'overruns': str(pacer.missed),
        'slip': f'{pacer.slip:.6f}',
        'real_time_factor': f'{factor:.6f}',
    }
    for name, histogram in (('lateness', pacer.lateness), ('execution', pacer.execution)):
        for percent in PERCENTILES:
            values[f'{name}_p{percent:g}'] = f'{histogram.percentile(percent) / 1e3:.1f}'
        values[f'{name}_max'] = f'{histogram.maximum / 1e3:.1f}'
    return values


def scheduled(ticks: Status, setup: Mapping[str, str]) -> Status:
    """
    Return the status of the ticks with what the system grants to them; a refusal is a warning.

    setup: what scheduling was asked for and had, as `scheduling` tells it.
    """
    values = OnDemand(lambda: {**ticks.values, **setup, **collector()})
    refused = [] if ticks.level else refusals(setup)
    return Status(
        ticks.name, WARN if refused else ticks.level, '; '.join([ticks.message, *refused]), values)


def collector() -> dict[str, str]:
    """Return what the garbage collector leaves alone, and how often it went over the rest."""
    return {
        'collector_frozen_objects': str(gc.get_freeze_count()),
        'collector_full_runs': str(gc.get_stats()[-1]['collections'])}


def command(
    desk: CommandDesk, setpoint: Setpoint, on_timeout: str, rejected_recently: bool,
    commanders: Commanders,
) -> Status:
    """Return what became of the command messages, and who sends them; age in s."""
    spool_1, spool_2, load_force = setpoint.sampled
    values = {
        'received': str(desk.accepted + desk.rejections + desk.without_command),
        'accepted': str(desk.accepted),
        'applied': str(setpoint.applied),
        'clamped': str(desk.clamped),
        'rejected': str(desk.rejections),
        'without_command': str(desk.without_command),
        'last_rejection': desk.last_rejection,
        'command_age': f'{setpoint.silence:.3f}' if setpoint.commanded else 'no command yet',
        'spool_1': repr(spool_1), 'spool_2': repr(spool_2), 'load_force': repr(load_force),
    }
    values.update(
        {f'rejected: {reason}': str(count) for reason, count in list(desk.rejected.items())})
    values.update({
        f'publishers: {topic}': ', '.join(names) for topic, names in commanders.names.items()})
    if rejected_recently:
        return Status('Command', WARN, f'message dropped: {desk.last_rejection}', values)
    if commanders.rivals:
        return Status(
            'Command', WARN, f'several nodes command the valve: {", ".join(commanders.rivals)}',
            values)
    if setpoint.timed_out:
        return Status(
            'Command', WARN,
            f'no command for {setpoint.silence:.1f} s: {on_timeout}', values)
    return Status('Command', OK, 'commands are obeyed', values)


def recorder(recorder: Recorder) -> Status:
    """Return how the recording goes."""
    statistics = recorder.statistics
    if recorder.snapshots is not None:
        return _memory(recorder)
    if statistics is None:
        last = {'last_path': str(recorder.path)} if recorder.path else {}
        return Status('Recorder', OK, 'not recording', last)
    dropped = sum(statistics.dropped.values())

    def figures() -> dict[str, str]:
        values = {
            'path': str(recorder.path),
            'written': str(sum(statistics.written.values())),
            'bytes': str(recorder.size),
            'free_disk_bytes': str(recorder.free_space),
            'dropped': str(dropped),
            'waiting_bytes': str(statistics.waiting_bytes),
            'most_waiting_bytes': str(statistics.most_waiting_bytes),
            'writer_processor_time': f'{statistics.processor_time:.6f}',
        }
        values.update({
            f'dropped: {topic}': str(count) for topic, count in statistics.dropped.items()})
        return values

    values = OnDemand(figures)
    if recorder.error:
        return Status('Recorder', ERROR, recorder.error, values)
    if dropped:
        return Status('Recorder', WARN, f'{dropped} messages dropped', values)
    return Status('Recorder', OK, f'recording to {recorder.path}', values)


def _memory(recorder: Recorder) -> Status:
    """Return what is kept for snapshots, and what became of the last."""
    snapshots = recorder.snapshots
    kept = snapshots.memory.kept
    values = {
        'kept_messages': str(kept.messages), 'kept_bytes': str(kept.bytes),
        'kept_seconds': f'{kept.span:.3f}', 'snapshots': str(snapshots.written),
        'last_path': str(snapshots.path or ''),
    }
    if snapshots.error:
        return Status('Recorder', ERROR, f'no snapshot: {snapshots.error}', values)
    return Status('Recorder', OK, recorder.doing, values)


def oil(
    cavities: Cavities, vacuum_ticks: int, cavitation: bool, recently: tuple[bool, bool]
) -> Status:
    """
    Return the solver's part about boiling oil; volumes in m^3.

    recently: whether a cavity opened, whether the plain oil fell below vacuum.
    """
    if not cavitation:
        values = {'cavitation': 'off', 'ticks_below_vacuum': str(vacuum_ticks)}
        return Status('Solver', WARN, VACUUM, values) if recently[1] else (
            Status('Solver', OK, '', values))
    values = {
        'cavitation': 'on', 'cavities_open': str(cavities.open),
        'cavities_opened': str(cavities.opened), 'cavities_collapsed': str(cavities.collapsed),
        'largest_cavity_volume': f'{cavities.largest:.4g}',
    }
    if cavities.open or recently[0]:
        return Status('Solver', WARN, f'the oil boils: {cavities.open} cavities open, '
                      f'{cavities.opened} opened so far', values)
    return Status('Solver', OK, '', values)


def faults(enabled: bool = False, active: Mapping[str, object] = MappingProxyType({})) -> Status:
    """Return the faults at work, with their values."""
    level, message, values = standing(enabled, active)
    return Status(NAME, level, message, values)


def idle(state: str) -> list[Status]:
    """Return what stands for the parts that an unconfigured node does not have."""
    return [
        Status('Real time', OK, f'{state}: no ticks', collector()),
        Status('Command', OK, f'{state}: commands are ignored'),
        Status('Recorder', OK, 'not recording'),
        faults(),
    ]
