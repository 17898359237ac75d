# SPDX-License-Identifier: Apache-2.0
"""How runs are spread: each method has the property it is known for, and repeats itself."""

from hydra_actuator.errors import InputError
from hydra_actuator.parameters import Parameters
from hydra_actuator.sweep.design import METHODS, sample
from hydra_actuator.sweep.factor import read_factor
import numpy as np
import pytest
from scipy.stats import qmc

BASE = Parameters()
FACTORS = (read_factor('cylinder.mass=1:3', BASE), read_factor('valve.stroke=0.001:0.002', BASE))


def unit(runs):
    return (np.array(runs) - [1.0, 1e-3]) / [2.0, 1e-3]


def test_a_grid_is_every_combination():
    runs = sample('grid', (*FACTORS, read_factor('solver.cells=50,60', BASE)), 3)
    assert len(runs) == len({tuple(run) for run in runs}) == 3 * 3 * 2


def test_a_latin_hypercube_has_one_run_in_each_slice():
    slices = np.floor(unit(sample('lhs', FACTORS, 50)) * 50).astype(int)
    assert all(sorted(column) == list(range(50)) for column in slices.T)


def test_sobol_fills_boxes_of_two_to_the_n_evenly():
    boxes = np.floor(unit(sample('sobol', FACTORS, 64)) * 8).astype(int)
    assert len({tuple(box) for box in boxes}) == 64


def test_sobol_is_more_even_than_random():
    even, chance = (qmc.discrepancy(unit(sample(method, FACTORS, 128)))
                    for method in ('sobol', 'random'))
    assert even < 0.1 * chance


@pytest.mark.parametrize('method', METHODS)
def test_the_seed_decides(method):
    assert sample(method, FACTORS, 8, 1) == sample(method, FACTORS, 8, 1)
    if method != 'grid':
        assert sample(method, FACTORS, 8, 1) != sample(method, FACTORS, 8, 2)


@pytest.mark.parametrize(('method', 'count', 'message'), [
    ('magic', 4, "no method 'magic'"), ('lhs', 0, '0 samples are not within'),
    ('grid', 4000, 'the grid has more than')])
def test_what_cannot_be_sampled_is_refused(method, count, message):
    with pytest.raises(InputError, match=message):
        sample(method, FACTORS, count)
