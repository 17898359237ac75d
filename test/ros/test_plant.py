# SPDX-License-Identifier: Apache-2.0
"""The solver's thread: stamps, causality, orders, failure; on an actuator that only counts."""

import threading
import time

from hydra_actuator.faults import Faults
from hydra_actuator.parameters import Parameters
from hydra_actuator.realtime.pacer import Pacer
from hydra_actuator.ros.clocks.paced import Paced
from hydra_actuator.ros.plant import Plant
from hydra_actuator.ros.ring import Ring
from hydra_actuator.ros.setpoint import Setpoint
from hydra_actuator.supply import Supply
import numpy as np
import pytest

PERIOD = 2e-3
PERIOD_NS = 2_000_000


class Counter:
    """An actuator whose row is its tick and what it was told; fails at a chosen tick."""

    period = PERIOD
    parameters = Parameters()

    def __init__(self, fails_at=None):
        self.faults = Faults(self.parameters)
        self.supply = Supply(20e6, 0.0, self.period)
        self.row = np.zeros(4)
        self.tick = 0
        self.supplies = []
        self._fails_at = fails_at

    @property
    def time(self):
        return self.tick * self.period

    def tick_once(self, *inputs):
        self.tick += 1
        self.supplies.append(self.supply.tick())
        self.row[:] = (self.tick, *inputs)
        return 3 if self.tick == self._fails_at else 0

    def status_message(self, code):
        return f'status {code}'

    def read_field(self, out):
        out[:] = self.tick

    def reset(self):
        self.tick = 0

    def advance(self, duration):
        self.row[:] = 0.0


class Bench:
    def __init__(self, actuator=None, policy='burst', field_rate=0.0):
        self.actuator = actuator or Counter()
        self.setpoint = Setpoint()
        self.pacer = Pacer(PERIOD, policy, 5)
        self.ring = Ring(4, 2)
        self.plant = Plant(
            self.actuator, Paced(PERIOD, self.pacer), self.setpoint, self.ring, field_rate)
        self.failed = threading.Event()
        self.plant.on_failure = self.failed.set
        self.ticks = []

    def until(self, reached):
        end = time.monotonic() + 20.0
        while not reached():
            assert time.monotonic() < end
            self.ticks += self.ring.ticks()
            time.sleep(1e-3)
        self.ticks += self.ring.ticks()

    def run(self, ticks):
        wanted = self.pacer.ticks + ticks
        self.plant.start()
        self.until(lambda: self.pacer.ticks >= wanted)
        self.plant.stop()
        self.ticks += self.ring.ticks()

    @property
    def stamps(self):
        return np.array([tick.stamp for tick in self.ticks])


def test_initial_state_comes_first_and_ticks_follow_one_period_apart():
    bench = Bench()
    before = time.time_ns()
    bench.run(20)
    assert [tick.row[0] for tick in bench.ticks] == list(range(len(bench.ticks)))
    slip = round(bench.pacer.slip * 1e9)
    assert bench.stamps[-1] - bench.stamps[0] == (len(bench.ticks) - 1) * PERIOD_NS + slip
    assert before <= bench.stamps[0] <= time.time_ns()


def test_a_second_start_goes_on_with_the_state_and_later_stamps():
    bench = Bench()
    bench.run(5)
    done, last = bench.actuator.tick, bench.stamps[-1]
    bench.ticks.clear()
    bench.run(5)
    assert bench.ticks[0].row[0] == done + 1
    assert bench.stamps[0] >= last + PERIOD_NS


def test_a_command_acts_from_the_tick_after_the_one_that_found_it():
    bench = Bench()
    bench.setpoint.accept((0.5, 0.5))
    bench.setpoint.accept_load(7.0)
    bench.plant.start()
    bench.until(lambda: bench.pacer.ticks >= 3)
    bench.setpoint.accept((-0.5, -0.5))
    wanted = bench.pacer.ticks + 4
    bench.until(lambda: bench.pacer.ticks >= wanted)
    bench.plant.stop()
    bench.ticks += bench.ring.ticks()
    told = [tuple(tick.row[1:]) for tick in bench.ticks[1:]]
    assert told[0] == (0.5, 0.5, 7.0)
    assert told[-1] == (-0.5, -0.5, 7.0)
    assert set(told) == {told[0], told[-1]}
    # The ring says with each row what was held, and from which tick on.
    for tick in bench.ticks[1:]:
        assert tick.inputs == tick.row[1:]
        assert tick.tick == tick.row[0] - 1


