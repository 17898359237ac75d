# SPDX-License-Identifier: Apache-2.0
"""
Where in the space of the factors the runs lie.

grid: every combination; random: independent and uniform; lhs: a Latin hypercube, each factor's
range in as many slices as runs, one run in each; sobol: Sobol's sequence, scrambled (Owen), even
in all projections, best with a power of two. The last two by scipy.stats.qmc.
"""

import itertools
import math
import warnings

from hydra_actuator.errors import InputError
from hydra_actuator.sweep.factor import Factor
import numpy as np

METHODS = ('grid', 'random', 'lhs', 'sobol')
MOST_RUNS = 10_000_000


def sample(method: str, factors: tuple[Factor, ...], count: int, seed: int = 0) -> list[list]:
    """
    Return the runs: for each the values of the factors, in order.

    count: how many runs, or with `grid` how many points along each range. The same arguments give
    the same runs. Raises InputError for what cannot be sampled.
    """
    if method not in METHODS:
        raise InputError(f'no method {method!r}; there are {", ".join(METHODS)}')
    if not 1 <= count <= MOST_RUNS:
        raise InputError(f'{count} samples are not within 1 to {MOST_RUNS}')
    if method == 'grid':
        axes = [factor.grid(count) for factor in factors]
        if math.prod(map(len, axes)) > MOST_RUNS:
            raise InputError(f'the grid has more than {MOST_RUNS} points')
        return [list(point) for point in itertools.product(*axes)]
    shares = _shares(method, len(factors), count, seed)
    columns = [factor.values(shares[:, k]) for k, factor in enumerate(factors)]
    return [list(row) for row in zip(*columns)]


def _shares(method: str, factors: int, count: int, seed: int) -> np.ndarray:
    """Return points of the unit cube, shape (count, factors)."""
    from scipy.stats import qmc

    random = np.random.default_rng(seed)
    if method == 'random':
        return random.random((count, factors))
    if method == 'lhs':
        return qmc.LatinHypercube(factors, seed=random).random(count)
    with warnings.catch_warnings():
        # That its balance wants a power of two is said in the help.
        warnings.filterwarnings('ignore', category=UserWarning)
        return qmc.Sobol(factors, seed=random).random(count)
