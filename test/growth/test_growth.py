# SPDX-License-Identifier: Apache-2.0
"""Curves of growth: measured on small work they have the shape that they must have."""

from hydra_actuator.growth.report import draw, Growth, lines
from hydra_actuator.growth.solver import over_actuators, over_cells, over_threads, over_time
from hydra_actuator.growth.workers import Scaling, task_time
from hydra_actuator.parameters import Parameters
import numpy as np
import pytest

pytestmark = pytest.mark.once

SMALL = Parameters({'solver.cells': 40})


@pytest.fixture(scope='module')
def growth():
    spent, memory = over_time(0.5, SMALL)
    scaling = Scaling(np.array([1, 2]), np.array([9.0, 17.0]), 0.09, 0.1, 5e-3, 0.6e-3)
    return Growth(over_cells((50, 400), 5), spent, memory, over_actuators((1, 4), 3, SMALL),
                  over_threads((1, 2), 2, SMALL),
                  scaling, 650.0)


def test_a_step_costs_more_with_more_cells_but_not_more_per_cell(growth):
    few, many = growth.cells.value
    assert few < many < 8.0 * few


def test_actuators_cost_the_same_each(growth):
    # Caches and a busy machine change this by some tenths, not by the count.
    assert growth.actuators.value[1] < 2.5 * growth.actuators.value[0]


def test_memory_does_not_grow_with_simulated_time(growth):
    half = len(growth.memory.value) // 2
    assert len(growth.memory.value) >= 15
    assert growth.memory.value[-1] - growth.memory.value[half] < 8 * 2**20


def test_a_scheduler_feeds_what_its_own_time_allows(growth):
    # Ten workers get chunks of half a second: five runs, each then 1 ms of asking.
    assert growth.workers.on_paper(10) == pytest.approx((100.0, 0.9))
    # A thousand get chunks of ten seconds: 100 runs, each then 0.65 ms.
    assert growth.workers.on_paper(1000) == pytest.approx((1.0 / 0.65e-3, 0.138), rel=5e-3)


def test_tasks_that_do_nothing_cost_the_asking_process_time():
    assert task_time(20) > 0.0


def test_curves_are_told_and_drawn(growth, tmp_path):
    told = '\n'.join(lines(growth))
    assert 'ns per node' in told
    assert '1000 workers and one scheduler: 1538 of these runs per s' in told
    draw(growth, tmp_path / 'growth.png')
    assert (tmp_path / 'growth.png').read_bytes().startswith(b'\x89PNG')