def test_a_reset_while_running_takes_one_tick_and_stamps_go_on():
    bench = Bench()
    bench.plant.start()
    bench.until(lambda: bench.pacer.ticks >= 5)
    bench.setpoint.accept((1.0, 1.0))
    bench.setpoint.accept_load(9.0)
    assert bench.plant.reset()
    wanted = bench.pacer.ticks + 5
    bench.until(lambda: bench.pacer.ticks >= wanted)
    bench.plant.stop()
    bench.ticks += bench.ring.ticks()
    rows = [tick.row for tick in bench.ticks]
    start = max(k for k, row in enumerate(rows) if row[0] == 0.0)
    assert start > 0
    assert rows[start + 1] == [1.0, 0.0, 0.0, 9.0]
    assert np.all(np.diff(bench.stamps) >= PERIOD_NS)
    slip = round(bench.pacer.slip * 1e9)
    assert bench.stamps[-1] - bench.stamps[0] == (len(rows) - 1) * PERIOD_NS + slip


def test_a_failing_tick_ends_the_run_and_its_row_is_never_seen():
    bench = Bench(Counter(fails_at=4))
    bench.plant.start()
    assert bench.failed.wait(20.0)
    bench.plant.stop()
    assert [tick.row[0] for tick in bench.ring.ticks()] == [0.0, 1.0, 2.0, 3.0]
    assert bench.plant.failure == 'status 3'


def test_an_exception_in_the_solver_is_a_failure_with_its_traceback():
    class Broken(Counter):
        def tick_once(self, *inputs):
            raise ZeroDivisionError('of all things')

    bench = Bench(Broken())
    bench.plant.start()
    assert bench.failed.wait(20.0)
    assert 'of all things' in bench.plant.failure


def test_a_missed_tick_under_halt_is_a_failure():
    class Slow(Counter):
        def tick_once(self, *inputs):
            time.sleep(2.5 * PERIOD)
            return super().tick_once(*inputs)

    bench = Bench(Slow(), policy='halt')
    bench.plant.start()
    assert bench.failed.wait(20.0)
    assert 'halt' in bench.plant.failure
    assert bench.pacer.missed >= 1


def test_a_step_is_one_period_stamped_one_period_later():
    bench = Bench()
    bench.run(3)
    done, last = bench.actuator.tick, bench.stamps[-1]
    assert bench.plant.step()
    assert bench.plant.step()
    steps = list(bench.ring.ticks())
    assert [tick.row[0] for tick in steps] == [done + 1, done + 2]
    assert [tick.stamp - last for tick in steps] == [PERIOD_NS, 2 * PERIOD_NS]


def test_disabled_the_valve_is_centred_and_the_supply_ramps_down():
    bench = Bench()
    bench.plant.start()
    bench.until(lambda: bench.pacer.ticks >= 2)
    bench.setpoint.accept_load(4.0)
    assert bench.plant.set_enabled(False)
    bench.setpoint.accept((1.0, 1.0))
    bench.until(lambda: 0.0 in bench.actuator.supplies)
    assert bench.plant.set_enabled(True)
    bench.until(lambda: 20e6 in bench.actuator.supplies)
    bench.plant.stop()
    bench.ticks += bench.ring.ticks()
    assert {tuple(tick.row[1:3]) for tick in bench.ticks} == {(0.0, 0.0)}
    assert bench.ticks[-1].row[3] == 4.0


@pytest.mark.parametrize('rate, every', [(500.0, 1), (250.0, 2), (100.0, 5), (9000.0, 1)])
def test_field_comes_at_its_rate_with_the_stamps_of_its_ticks(rate, every):
    bench = Bench(field_rate=rate)
    bench.run(20)
    frames = list(bench.ring.frames())
    assert [int(frame.values[0, 0]) for frame in frames] == [
        tick.row[0] for tick in bench.ticks[::every]]
    assert [frame.stamp for frame in frames] == [tick.stamp for tick in bench.ticks[::every]]


def test_orders_are_carried_out_between_ticks_even_when_stopped():
    bench = Bench()
    done = []
    assert bench.plant.order(lambda: done.append('still'))
    bench.plant.start()
    assert bench.plant.order(lambda: done.append(threading.current_thread().name))
    bench.plant.stop()
    assert done == ['still', 'solver']
