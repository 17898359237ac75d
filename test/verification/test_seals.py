# SPDX-License-Identifier: Apache-2.0
"""Seals hold, let go, do not chatter, and stick and slip in the exact rhythm."""

from hydra_actuator.verification import seals
from hydra_actuator.verification.case import failures
import numpy as np
import pytest


def test_seals_hold_up_to_their_force_and_do_not_chatter():
    assert not failures(seals.seal_hold())


def test_a_mass_drawn_by_a_spring_sticks_and_slips_in_the_exact_rhythm():
    assert not failures(seals.stick_slip())


@pytest.mark.parametrize(('trace', 'count'), [
    ([0.0, 1.0, 0.0, 0.0, 1.0], 0), ([1.0, 0.0, -1.0, 1.0], 2), ([0.0], 0)])
def test_reversals_are_changes_of_sign_with_rests_left_out(trace, count):
    assert seals.reversals(np.array(trace)) == count
