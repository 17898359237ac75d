# SPDX-License-Identifier: Apache-2.0
"""The profile of a step: that its stages are those of the step."""

import copy

from hydra_actuator.actuator import Actuator
from hydra_actuator.benchmark import drive, processor_time
from hydra_actuator.parameters import Parameters
from hydra_actuator.stages import (
    CAVITIES,
    LOWEST,
    measure_stages,
    MEMORY,
    NAMES,
    NOTHING,
    repeat_stage,
)
import pytest

pytestmark = pytest.mark.once


# Between one measurement and another of the same on a busy machine.
NOISE = 2.5


@pytest.fixture(scope='module')
def stages():
    return measure_stages(Parameters().replace({'solver.cells': 100}), 5)


@pytest.fixture(scope='module')
def actuator():
    actuator = Actuator(Parameters().replace({'solver.cells': 100}))
    drive(actuator, 10)
    return actuator


def test_a_plain_model_spends_nothing_on_gas_and_memory(stages):
    assert stages.times['sweep'] > 5.0 * stages.times['cavities']
    assert stages.times['sweep'] > 5.0 * stages.times['memory of friction']


def test_the_stages_make_up_the_step_but_for_what_overlaps(stages):
    assert 0.3 < sum(stages.times.values()) / stages.step < 3.0


def test_a_step_takes_longer_than_the_sweep_it_contains_and_than_the_bare_loop(stages):
    assert stages.step > stages.bare_sweep > 0.0
    assert stages.step > stages.limit > 0.0


def test_calls_from_python_and_steps_take_what_they_take_in_a_long_run(stages, actuator):
    def observe(count):
        for _ in range(count):
            actuator._observe()

    def call(count):
        for _ in range(count):
            actuator._advance(actuator._schedule, 0)

    def took(work, count):
        parts = count * actuator.steps_per_period
        return min(processor_time(work, count) / parts for _ in range(7))

    for seen, alone in (
            (stages.times['observation'], took(observe, 1000)),
            (stages.times['calls from Python'], took(call, 1000)),
            (stages.step, took(lambda count: drive(actuator, count), 30))):
        assert 1.0 / NOISE < seen / alone < NOISE


def test_no_stage_is_left_out_by_the_compiler(actuator):
    def took(stage, count):
        state = copy.deepcopy(actuator._state)
        return processor_time(repeat_stage, actuator._model, state, actuator._inputs,
                              actuator._passes, stage, count)

    took(NOTHING, 1)
    called = set(range(len(NAMES))) - {CAVITIES, MEMORY, LOWEST}
    least = {stage: min(took(stage, 20_000) for _ in range(7)) for stage in called}
    nothing = least.pop(NOTHING)
    for stage, time in least.items():
        # what is left out costs an empty turn; the least of the stages costs two or more
        assert time > 1.5 * nothing, NAMES[stage]
