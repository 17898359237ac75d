# SPDX-License-Identifier: Apache-2.0
"""Properties of compiled formulas: the first call compiles, and a test finds the same each day."""

from hydra_actuator.core.model import set_domain
from hypothesis import settings
import numpy as np
import pytest

settings.register_profile('compiled', deadline=None, derandomize=True)
settings.load_profile('compiled')


@pytest.fixture
def growth():
    """
    Return a function: how much the waves of a lone domain grow in 20 000 steps.

    They start as noise, with 500 steps to lose what a stencil damps at once.
    """
    def grow(chain) -> float:
        model, state = chain.model, chain.state
        random = np.random.default_rng(0)
        noise = 1e-6 * random.standard_normal((2, state.last[0] + 1))
        set_domain(model, state, 0, noise[0], noise[1])
        chain.advance(500)
        before = max(np.abs(wave).max() for wave in chain.waves(0))
        chain.advance(20_000)
        return max(np.abs(wave).max() for wave in chain.waves(0)) / before
    return grow
