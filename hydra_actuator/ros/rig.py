# SPDX-License-Identifier: Apache-2.0
"""
What a configured node has: actuator, plant, topics, recording; made whole, taken apart whole.

                               ClockSource (when to tick)
                                      |
    commands -> Inbox -> Setpoint -> Plant (solver thread) -> Ring -> Outputs -> topics
                  |                                                      |
                  +---------------------> Recorder <--------------------+
"""

from collections.abc import Callable
import gc
import time

from hydra_actuator.actuator import Actuator
from hydra_actuator.instruments import Instruments
from hydra_actuator.parameters import Parameters
from hydra_actuator.recording.errors import RecordingError
from hydra_actuator.recording.messages import parameter_event
from hydra_actuator.recording.run_data import run_data
from hydra_actuator.recording.topics import ActuatorTopics
from hydra_actuator.ros.clocks.choice import clock_source
from hydra_actuator.ros.clocks.paced import Paced
from hydra_actuator.ros.commands import CommandDesk, CommandRules
from hydra_actuator.ros.diagnostics import Reports
from hydra_actuator.ros.grid_loop import GridLoop
from hydra_actuator.ros.inbox import COMMAND_QOS, Inbox, LOCKSTEP_QOS
from hydra_actuator.ros.outputs import Outputs
from hydra_actuator.ros.plant import Plant
from hydra_actuator.ros.publishing import Publishers
from hydra_actuator.ros.recorder import Recorder
from hydra_actuator.ros.rig_faults import RigFaults
from hydra_actuator.ros.ring import Ring
from hydra_actuator.ros.scheduling import lock_memory, prepare_thread
from hydra_actuator.ros.setpoint import Setpoint
from hydra_actuator.ros.statuses import ERROR, Status
from hydra_actuator.ros.vitals import Vitals
from hydra_actuator.ros.watch import Watch
from rclpy.node import Node

# Longest wait [s] for the last messages before a reset to be taken.
_PATIENCE = 1.0


