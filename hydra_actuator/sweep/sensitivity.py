# SPDX-License-Identifier: Apache-2.0
"""
How much each figure of merit answers to each factor, from the runs there are.

- Rank correlation (Spearman): sign and strength of a monotonic answer, -1 to 1.
- First-order Sobol index: the part of the variance that the factor alone explains, 0 to 1, by
  RBD-FAST (Tarantola, Gatelli and Mara 2006, with the bias correction of Tissot and Prieur 2012)
  as SALib has it. It needs no samples of its own but many, and factors drawn from ranges.
"""

import numpy as np

HARMONICS = 10
FEWEST_RUNS = 6 * HARMONICS


def rank_correlation(factor: np.ndarray, figure: np.ndarray) -> float:
    """Return Spearman's coefficient over runs where both are finite, NaN if one is constant."""
    from scipy.stats import rankdata

    sound = np.isfinite(factor) & np.isfinite(figure)
    if sound.sum() < 3 or not np.ptp(factor[sound]) or not np.ptp(figure[sound]):
        return float('nan')
    return float(np.corrcoef(rankdata(factor[sound]), rankdata(figure[sound]))[0, 1])


def first_order(factors: np.ndarray, figure: np.ndarray) -> np.ndarray:
    """
    Return the first-order index of each factor, (n,), NaN where it cannot be told.

    factors: (runs, n), drawn independently; figure: (runs,).
    """
    from SALib.analyze import rbd_fast

    sound = np.isfinite(figure)
    count = factors.shape[1]
    if sound.sum() < FEWEST_RUNS or not np.ptp(figure[sound]):
        return np.full(count, np.nan)
    problem = {'num_vars': count, 'names': [str(k) for k in range(count)],
               'bounds': [[low, high] for low, high in
                          zip(factors.min(axis=0), factors.max(axis=0))]}
    found = rbd_fast.analyze(problem, factors[sound], figure[sound], M=HARMONICS,
                             num_resamples=2, seed=0)
    return np.clip(np.asarray(found['S1'], float), 0.0, 1.0)
