# SPDX-License-Identifier: Apache-2.0
"""
Repeat a recorded run from what the solver took, and compare the states bit by bit.

`~/applied` says which inputs held from which tick on; the parameters are the recording's own.
What is compared is the truth: joint states before any sensor, and the sections. A run that was
reset is repeated piece by piece.

Neglected: what acts beside the inputs (supply.pressure changed meanwhile, the emergency stop);
such a run differs from there on, and the verdict says why. Bits are those of one machine.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import chain
from pathlib import Path
import tempfile

from hydra_actuator.actuator import Actuator, SolverError
from hydra_actuator.channels import Channels
from hydra_actuator.errors import InputError
from hydra_actuator.parameters import load_parameters, Parameters
from hydra_actuator.recording.reader import load_recording, Recording
from hydra_actuator.recording.timeline import Piece, pieces
import numpy as np

# Orders that reach the plant beside its inputs, as events and parameter events show them.
_STOP, _SUPPLY = 'emergency stop', 'supply.pressure'


@dataclass(frozen=True)
class Verdict:
    """How many states were compared, how many differ, and the first that does, in words."""

    compared: int
    differing: int
    first: str = ''

    @property
    def identical(self) -> bool:
        """Tell whether every bit is the same."""
        return self.compared > 0 and not self.differing


@dataclass(frozen=True)
class Truth:
    """Values that a recording holds of some columns of a row; one line per stamp [ns]."""

    stamps: np.ndarray
    columns: list[int]
    values: np.ndarray


def recorded_parameters(recording: Recording) -> Parameters:
    """Return the parameters of the run; InputError where the recording has none, or others."""
    text = recording.custom_data.get('parameters')
    if not text:
        raise InputError(f'{recording.path} does not say with which parameters it ran')
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / 'parameters.yaml'
        path.write_text(text, encoding='utf-8')
        try:
            return load_parameters(path)
        except InputError as error:
            raise InputError(
                f'{recording.path}: {str(error).removeprefix(f"{path}: ")}') from None


@dataclass(frozen=True)
class Applied:
    """A piece's inputs as a command signal: each holds from its tick on."""

    piece: Piece
    step_time: float

    @property
    def duration(self) -> float:
        """Time of the last state [s]."""
        return int(self.piece.steps[-1]) * self.step_time

    def __call__(self, times: np.ndarray) -> np.ndarray:
        """Return the command (T, 3) during the steps that end at times [s]."""
        begun = np.round(times / self.step_time).astype(np.int64) - 1
        places = np.searchsorted(self.piece.changes, np.maximum(begun, 0), 'right') - 1
        return self.piece.inputs[places]


class Replay:
    """
    The run that a recording holds, ready to be repeated.

    parameters: the recording's own if None. Raises InputError for what cannot be repeated.
    """

    def __init__(self, path: str | Path, parameters: Parameters | None = None):
        self._recording = recording = load_recording(path)
        self.parameters = recorded_parameters(recording) if parameters is None else parameters
        self._actuator = Actuator(self.parameters)
        self._pieces = pieces(
            recording, self._actuator.step_time, self._actuator.steps_per_period)

    @property
    def command(self) -> Applied:
        """What was applied, as a signal; InputError for a run with a reset in it."""
        if len(self._pieces) != 1 or not len(self._pieces[0].stamps):
            raise InputError(f'{self._recording.path} is no single run: it has states of '
                             f'{len(self._pieces)}, from one reset to the next')
        return Applied(self._pieces[0], self._actuator.step_time)

    def compare(self, progress: Callable[[float], None] = lambda share: None) -> Verdict:
        """
        Repeat the run and compare its states; progress: called with the share done.

        Raises SolverError where the method breaks that did not break before.
        """
        recording = self._recording
        truths = [one for one in (_joints(recording), _sections(recording)) if len(one.stamps)]
        states = sum(len(piece.stamps) for piece in self._pieces)
        compared = differing = 0
        first = ''
        rows = (_rows(self._actuator, piece) for piece in self._pieces)
        for stamp, row in chain.from_iterable(rows):
            compared += 1
            found = next(filter(None, (_difference(one, stamp, row) for one in truths)), '')
            differing += bool(found)
            if found and not first:
                time = (stamp - int(recording.row_stamps[0])) * 1e-9
                first = f'at {time:.6f} s: {found}{_excuse(recording)}'
            progress(compared / states)
        return Verdict(compared, differing, first)