class Rig:
    """
    A configured actuator, still until `start`.

    on_failure: called in some thread when the plant cannot go on or a thread has died;
    `failure` then says why.
    """

    def __init__(
        self, node: Node, parameters: Parameters, reports: Reports,
        on_failure: Callable[[], None],
    ):
        """Compile, allocate, connect, begin to record; whatever fails leaves nothing behind."""
        self.parameters = parameters
        self.paused = False
        self.failure = ''
        self.setup = lock_memory(parameters)
        self._node = node
        self._reports = reports
        self._on_failure = on_failure
        self.actuator = Actuator(parameters)
        self._build_plant()
        # A full collection would stop all threads for tens of milliseconds. What is made from
        # here on is little, and a recording that is open should have to wait for nothing.
        gc.collect()
        gc.freeze()
        self.topics = ActuatorTopics(
            node.get_fully_qualified_name(), parameters['sections.names'])
        for attribute, name in reports.topics.items():
            setattr(self.topics, attribute, name)
        self._publishers = Publishers(node)
        self.inbox = Inbox(
            node, self.desk, self.setpoint, lambda *message: self.recorder.put(*message),
            self.clock.log_time, LOCKSTEP_QOS if self.clock.answers else COMMAND_QOS)
        try:
            self._publishers.create(parameters, self.topics, self.clock.answers)
            self.clock.connect(node)
            self.inbox.subscribe(self.topics)
            self._open_recording()
        except Exception:
            self._disconnect()
            raise
        self._vitals = Vitals(
            self.actuator, self.clock, self.inbox, self.setpoint, self._ring, self.recorder,
            self._publishers)
        self._vitals.setup = self.setup
        self._build_outputs()
        reports.log_time = self.clock.log_time
        reports.keep = self.recorder.put
        reports.notice = self.recorder.notice

    def start(self) -> None:
        """Begin to tick, with command 0."""
        self.paused = False
        self.failure = ''
        self.setpoint.centre()
        self.inbox.start()
        self.outputs.start()
        self.plant.start()

    def stop(self) -> None:
        """Stop after the tick, publish what there is, then be silent; the state stays."""
        self.plant.stop()
        self.inbox.stop()
        self.clock.forget()
        self.outputs.stop()

    def pause(self) -> None:
        """Stop ticking; commands are still taken, for `step`."""
        self.paused = True
        self.plant.stop()
        self.outputs.stop()

    def resume(self) -> None:
        """Tick again after a pause, with command 0."""
        self.paused = False
        self.setpoint.centre()
        self.outputs.start()
        self.plant.start()

    def step(self) -> bool:
        """Run one period and publish it, paused only; False if the solver failed."""
        done = self.plant.step()
        self.outputs.take()
        if not done:
            self._fail(self.plant.failure)
        return done

    def reset(self) -> bool:
        """Return to the initial state; False if the plant did not get round to it."""
        done = self.plant.reset()
        if self.paused:
            self.outputs.take()
        # What comes after the answer belongs into the recording that begins with a reset.
        return done and self._ring.is_read(_PATIENCE)

    def record(self) -> None:
        """Begin a recording, complete from the next tick on; raises RecordingError."""
        self.recorder.open()
        self.outputs.forget_inputs()

    def change(self, changes: dict[str, object]) -> None:
        """Take live parameters, all between the same two ticks, and record that they changed."""
        self.parameters = new = self.parameters.replace(changes)
        rules = CommandRules.of(new)
        encoder = self.outputs.encoder_for(_joint_names(new))
        fault = self.faults.check(changes)

        def apply() -> None:
            self.desk.rules = rules
            self.setpoint.set_timeout(self._timeout(new), new['command.on_timeout'])
            self.outputs.encoder = encoder
            self.actuator.supply.pressure = new['supply.pressure']
            self.faults.take(fault, changes)

        self.plant.order(apply)
        now = time.time_ns()
        stamp = self.clock.log_time(now)
        table = new.table
        data = parameter_event(stamp, self._node.get_fully_qualified_name(), [
            (name, table[name].type, new[name]) for name in changes])
        self.recorder.put(self.topics.parameter_events, stamp, now, data)

    def close(self) -> bool:
        """Stop, end the recording, give up all topics; False if the recording is incomplete."""
        self.stop()
        complete = self.recorder.close()
        self._reports.keep = self._reports.notice = lambda *message: None
        self._reports.log_time = lambda system_time: system_time
        self._disconnect()
        return complete

    def oil(self) -> Status:
        """Return whether the oil boils, or would."""
        return self._vitals.oil(self.parameters)

    def statuses(self) -> list[Status]:
        """Return what diagnostics say, but for the state of the solver."""
        return self._vitals.statuses(self.parameters)

    def _build_plant(self) -> None:
        p, actuator = self.parameters, self.actuator
        self.clock = clock_source(p)
        self.desk = CommandDesk(CommandRules.of(p))
        self.setpoint = Setpoint(self._timeout(p), p['command.on_timeout'])
        self.setpoint.on_command = self.clock.command
        self._ring = Ring(actuator.channels.width, len(actuator.field_labels))
        field = p['recording.enabled'] or p['publish.field']
        self.plant = Plant(
            actuator, self.clock, self.setpoint, self._ring,
            p['recording.field_rate'] if field else 0.0)
        if isinstance(self.clock, Paced):
            self.plant.loop = GridLoop(
                actuator, self.clock, self.setpoint, self._ring, self.plant.frames_per_tick)
        self.plant.prepare_thread = lambda: self.setup.update(prepare_thread(p))
        self.plant.on_failure = lambda: self._fail(self.plant.failure)

    def _build_outputs(self) -> None:
        actuator = self.actuator
        periods = round(self.clock.period / actuator.period)
        instruments = Instruments(
            actuator.channels, actuator.step_time, periods * actuator.steps_per_period)
        self.outputs = Outputs(
            self._ring, self.topics, instruments, self._publishers.publish,
            self.recorder.put_batch)
        self.outputs.set_rates(self.parameters, self.clock.period, self.clock.answers)
        self.outputs.encoder = self.outputs.encoder_for(_joint_names(self.parameters))
        self.outputs.on_error = lambda error: self._fail(f'publishing: {error!r}')
        self.outputs.on_restart = self._record_anew
        # What holds stands in each new file and each snapshot as well.
        self.recorder.restate = self.outputs.forget_inputs
        self.recorder.on_event = self._reports.event
        self.faults = RigFaults(
            self.actuator, self.plant, self.outputs, self._reports.event,
            lambda: self.parameters)
        self.outputs.after_batch = Watch(self._reports.event, self._vitals.watched()).look

    def _open_recording(self) -> None:
        self.recorder = Recorder(
            self._node.get_fully_qualified_name(), self.parameters,
            self.topics.all(), self._run_data())
        if self.parameters['recording.enabled']:
            self.recorder.open()

    def _run_data(self) -> dict[str, str]:
        actuator = self.actuator
        return run_data(
            'node', self.parameters.as_yaml(), actuator.section_positions,
            actuator.field_positions, actuator.field_labels)

    def _record_anew(self) -> None:
        """Begin the recording of a simulated time that begins anew, in the publishing thread."""
        try:
            self.recorder.begin_anew()
        except RecordingError as error:
            self._reports.event(ERROR, 'Recorder', f'no new recording: {error}')
        self.faults.announce_anew()

    def _timeout(self, parameters: Parameters) -> float:
        """Return the silence that counts: where each command is a tick, there is none."""
        return 0.0 if self.clock.answers else parameters['command.timeout']

    def _disconnect(self) -> None:
        gc.unfreeze()
        self.clock.disconnect()
        self.inbox.destroy()
        self._publishers.destroy()

    def _fail(self, reason: str) -> None:
        self.failure = self.failure or reason
        self._on_failure()


def _joint_names(parameters: Parameters) -> tuple[str, ...]:
    return (parameters['command.piston_joint'], *CommandRules.of(parameters).valve_joints)
