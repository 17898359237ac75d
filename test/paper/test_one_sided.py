# SPDX-License-Identifier: Apache-2.0
"""The one-sided actuator has a supply side and nothing behind the piston."""

from hydra_actuator.paper.one_sided import VANISHING
from hydra_actuator.paper.statements_edges import edge_drops, one_sided_half_period
import numpy as np

# Of the supply pressure: what the oil behind the piston resists its acceleration with, rho L a.
INERTIA = 4e-3


def test_nothing_pushes_back_and_nothing_is_lost_behind_the_piston():
    trace = one_sided_half_period()
    supply = trace.parameters['supply.pressure']
    for station in 'FGHIJK':
        assert np.abs(trace.pressure(station)).max() < INERTIA * supply
    assert np.nanmax(np.abs(edge_drops(trace)[1])) < INERTIA * supply


def test_the_piston_moves_under_one_chamber_and_its_load_alone():
    trace = one_sided_half_period()
    p = trace.parameters
    assert p['cylinder.area_2'] == VANISHING * p['cylinder.area_1']
    velocity = trace.velocity('E')
    force = (p['cylinder.area_1'] * trace.pressure('E') - p['cylinder.stiffness'] * trace.position
             - p['cylinder.viscous_friction'] * velocity)
    steps = 0.5 * (force[1:] + force[:-1]) * np.diff(trace.time)
    momentum = np.concatenate(([0.0], np.cumsum(steps)))
    # the trapezoid at ten samples per unit of L/c
    assert np.abs(momentum / p['cylinder.mass'] - velocity).max() < 2e-3 * velocity.max()
