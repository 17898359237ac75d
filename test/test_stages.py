# SPDX-License-Identifier: Apache-2.0
"""The profile of a step: that its stages are those of the step."""

from hydra_actuator.parameters import Parameters
from hydra_actuator.stages import measure_stages
import pytest


@pytest.fixture(scope='module')
def stages():
    return measure_stages(Parameters().replace({'solver.cells': 100}), 5)


def test_a_plain_model_spends_nothing_on_gas_and_memory(stages):
    assert stages.times['sweep'] > 5.0 * stages.times['cavities']
    assert stages.times['sweep'] > 5.0 * stages.times['memory of friction']


def test_the_stages_make_up_the_step_but_for_what_overlaps(stages):
    assert 0.3 < sum(stages.times.values()) / stages.step < 3.0


def test_no_sweep_is_faster_than_the_bare_loop(stages):
    assert stages.step > stages.bare_sweep > 0.8 * stages.limit > 0.0
