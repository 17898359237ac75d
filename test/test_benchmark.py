# SPDX-License-Identifier: Apache-2.0
"""The measurements of speed: that they measure what they say."""

from hydra_actuator.actuator import SolverError
from hydra_actuator.benchmark import measure_options, measure_speed
from hydra_actuator.parameters import Parameters
from hydra_actuator.parameters.options import EVERYTHING, OPTIONS
import numpy as np
import pytest

pytestmark = pytest.mark.once

SMALL = Parameters().replace({'solver.cells': 40})


def test_a_step_takes_longer_than_the_sweep_it_contains():
    speed = measure_speed(SMALL, 0.3)
    assert len(speed.times) == len(speed.bare_times) == 50
    assert np.all(np.diff(speed.times) >= 0.0)
    assert speed.ratio_to_bare_sweep > 1.0
    assert speed.real_time_factor(0.0) > speed.real_time_factor(1.0) > 0.0


def test_every_option_is_timed_beside_the_model_it_is_added_to():
    shares = []
    times = measure_options(SMALL, 0.07, shares.append)
    assert list(times) == ['as configured', *OPTIONS, 'everything']
    assert shares == [0.25, 0.5, 0.75, 1.0]
    assert all(len(column) == 4 and np.all(column > 0.0) for column in times.values())


def test_everything_holds_all_options_but_the_milder_friction():
    assert EVERYTHING['line_1.friction'] == 'unsteady'
    for name, option in OPTIONS.items():
        if name != 'steady friction':
            assert EVERYTHING.items() >= option.items()


def test_options_cost_time():
    times = measure_options(SMALL.replace({'tank.pressure': 0.0}), 0.15)
    plain = np.median(times['as configured'])
    assert np.median(times['everything']) > np.median(times['cavitation']) > plain


def test_a_model_that_breaks_is_said():
    with pytest.raises(SolverError, match='max_mach'):
        measure_options(SMALL.replace({'solver.max_mach': 0.0015}), 0.3)
