# SPDX-License-Identifier: Apache-2.0
"""Laminar flow stopped at once, with the friction's memory, against the exact transient."""

from hydra_actuator.verification import friction_transient
from hydra_actuator.verification.case import failures
import numpy as np
import pytest


def test_unsteady_friction_gives_the_exact_laminar_transient():
    assert not failures(friction_transient.transient())


def test_steady_friction_alone_misses_it_by_half_the_first_rise():
    exact = [values[0] for values in friction_transient.EXACT.values()]
    got = friction_transient.stopped_pressure(list(friction_transient.EXACT), 0.0028, 'steady')
    # three digits of the known error of quasi-steady friction
    assert np.abs(got - exact).max() == pytest.approx(0.505, abs=5e-4)


def test_the_flow_is_steady_until_it_is_stopped():
    chain = friction_transient.poiseuille_flow(0.05)
    before = chain.pressure(0)
    chain.hold(0.0, friction_transient.AREA * friction_transient.VELOCITY)
    chain.advance(2000)
    rise = friction_transient.DENSITY * friction_transient.SPEED * friction_transient.VELOCITY
    # rounding of mu + u, 2000 times
    assert np.abs(chain.velocity(0) / friction_transient.VELOCITY - 1.0).max() < 1e-8
    assert np.abs(chain.pressure(0) - before).max() < 1e-8 * rise
