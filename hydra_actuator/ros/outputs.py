# SPDX-License-Identifier: Apache-2.0
"""
The publishing thread: what the solver put into the ring goes out, and into the recording.

Each message is encoded once; the same bytes are published and recorded. The joint state of a
tick goes first: a controller waits for it. The log time of a message is the instant of the
state, its publish time the one at which the batch was taken from the ring. A row that is shown
again is published only; where simulated time begins anew, so does the recording.
"""

from collections import deque
from collections.abc import Callable, Iterator, Mapping
import math
import time

from hydra_actuator.channels import Channels
from hydra_actuator.instruments import Instruments
from hydra_actuator.recording import messages
from hydra_actuator.recording.tick import AppliedEncoder, FieldEncoder, TickEncoder
from hydra_actuator.recording.topics import ActuatorTopics
from hydra_actuator.ros.ring import Frame, Ring, Tick
from hydra_actuator.ros.worker import Worker
import numpy as np

Publish = Callable[[bytes], None]


class Schedule:
    """Which ticks go out: those at or next after the instants of a rate [Hz]; none at 0."""

    def __init__(self, rate: float, period: float):
        # A rate of one per tick must not lose ticks to rounding.
        self._share = min(1.0, rate * period * (1.0 + 1e-12))

    def due(self, number: int) -> bool:
        """Tell whether the tick of that number, counted from 0, goes out."""
        share = self._share
        if share >= 1.0:
            return True
        if number == 0:
            return share > 0.0
        return math.floor(number * share) != math.floor((number - 1) * share)


class Outputs:
    """
    Turns ticks and frames into messages.

    publishers: a publish function by topic; a topic without one is recorded only. on_error
    is told what happened if the thread dies, on_faults the faults at work when they may be others.
    """

    def __init__(
        self, ring: Ring, topics: ActuatorTopics, instruments: Instruments,
        publishers: Mapping[str, Publish], put_batch: Callable[[list], None],
    ):
        self.instruments = instruments
        self.on_error: Callable[[BaseException], None] = lambda error: None
        self.on_faults: Callable[[Mapping[str, object]], None] = lambda active: None
        self.after_batch: Callable[[], None] = lambda: None
        self.on_restart: Callable[[], None] = lambda: None
        self.encoder: TickEncoder | None = None
        self._coming: deque[tuple[int, tuple]] = deque()
        self._ring = ring
        self._topics = topics
        self._channels = channels = instruments.channels
        self._publishers = publishers
        self._put_batch = put_batch
        self._applied = AppliedEncoder(channels.spools)
        self._last_inputs: list[float] | None = None
        self._last_number: int | None = None
        self._field: FieldEncoder | None = None
        self._worker = Worker('outputs', self._run)

    def set_instruments(
        self, number: int, sensor: Mapping[str, object], faults: Mapping[str, object],
        remember: bool,
    ) -> None:
        """Have rows of that number and later be read so, see Instruments.set; in any thread."""
        self._coming.append((number, (sensor, faults, remember)))

    def encoder_for(self, joint_names: tuple[str, ...]) -> TickEncoder:
        """Return an encoder that names piston and spools so, to be put into `encoder`."""
        return TickEncoder(self._channels, joint_names, self._topics)

    def set_rates(
        self, parameters: Mapping[str, float], period: float, every_tick: bool = False
    ) -> None:
        """
        Take the rates of publishing, and whether there are cavities, from parameters.

        period [s]: of a tick; every_tick: joint states and /clock go out with each.
        """
        self._joint_states, self._pressures, self._sections = (
            Schedule(parameters[f'publish.{rate}'], period)
            for rate in ('rate', 'pressure_rate', 'sections_rate'))
        clock_rate = parameters['publish.clock_rate'] if parameters['publish.clock'] else 0.0
        self._clock = Schedule(clock_rate, period)
        if every_tick:
            self._joint_states = self._clock = Schedule(1.0 / period, period)
        self._period_ns = round(period * 1e9)
        self._boils = parameters['fluid.cavitation']

    def start(self) -> None:
        """Begin publishing."""
        self._worker.start()

    def stop(self) -> None:
        """Publish what is in the ring, then end the thread."""
        self._worker.stop(self._ring.signal)

    def forget_inputs(self) -> None:
        """Have the next tick say what was applied, changed or not."""
        self._last_inputs = None

    def _run(self) -> None:
        try:
            while not self._worker.stopping:
                self._ring.wait(0.1)
                self.take()
            self.take()
        except Exception as error:
            self.on_error(error)

    def take(self) -> None:
        """Publish and record all that is new in the ring; by others only while stopped."""
        now = time.time_ns()
        recorded = []
        for tick in self._ring.ticks():
            again = self._note(tick.number)
            for topic, log, data in self._messages(tick):
                self._publish(topic, data)
                if not again:
                    recorded.append((topic, log, now, data))
        for frame in self._ring.frames():
            data = self._encode_frame(frame)
            self._publish(self._topics.field, data)
            recorded.append((self._topics.field, frame.stamp, now, data))
        if recorded:
            self._put_batch(recorded)
        self.after_batch()

    def _note(self, number: int) -> bool:
        """Tell whether a tick is shown again; begin anew where it is the first once more."""
        last, self._last_number = self._last_number, number
        if number == 0 and last:
            self._set_instruments(last + 1)
            self.forget_inputs()
            self.on_restart()
        return number == last

    def _publish(self, topic: str, data: bytes) -> None:
        publish = self._publishers.get(topic)
        if publish is not None:
            publish(data)

    def _messages(self, tick: Tick) -> Iterator[tuple[str, int, bytes]]:
        """Yield (topic, log time, message) of a tick, each encoded when its turn comes."""
        number, stamp, row, encoder = tick.number, tick.stamp, tick.row, self.encoder
        self._set_instruments(number)
        instruments = self.instruments
        reading = instruments.read(row)
        if self._joint_states.due(number):
            yield self._topics.joint_states, stamp, encoder.joint_state(reading, stamp)
            if instruments.acting:
                yield self._topics.true_joint_states, stamp, encoder.joint_state(row, stamp)
        if self._pressures.due(number):
            for topic, data in encoder.pressures(reading, stamp, instruments.variance):
                yield topic, stamp, data
        if self._sections.due(number):
            yield self._topics.sections, stamp, encoder.sections(row, stamp)
            if self._boils:
                yield self._topics.cavities, stamp, encoder.cavities(row, stamp)
        if self._clock.due(number):
            yield self._topics.clock, stamp, messages.clock(stamp)
        # A reset begins with what holds, said anew.
        if tick.inputs != self._last_inputs or row[Channels.TIME] == 0.0:
            yield self._encode_inputs(tick)

    def _set_instruments(self, number: int) -> None:
        """Set the instruments to what holds from this row on."""
        while self._coming and self._coming[0][0] <= number:
            sensor, faults, remember = self._coming.popleft()[1]
            self.instruments.set(sensor, faults, remember)
            self.on_faults(faults)

    def _encode_inputs(self, tick: Tick) -> tuple[str, int, bytes]:
        """Return what the solver took, at the instant from which it held."""
        self._last_inputs = tick.inputs
        spools, load_force = tick.inputs[:self._channels.spools], tick.inputs[2]
        data = self._applied.encode(tick.tick, spools, load_force)
        since = tick.stamp - self._period_ns if tick.row[Channels.TIME] else tick.stamp
        return self._topics.applied, since, data

    def _encode_frame(self, frame: Frame) -> bytes:
        if self._field is None:
            self._field = FieldEncoder(len(frame.values))
        return self._field.encode(frame.time, np.ascontiguousarray(frame.values))
