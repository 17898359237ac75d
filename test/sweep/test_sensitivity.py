# SPDX-License-Identifier: Apache-2.0
"""Sensitivities: of functions whose indices are known."""

import math

from hydra_actuator.sweep.sensitivity import first_order, rank_correlation
import numpy as np
import pytest
from scipy.stats import qmc, spearmanr

# Of 1024 samples.
ESTIMATE = 0.05


def test_first_order_indices_of_ishigamis_function():
    x = (2.0 * qmc.LatinHypercube(3, seed=1).random(1024) - 1.0) * math.pi
    y = np.sin(x[:, 0]) + 7.0 * np.sin(x[:, 1])**2 + 0.1 * x[:, 2]**4 * np.sin(x[:, 0])
    # Sobol and Levitan (1999)
    assert first_order(x, y) == pytest.approx([0.3139, 0.4424, 0.0], abs=ESTIMATE)


def test_a_logarithmic_factor_counts_as_its_ranks():
    x = qmc.LatinHypercube(2, seed=2).random(1024)
    y = 3.0 * x[:, 0] + x[:, 1]
    assert first_order(np.exp(5.0 * x), y) == pytest.approx([0.9, 0.1], abs=ESTIMATE)


def test_too_few_runs_and_constant_figures_have_no_index():
    x = np.random.default_rng(0).random((100, 2))
    assert np.isnan(first_order(x[:10], x[:10, 0])).all()
    assert np.isnan(first_order(x, np.ones(100))).all()


def test_rank_correlation_is_spearmans_over_finite_runs():
    x, noise = np.random.default_rng(0).random((2, 50))
    y = np.exp(x) + noise
    y[3] = np.nan
    keep = np.arange(50) != 3
    assert rank_correlation(x, y) == pytest.approx(spearmanr(x[keep], y[keep]).statistic)
    assert math.isnan(rank_correlation(x, np.ones(50)))
