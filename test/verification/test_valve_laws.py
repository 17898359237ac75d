# SPDX-License-Identifier: Apache-2.0
"""Several edges at once against two other solutions, and two spools."""

from hydra_actuator.verification import valve_laws
from hydra_actuator.verification.case import failures
import numpy as np
import pytest
from scipy.optimize import least_squares

FLOW, PRESSURE = 1e-3, 1e6


@pytest.fixture(scope='module')
def rings():
    return valve_laws.random_rings()


def test_rings_of_edges_agree_with_bisection():
    assert not failures(valve_laws.valve_ring())


def defects_of(ring: int, rings):
    """Return the function of pressures and edge flows whose root solves one ring."""
    waves, areas, gains = (values[:, ring] for values in rings[:3])
    leakage = rings[3][ring]

    def defects(x):
        p, q = x[:4] * PRESSURE, x[4:] * FLOW
        drops = p[[0, 0, 1, 2]] - p[[1, 2, 3, 3]]
        laws = valve_laws.edge_flow(drops, gains, leakage) - q
        taken = np.array([q[0] + q[1], q[2] - q[0], q[3] - q[1], -q[2] - q[3]])
        return np.concatenate((laws, valve_laws.brought(waves, areas, p) - taken)) / FLOW

    return defects


def test_rings_of_edges_agree_with_least_squares(rings):
    got = valve_laws.solve_by_valve(rings)
    for n in range(0, valve_laws.RINGS, 10):
        start = np.concatenate((valve_laws.pressure_of(rings[0][:, n]) / PRESSURE, np.zeros(4)))
        found = least_squares(defects_of(n, rings), start, xtol=1e-15, ftol=1e-15, gtol=1e-15,
                              max_nfev=2000)
        assert found.cost < 1e-16
        assert found.x[:4] * PRESSURE == pytest.approx(got[:, n], rel=1e-6)


def test_two_spools_alike_are_one_and_apart_meter_alone():
    assert not failures(valve_laws.two_spools())


def test_one_bit_is_a_difference():
    values = np.array([1.0, 2.0])
    assert valve_laws.differences(values, np.nextafter(values, 3.0)) == 2.0
