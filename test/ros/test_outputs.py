# SPDX-License-Identifier: Apache-2.0
"""What leaves the ring: at its rate, once, the same bytes published and recorded."""

from hydra_actuator import load_parameters
from hydra_actuator.channels import Channels
from hydra_actuator.instruments import Instruments
from hydra_actuator.recording.messages import decode, FLOAT64_ARRAY, JOINT_STATE
from hydra_actuator.recording.topics import ActuatorTopics
from hydra_actuator.ros.outputs import Outputs, Schedule
from hydra_actuator.ros.ring import Ring
from hydra_actuator.ros.watch import Watch, Watched
import numpy as np
import pytest

START = 1_700_000_000_000_000_000


@pytest.mark.parametrize('rate, count', [
    (1000.0, 1000), (20000.0, 1000), (500.0, 500), (300.0, 300), (1.0, 1), (0.0, 0), (999.0, 999)])
def test_a_rate_gives_so_many_ticks_of_a_second(rate, count):
    schedule = Schedule(rate, 1e-3)
    assert sum(schedule.due(number) for number in range(1000, 2000)) == count
    assert schedule.due(0) == (rate > 0.0)


class Outlet:
    def __init__(self, **overrides):
        parameters = load_parameters(overrides=overrides)
        self.channels = Channels(('A', 'B'), 1)
        self.topics = ActuatorTopics('/actuator', ('A', 'B'))
        self.ring = Ring(self.channels.width, 3)
        self.published, self.recorded = [], []
        topics = [*self.topics.pressure.values(), self.topics.joint_states,
                  self.topics.sections, self.topics.applied]
        instruments = Instruments(self.channels, 1e-3, 1)
        instruments.set(parameters, {})
        self.outputs = Outputs(self.ring, self.topics, instruments, {
            topic: lambda data, topic=topic: self.published.append((topic, data))
            for topic in topics}, self.recorded.extend)
        self.outputs.set_rates(parameters, 1e-3)
        self.outputs.encoder = self.outputs.encoder_for(('piston', 'valve'))

    def push(self, count, inputs=(0.0, 0.0, 0.0)):
        written = int(self.ring.memory.written[0]['ticks'])
        for number in range(written, written + count):
            row = np.arange(self.channels.width) + number
            self.ring.push(number, START + number * 1_000_000, max(0, number - 1), inputs, row)

    def of(self, topic):
        return [message for message in self.recorded if message[0] == topic]


def test_every_published_message_is_recorded_with_the_same_bytes():
    outlet = Outlet()
    outlet.push(5)
    outlet.outputs.take()
    assert [(topic, data) for topic, _, _, data in outlet.recorded] == outlet.published
    assert len(outlet.published) == 5 * (1 + 2 + 1) + 1


def test_log_time_is_the_instant_of_the_state_and_the_joint_state_goes_first():
    outlet = Outlet()
    outlet.push(3)
    outlet.outputs.take()
    states = outlet.of('/joint_states')
    assert [log for _, log, _, _ in states] == [START + n * 1_000_000 for n in range(3)]
    assert outlet.recorded[0] == states[0]
    state = decode(JOINT_STATE, states[1][3])
    assert state['name'] == ['piston', 'valve']
    assert state['position'][0] == 2.0


def test_slower_topics_leave_ticks_out_and_keep_their_own_stamps():
    outlet = Outlet(**{'publish.pressure_rate': 100.0, 'publish.sections_rate': 0.0})
    outlet.push(30)
    outlet.outputs.take()
    assert [log - START for _, log, _, _ in outlet.of('/actuator/pressure/A')] == [
        0, 10_000_000, 20_000_000]
    assert not outlet.of('/actuator/sections')
    assert len(outlet.of('/joint_states')) == 30


def test_applied_inputs_are_told_when_they_change_at_the_instant_they_act_from():
    outlet = Outlet()
    outlet.push(3)
    outlet.push(2, (0.5, 0.5, 7.0))
    outlet.push(1)
    outlet.outputs.take()
    applied = outlet.of('/actuator/applied')
    assert [list(decode(FLOAT64_ARRAY, data)['data']) for _, _, _, data in applied] == [
        [0.0, 0.0, 0.0], [2.0, 0.5, 7.0], [4.0, 0.0, 0.0]]
    assert [log - START for _, log, _, _ in applied] == [0, 2_000_000, 4_000_000]


def test_a_clock_goes_out_at_its_rate():
    outlet = Outlet(**{'publish.clock': True, 'publish.clock_rate': 500.0})
    outlet.push(10)
    outlet.outputs.take()
    assert len(outlet.of('/clock')) == 5


def test_a_publisher_that_fails_ends_the_thread_with_a_report():
    outlet = Outlet()
    reported = []
    outlet.outputs.on_error = reported.append

    def broken(data):
        raise RuntimeError('no context')
    outlet.outputs._publishers['/joint_states'] = broken
    outlet.push(1)
    outlet.outputs.start()
    outlet.outputs.stop()
    assert [str(error) for error in reported] == ['no context']


def test_a_count_that_grows_becomes_an_event_ten_times_a_second_at_most():
    now, count, events = [0.0], [5], []
    watch = Watch(
        lambda *event: events.append(event), [Watched('Part', 1, 'grew', lambda: count[0])],
        lambda: now[0])
    watch.look()
    assert not events
    count[0] = 6
    watch.look()
    count[0] = 9
    watch.look()
    now[0] = 0.05
    watch.look()
    assert events == [(1, 'Part', 'grew', {'new': '1', 'in_all': '6'})]
    now[0] = 0.11
    watch.look()
    assert events[1:] == [(1, 'Part', 'grew', {'new': '3', 'in_all': '9'})]
