# SPDX-License-Identifier: Apache-2.0
"""
What a demo run has to show: a table of figures, and the checks that can fail it.

The figures come from the recording; those of the listener say what arrived over DDS.
"""

from dataclasses import dataclass

from hydra_actuator.recording.reader import load_recording, Recording
from hydra_actuator.ros.demo import DemoRun
import numpy as np

# Share of the ticks that must be there, of each topic.
COMPLETE = 0.995
REAL_TIME = 0.005
# Best effort at depth 1 keeps the last of the commands that come together on a busy machine.
ARRIVED = 0.5
# A full-stroke sine moves the piston by far more than this [m].
LEAST_STROKE = 1e-3
PERIOD_NS = 1_000_000


@dataclass(frozen=True)
class Summary:
    """Lines of (name, value) and the checks that failed, as sentences."""

    lines: list[tuple[str, str]]
    failed: list[str]

    def text(self) -> str:
        """Return the table."""
        width = max(len(name) for name, _ in self.lines)
        return '\n'.join(f'{name:<{width}}  {value}' for name, value in self.lines)


def summarise(run: DemoRun) -> Summary:
    """Look at what a run left behind."""
    recording = load_recording(run.recording)
    figures = _real_time(recording)
    lines: list[tuple[str, str]] = [('node up after', f'{run.start_time:.1f} s')]
    failed: list[str] = []
    if run.exit_code:
        failed.append(f'the node ended with code {run.exit_code}')
    if not recording.finished:
        failed.append(f'{run.recording} is not finished')
    failed += [f'the listener failed: {error!r}' for error in run.errors[:1]]
    for part in (
        _timing(figures), _recorded(recording), _heard(run, recording), _motion(recording)
    ):
        lines += part.lines
        failed += part.failed
    return Summary(lines, failed)


def _real_time(recording: Recording) -> dict[str, str]:
    """Return the last values of the status `Real time`."""
    figures: dict[str, str] = {}
    for message in recording.messages('/diagnostics'):
        for status in message['status']:
            if status['name'].endswith(': Real time') and status['values']:
                figures = {one['key']: one['value'] for one in status['values']}
    return figures


def _timing(figures: dict[str, str]) -> Summary:
    if not figures:
        return Summary([], ['the recording has no real-time figures'])
    lines = [
        ('real-time factor', figures['real_time_factor']),
        ('ticks', figures['ticks']),
        ('overruns', f'{figures["overruns"]} ticks missed and caught up, '
                     f'slip {figures["slip"]} s'),
        *((f'{name} p50 / p99 / max',
           ' / '.join(figures[f'{name}_{part}'] for part in ('p50', 'p99', 'max')) + ' us')
          for name in ('lateness', 'execution')),
        ('real-time priority', figures.get('thread_priority_obtained', 'not asked for')),
    ]
    failed = []
    if abs(float(figures['real_time_factor']) - 1.0) > REAL_TIME:
        failed.append(f'real-time factor {figures["real_time_factor"]}')
    return Summary(lines, failed)


def _recorded(recording: Recording) -> Summary:
    """Compare each topic's count with the instants between first and last tick."""
    stamps = recording.row_stamps
    ticks = round((stamps[-1] - stamps[0]) / PERIOD_NS) + 1
    duration = (stamps[-1] - stamps[0]) * 1e-9
    counts = {
        name: summary.count for name, summary in recording.topics.items()
        if name.endswith('/joint_states') or '/pressure/' in name
    }
    least = min(counts, key=counts.get)
    joint_states = next(name for name in counts if name.endswith('/joint_states'))
    lines = [
        ('joint states recorded', f'{counts[joint_states] / duration:.1f} Hz'),
        (f'{len(counts) - 1} pressures recorded',
         f'{counts[least] / duration:.1f} Hz or more each'),
        ('ticks recorded', f'{100.0 * counts[least] / ticks:.2f} % or more of each topic'),
    ]
    failed = []
    if len(counts) < 13:
        failed.append(f'{len(counts) - 1} pressures, not 12')
    if counts[least] < COMPLETE * ticks:
        failed.append(f'{least} has {counts[least]} of {ticks} ticks')
    if np.any(np.diff(stamps) <= 0):
        failed.append('stamps do not increase')
    return Summary(lines, failed)


def _heard(run: DemoRun, recording: Recording) -> Summary:
    lines, failed = [], []
    for name, heard in run.heard.items():
        gaps, count = heard.gaps(PERIOD_NS), len(heard.stamps)
        rate = (count - 1) / max(1e-9, (heard.stamps[-1] - heard.stamps[0]) * 1e-9) if count else 0
        lines.append((f'{name} over DDS', f'{rate:.1f} Hz, {gaps} missing'))
        if gaps > (1.0 - COMPLETE) * (count + gaps) or not count:
            failed.append(f'{name}: {gaps} of {count + gaps} did not arrive over DDS')
    states = run.heard['joint_states']
    delay = (np.array(states.received) - np.array(states.stamps)) * 1e-3
    if len(delay):
        lines.append((
            'joint state, instant to listener',
            '{:.0f} / {:.0f} / {:.0f} us p50 / p99 / max'.format(
                *np.percentile(delay, [50.0, 99.0, 100.0]))))
    received = sum(
        summary.count for name, summary in recording.topics.items()
        if name.endswith('/spool_command'))
    lines.append(('commands sent, received', f'{run.sent}, {received}'))
    if received < ARRIVED * run.sent:
        failed.append(f'{received} of {run.sent} commands arrived')
    return Summary(lines, failed)


def _motion(recording: Recording) -> Summary:
    rows, channels = recording.rows, recording.channels
    position = rows[:, channels.POSITION]
    pressure = rows[:, channels.pressure]
    low = np.unravel_index(np.nanargmin(pressure), pressure.shape)
    high = np.unravel_index(np.nanargmax(pressure), pressure.shape)
    stroke = float(np.nanmax(position) - np.nanmin(position))
    lines = [
        ('stroke', f'{1e3 * stroke:.2f} mm, from {1e3 * np.nanmin(position):+.2f} to '
                   f'{1e3 * np.nanmax(position):+.2f} mm'),
        ('lowest pressure', f'{1e-6 * pressure[low]:.3f} MPa at station '
                            f'{channels.section_names[low[1]]}'),
        ('highest pressure', f'{1e-6 * pressure[high]:.3f} MPa at station '
                             f'{channels.section_names[high[1]]}'),
    ]
    failed = []
    if stroke < LEAST_STROKE:
        failed.append(f'the piston moved by {1e3 * stroke:.3f} mm only')
    below = float(np.mean(np.any(pressure < 0.0, axis=1)))
    if below:
        lines.append(('below vacuum', f'{100.0 * below:.2f} % of the ticks: without a model of '
                                      'cavitation, oil can be pulled'))
    if not np.all(np.isfinite(pressure)):
        failed.append('a pressure is not a number')
    return Summary(lines, failed)
