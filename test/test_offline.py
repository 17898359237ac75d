# SPDX-License-Identifier: Apache-2.0
"""The steps of an offline run: when outputs are due, and which commands lie on the way."""

from hydra_actuator.actuator import Actuator
from hydra_actuator.errors import InputError
from hydra_actuator.offline import AHEAD, next_stretch, OutputClock, Run
from hydra_actuator.parameters import Parameters
from hydra_actuator.sinks import Rows
import numpy as np
import pytest

QUICK = Parameters({'solver.cells': 60})


def test_output_instants_stay_on_the_grid_for_hours():
    clock = OutputClock(1000.0, 1e-3 / 134)
    clock._count = 10_000_000
    assert clock.due(clock.next_step)
    assert clock.next_step == 10_000_001 * 134


def test_stretches_hold_the_command_of_every_step_up_to_the_next_output():
    actuator = Actuator(QUICK)
    told = []

    def command(times):
        told.append(len(times))
        return np.column_stack((0.1 * times, 0.1 * times, times))
    run, sink = Run(actuator, command, None), Rows()
    last = AHEAD + 10 * actuator.steps_per_period
    stretches = run.stretches(last, sink)
    stretch, steps = next_stretch(stretches), []
    while stretch is not None:
        times, commands, hold = stretch.schedule
        assert hold and len(times) == stretch.steps == len(commands)
        assert np.array_equal(commands[:, 2], times)
        steps += np.round(times / actuator.step_time).astype(int).tolist()
        stretch = next_stretch(stretches, actuator.follow(*stretch))
    assert steps == list(range(1, last + 1))
    assert len(sink.rows) == actuator.tick + 1
    # at rest, then a block of many stretches at a time
    assert told[0] == 1 and len(told) <= 4


def test_a_command_that_goes_wrong_further_on_does_not_take_what_comes_before():
    actuator = Actuator(QUICK)
    wrong = 20.5 * actuator.period
    run, sink = Run(actuator, lambda times: np.column_stack(
        (np.where(times > wrong, 2.0, 0.5), np.zeros_like(times), np.zeros_like(times))), None), \
        Rows()
    stretches = run.stretches(AHEAD, sink)
    stretch = next_stretch(stretches)
    with pytest.raises(InputError, match='is not two spools'):
        while stretch is not None:
            stretch = next_stretch(stretches, actuator.follow(*stretch))
    assert len(sink.rows) == 21
