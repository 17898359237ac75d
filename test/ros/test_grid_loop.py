# SPDX-License-Identifier: Apache-2.0
"""The plant in real time: the compiled loop does what the plant would, and lets it do the rest."""

import threading
import time

from hydra_actuator.actuator import Actuator
from hydra_actuator.parameters import Parameters
from hydra_actuator.realtime.pacer import Pacer
from hydra_actuator.ros.clocks.paced import Paced
from hydra_actuator.ros.grid_loop import GridLoop
from hydra_actuator.ros.plant import Plant
from hydra_actuator.ros.ring import Ring
from hydra_actuator.ros.setpoint import Setpoint
import numpy as np
import pytest

PERIOD = 2e-3
PERIOD_NS = 2_000_000
VALUES = {'timing.period': PERIOD, 'solver.cells': 40}


class Bench:
    def __init__(self, policy='burst', **changes):
        self.actuator = actuator = Actuator(Parameters({**VALUES, **changes}))
        self.pacer = Pacer(PERIOD, policy, 5)
        self.clock = Paced(PERIOD, self.pacer)
        self.setpoint = Setpoint()
        self.ring = Ring(actuator.channels.width, len(actuator.field_labels))
        self.plant = Plant(actuator, self.clock, self.setpoint, self.ring, 50.0)
        self.plant.loop = self.loop = GridLoop(
            actuator, self.clock, self.setpoint, self.ring, self.plant.frames_per_tick)
        self.failed = threading.Event()
        self.plant.on_failure = self.failed.set
        self.python_ticks = 0
        self._wait = self.clock.wait
        self.clock.wait = self._count

    def _count(self):
        self.python_ticks += 1
        return self._wait()

    def until_ticks(self, more):
        wanted, end = self.pacer.ticks + more, time.monotonic() + 60.0
        while self.pacer.ticks < wanted:
            assert time.monotonic() < end and not self.failed.is_set()
            time.sleep(1e-3)

    def stopped(self):
        self.plant.stop()
        assert self.ring.lost == 0
        return list(self.ring.ticks())


def assert_solved(bench, ticks):
    """Each row is what an actuator of its own gives for the inputs that stand beside it."""
    other = Actuator(bench.actuator.parameters)
    for tick in ticks[1:]:
        if tick.row[0] == 0.0:
            other.reset()
            continue
        assert other.tick == tick.tick
        other.tick_once(*tick.inputs)
        assert other.row.tolist() == tick.row


def test_rows_have_the_bits_stamps_the_grid_and_commands_act_from_the_next_tick_on():
    bench = Bench()
    bench.plant.start()
    bench.until_ticks(20)
    bench.setpoint.accept((0.5, 0.5))
    bench.setpoint.accept_load(-300.0)
    bench.until_ticks(20)
    bench.setpoint.accept((-0.25, -0.25))
    bench.until_ticks(20)
    ticks = bench.stopped()
    assert_solved(bench, ticks)
    assert [tick.number for tick in ticks] == list(range(len(ticks)))
    inputs = dict.fromkeys(tuple(tick.inputs) for tick in ticks)
    # a tick may have come between the command and the load
    inputs.pop((0.5, 0.5, 0.0), None)
    assert list(inputs) == [(0.0, 0.0, 0.0), (0.5, 0.5, -300.0), (-0.25, -0.25, -300.0)]
    stamps = np.diff([tick.stamp for tick in ticks])
    assert np.all(stamps % PERIOD_NS == 0) and np.all(stamps > 0)
    slip = round(bench.pacer.slip * 1e9)
    assert stamps.sum() == (len(ticks) - 1) * PERIOD_NS + slip
    # the interpreter had no part in any of them
    assert bench.python_ticks == 0
    assert bench.pacer.lateness.count == bench.pacer.ticks == len(ticks) - 1
    frames = list(bench.ring.frames())
    assert len(frames) == 1 + (len(ticks) - 1) // 10
    assert frames[2].time == pytest.approx(ticks[20].row[0], abs=1e-12)


def test_orders_resets_and_stops_come_between_two_ticks():
    bench = Bench()
    bench.plant.start()
    bench.until_ticks(5)
    seen = []
    assert bench.plant.order(lambda: seen.append((bench.plant.rows, bench.actuator.tick)))
    bench.until_ticks(5)
    rows, tick = seen[0]
    assert rows == tick + 1
    assert bench.plant.reset()
    bench.until_ticks(5)
    ticks = bench.stopped()
    assert [tick.row[0] for tick in ticks].count(0.0) == 2
    assert_solved(bench, ticks)
    # the reset alone took Python, and a stop is no longer than a tick
    assert bench.python_ticks == 1
    bench.plant.start()
    bench.until_ticks(3)
    again = bench.stopped()
    assert again[0].number == ticks[-1].number + 1
    assert again[0].row[0] == pytest.approx(ticks[-1].row[0] + PERIOD)


def test_a_moving_supply_is_the_interpreters_and_then_the_loop_goes_on():
    bench = Bench()
    bench.plant.start()
    bench.until_ticks(5)
    assert bench.plant.set_enabled(False)
    bench.setpoint.accept((0.7, 0.7))
    bench.until_ticks(60)
    ramp = bench.python_ticks
    assert 20 <= ramp <= 40
    bench.until_ticks(10)
    assert bench.python_ticks == ramp
    ticks = bench.stopped()
    assert all(tick.inputs[:2] == [0.0, 0.0] for tick in ticks)
    assert bench.setpoint.applied == 1


def test_a_due_fault_acts_at_its_tick(tmp_path):
    script = tmp_path / 'faults.csv'
    script.write_text('time,parameter,value\n0.05,fault.command_lost,1\n')
    bench = Bench(**{'fault.enabled': True, 'fault.script': str(script)})
    rows = []
    bench.plant.on_faults = rows.append
    bench.setpoint.accept((0.5, 0.5))
    bench.plant.start()
    bench.until_ticks(50)
    ticks = bench.stopped()
    other = Actuator(bench.actuator.parameters)
    for tick in ticks[1:]:
        other.tick_once(*tick.inputs)
        assert other.row.tolist() == tick.row
    assert rows[-1] == round(0.05 / PERIOD)
    assert 1 <= bench.python_ticks <= 5


def test_a_miss_under_halt_and_a_broken_limit_are_failures():
    bench = Bench('halt')
    bench.plant.start()
    bench.plant.order(lambda: time.sleep(5 * PERIOD))
    assert bench.failed.wait(20.0)
    bench.plant.stop()
    assert 'halt' in bench.plant.failure
    bench = Bench(**{'solver.max_mach': 1e-3})
    bench.setpoint.accept((1.0, 1.0))
    bench.plant.start()
    assert bench.failed.wait(60.0)
    assert 'solver.max_mach' in bench.plant.failure
    assert bench.stopped()[-1].row[bench.actuator.channels.MACH] <= 1e-3


def test_it_ticks_while_another_thread_keeps_the_interpreter():
    bench = Bench()
    bench.plant.start()
    bench.until_ticks(3)
    before = bench.pacer.ticks
    # one call that never gives the interpreter up; a plant in Python stands still meanwhile
    sum(range(30_000_000))
    after = bench.pacer.ticks
    assert after > before + 20
    bench.stopped()