def _rows(actuator: Actuator, piece: Piece) -> Iterator[tuple[int, np.ndarray]]:
    """Run a piece from the initial state; yield each stamp with the row of its step."""
    actuator.reset()
    actuator.advance(0.0)
    now, begin = 0, np.zeros(1)
    for stamp, step in zip(piece.stamps.tolist(), piece.steps.tolist()):
        while now < step:
            change = int(np.searchsorted(piece.changes, now, 'right'))
            until = min([step, *piece.changes[change: change + 1].tolist()])
            inputs = piece.inputs[change - 1: change]
            code = actuator.follow((begin, inputs, True), until - now)
            if code:
                raise SolverError(actuator.status_message(code))
            now = until
        yield stamp, actuator.row


def _joints(recording: Recording) -> Truth:
    """Return position, velocity, effort and spools, those before the sensors where there are."""
    series = recording.series(_name(recording, '/joint_states'))
    stamps, values = series.stamps, series.numbers()
    width = values.shape[1] // 3 if len(stamps) else 2
    true = _name(recording, '/true_joint_states')
    if true and recording.topics[true].count:
        own = recording.series(true)
        at = np.isin(stamps, own.stamps)
        values = values.copy()
        values[at] = own.numbers()[np.searchsorted(own.stamps, stamps[at])]
    columns = [Channels.POSITION, Channels.VELOCITY, Channels.EFFORT,
               *(Channels.SPOOL_1, Channels.SPOOL_2)[:width - 1]]
    places = [0, width, 2 * width, *range(1, width)]
    return Truth(stamps, columns, values[:, places] if len(stamps) else np.empty((0, 0)))


def _sections(recording: Recording) -> Truth:
    """Return pressures and velocities of the sections."""
    channels = recording.channels
    columns = [*range(channels.width)]
    columns = columns[channels.pressure] + columns[channels.flow_velocity]
    name = _name(recording, '/sections')
    if not name or not recording.topics[name].count:
        return Truth(np.empty(0, np.int64), columns, np.empty((0, 0)))
    series = recording.series(name)
    numbers = series.numbers()
    return Truth(series.stamps, columns, np.hstack([numbers[:, 1::2], numbers[:, 2::2]]))


def _difference(truth: Truth, stamp: int, row: np.ndarray) -> str:
    """Return what differs at a stamp, '' if nothing does or nothing was recorded."""
    place = int(np.searchsorted(truth.stamps, stamp))
    if place == len(truth.stamps) or truth.stamps[place] != stamp:
        return ''
    recorded, got = truth.values[place], row[truth.columns]
    if recorded.tobytes() == got.tobytes():
        return ''
    column = int(np.flatnonzero(recorded.view(np.int64) != got.view(np.int64))[0])
    return f'{float(recorded[column])!r} recorded, {float(got[column])!r} replayed'


def _excuse(recording: Recording) -> str:
    """Return what acted on the run beside its inputs, as a clause."""
    texts = [status['message'] for message in recording.diagnostics
             if message['topic'].endswith('/events') for status in message['status']]
    if any(text.startswith(_STOP) for text in texts):
        return f'; there was an {_STOP}, which a replay does not repeat'
    name = _name(recording, '/parameter_events')
    changed = [one['name'] for message in (recording.messages(name) if name else ())
               for one in message['changed_parameters']]
    if _SUPPLY in changed:
        return f'; {_SUPPLY} was changed meanwhile, which a replay does not repeat'
    return ''


def _name(recording: Recording, ending: str) -> str:
    return next((name for name in recording.topics if name.endswith(ending)), '')
