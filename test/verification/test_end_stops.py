# SPDX-License-Identifier: Apache-2.0
"""A bouncing piston rises to e^2n of its height; chambers of one cell stay calm."""

from hydra_actuator.errors import Failure
from hydra_actuator.verification import end_stops
from hydra_actuator.verification.case import failures
import pytest


def test_a_piston_bounces_to_the_heights_of_its_restitution():
    assert not failures(end_stops.end_stop())


def test_chambers_of_one_cell_stay_calm_at_the_stops():
    assert not failures(end_stops.short_chambers())


def test_a_piston_on_a_dead_stop_never_rises():
    with pytest.raises(Failure, match='0 rebounds'):
        end_stops.bounce(0.0)
