# SPDX-License-Identifier: Apache-2.0
"""
What a running actuator looks like in a terminal: bars and tables, drawn by rich.

    snapshot (plain numbers) -> view -> what a terminal shows

Knows no ROS: a snapshot can be made of anything. What matters most comes first, since a terminal
that is too small shows the beginning.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from datetime import datetime

from rich.console import Console, ConsoleOptions, Group, RenderableType, RenderResult
from rich.panel import Panel
from rich.progress_bar import ProgressBar
from rich.table import Table
from rich.text import Text

MEGAPASCAL, MILLI, KILO = 1e-6, 1e3, 1e-3
BLOCKS = ' ▁▂▃▄▅▆▇█'
HISTORY = 40            # positions kept for the line beside the position
EVENTS = 5              # last events shown
STILL = 1e-6            # [m] that the line spans at least: a piston at rest is a flat line
OLD = 1.0               # [s] after which a state is no news
EPOCH = 1e8             # [s] from which on a stamp is a date, not simulated time
WIDE = 120              # columns from which on there are two halves side by side
STYLES = {0: 'green', 1: 'yellow', 2: 'red', 3: 'red'}
# Of the many values of each status, those that tell how it goes: name, how it is said.
TOLD = {
    'Real time': (('real_time_factor', '{} x real time'), ('lateness_p99', 'p99 {} us late')),
    'Command': (('accepted', '{} accepted'), ('rejected', '{} rejected')),
    'Recorder': (('written', '{} written'), ('dropped', '{} dropped')),
    'Solver': (('courant', 'Courant {}'), ('resets', '{} resets')),
}


@dataclass(frozen=True)
class Status:
    """One line of diagnostics: level, text, and values by name."""

    level: int
    message: str
    values: Mapping[str, str] = field(default_factory=dict)


@dataclass
class Snapshot:
    """
    What was last heard of an actuator; position None: no state yet. SI, absolute pressures.

    sought: what is listened to, and where; present: whether anybody publishes it; others: the
    actuators that are here; events: (stamp [s], level, text), oldest first; top: the highest
    pressure so far.
    """

    node: str
    sought: str = ''
    present: bool = False
    others: Sequence[str] = ()
    stamp: float | None = None
    position: float | None = None
    velocity: float = 0.0
    effort: float = 0.0
    spools: tuple[float, ...] = ()
    age: float = 0.0
    sections: tuple[tuple[str, float, float], ...] = ()
    top: float = 0.0
    statuses: dict[str, Status] = field(default_factory=dict)
    events: Sequence[tuple[float, int, str]] = ()
    history: Sequence[float] = ()


class Halves:
    """Two halves side by side where the terminal is wide, else one below the other."""

    def __init__(self, left: Sequence[RenderableType], right: Sequence[RenderableType]):
        """Take what stands in each; on a narrow terminal: left[0], right[0], left[1], ..."""
        self._left, self._right = left, right

    def __rich_console__(self, console: Console, options: ConsoleOptions) -> RenderResult:
        """Draw as wide as there is room."""
        if options.max_width >= WIDE - 4:
            both = Table.grid(padding=(0, 4))
            both.add_column(no_wrap=True)
            both.add_column(ratio=1)
            both.add_row(Group(*self._left), Group(*self._right))
            yield both
            return
        for k in range(max(len(self._left), len(self._right))):
            yield from self._left[k:k + 1]
            yield from self._right[k:k + 1]


def view(snapshot: Snapshot) -> RenderableType:
    """Return a snapshot as something rich can print."""
    if snapshot.position is None:
        return Panel(Group(*_waiting(snapshot)), title=snapshot.node, border_style='yellow')
    late = snapshot.age > OLD
    title = f'{snapshot.node}   {instant(snapshot.stamp)}'
    if late:
        gone = '' if snapshot.present else ', and the node is gone'
        title += f'   silent for {snapshot.age:.1f} s{gone}'
    left = [_piston(snapshot)]
    if snapshot.sections:
        left.append(_sections(snapshot))
    right = [_statuses(snapshot), _events(snapshot)]
    return Panel(Halves(left, right), title=title, border_style='yellow' if late else 'none')


def _waiting(snapshot: Snapshot) -> Iterator[RenderableType]:
    """Return what is waited for, and what is there instead."""
    yield Text(f'waiting for {snapshot.sought}', style='bold yellow')
    if snapshot.present:
        yield Text('The node is there and has not said a state yet: is it active?')
    else:
        yield Text('Nobody publishes there yet.')
    others = [name for name in snapshot.others if name != snapshot.node]
    if others:
        yield Text(f'Actuators here: {", ".join(others)}')
    if snapshot.statuses:
        yield _statuses(snapshot)


def _piston(snapshot: Snapshot) -> Table:
    """Return position, velocity, force and spools, and where the piston has been."""
    table = Table.grid(padding=(0, 2))
    table.add_column(style='bold', no_wrap=True)
    table.add_column(justify='right', no_wrap=True)
    table.add_column(no_wrap=True)
    table.add_row('position', f'{snapshot.position * MILLI:+z.3f} mm',
                  Text(sparkline(snapshot.history), style='cyan'))
    table.add_row('velocity', f'{snapshot.velocity:+z.4f} m/s', _range(snapshot.history))
    table.add_row('force', f'{snapshot.effort * KILO:+z.3f} kN', '')
    for k, spool in enumerate(snapshot.spools):
        name = 'spool' if len(snapshot.spools) == 1 else f'spool {k + 1}'
        table.add_row(name, f'{spool * MILLI:+z.4f} mm', '')
    return table


def _range(positions: Sequence[float]) -> Text:
    """Return between what the line above it is drawn."""
    if not positions:
        return Text()
    low, high = min(positions) * MILLI, max(positions) * MILLI
    return Text(f'seen {low:+z.3f} to {high:+z.3f} mm', style='dim')


def _sections(snapshot: Snapshot) -> Table:
    """Return pressure and velocity of the sections, pressures as bars of one steady scale."""
    table = Table(box=None, pad_edge=False)
    table.add_column('section', style='bold', no_wrap=True)
    table.add_column('pressure', justify='right', no_wrap=True)
    table.add_column(f'0 to {snapshot.top * MEGAPASCAL:.1f} MPa', width=28, style='dim')
    table.add_column('velocity', justify='right', no_wrap=True)
    for name, pressure, velocity in snapshot.sections:
        bar = ProgressBar(total=max(snapshot.top, 1.0), completed=max(pressure, 0.0), width=28,
                          complete_style='blue', finished_style='blue')
        number = Text(f'{pressure * MEGAPASCAL:.3f} MPa', style='red' if pressure < 0.0 else '')
        table.add_row(name, number, bar, f'{velocity:+z.3f} m/s')
    return table


def _statuses(snapshot: Snapshot) -> Table:
    """Return what the node's diagnostics say, worst first."""
    table = Table.grid(padding=(0, 2))
    table.add_column(style='bold', no_wrap=True)
    table.add_column()
    for name, status in sorted(snapshot.statuses.items(), key=lambda item: -item[1].level):
        text = Text(status.message, style=STYLES.get(status.level, 'red'))
        told = [how.format(status.values[key]) for key, how in TOLD.get(name, ())
                if status.values.get(key)]
        if told:
            text.append(f'  {", ".join(told)}', style='default')
        table.add_row(name, text)
    return table


def _events(snapshot: Snapshot) -> RenderableType:
    """Return the last events, newest first."""
    table = Table.grid(padding=(0, 2))
    table.add_column(justify='right', no_wrap=True, style='dim')
    table.add_column()
    for stamp, level, text in list(snapshot.events)[:-EVENTS - 1:-1]:
        table.add_row(instant(stamp), Text(text, style=STYLES.get(level, 'red')))
    return table


def instant(stamp: float) -> str:
    """Return a stamp [s] as the time of day, or, if it is simulated, in seconds."""
    if stamp < EPOCH:
        return f't = {stamp:.3f} s'
    return datetime.fromtimestamp(stamp).isoformat(' ', 'milliseconds')[11:]


def sparkline(values: Sequence[float]) -> str:
    """Return positions [m] as a line of blocks between their lowest and their highest."""
    if not values:
        return ''
    low, high = min(values), max(values)
    span = high - low
    if span < STILL:
        return BLOCKS[4] * len(values)
    return ''.join(BLOCKS[1 + round((value - low) / span * (len(BLOCKS) - 2))]
                   for value in values)
