# SPDX-License-Identifier: Apache-2.0
"""The balance of the oil's mass while it runs."""

import math

from hydra_actuator.actuator import Actuator
from hydra_actuator.core.mass import WEIGH_EVERY
from hydra_actuator.parameters import Parameters
from hydra_actuator.parameters.options import EVERYTHING
from hydra_actuator.verification.weighing import Weigher
import pytest

GASLESS = {'solver.cells': 60}
GASSY = {**EVERYTHING, 'solver.cells': 60}


def run(actuator: Actuator, periods: int, amplitude: float = 0.3) -> None:
    """Swing the valve without a jump, from where it is."""
    for _ in range(periods):
        ramp = min(1.0, actuator.time / 0.02)
        swing = 1.0 + 0.3 * math.sin(100.0 * math.pi * actuator.time)
        actuator.advance(actuator.period, spool=amplitude * ramp * swing)


@pytest.fixture(scope='module')
def gassy():
    return Actuator(Parameters().replace(GASSY))


@pytest.fixture(scope='module')
def gasless():
    return Actuator(Parameters().replace(GASLESS))


def test_what_is_missing_is_little(gassy, gasless):
    for actuator, bar in ((gassy, 1e-6), (gasless, 1e-5)):
        actuator.reset()
        run(actuator, 4 * WEIGH_EVERY)
        balance = actuator.tally.mass
        assert balance.passed > 0.01
        assert 0.0 < abs(balance.residual) < bar * balance.passed


def test_the_oil_weighs_what_another_way_of_weighing_says(gassy):
    gassy.reset()
    run(gassy, WEIGH_EVERY)
    before, first = Weigher(gassy).stored()[0], gassy._state.mass[0].copy()
    run(gassy, 2 * WEIGH_EVERY)
    gained, mass = Weigher(gassy).stored()[0] - before, gassy._state.mass[0]
    told = (mass['entered'] - mass['residual']) - (first['entered'] - first['residual'])
    assert told == pytest.approx(gained, abs=1e-8 * before)
    assert first['at_first'] == pytest.approx(before, rel=0.01)


def test_oil_that_vanishes_is_missed(gasless):
    gasless.reset()
    gasless.advance(gasless.period)
    model, state = gasless._model, gasless._state
    line = slice(model.start[0], model.start[0] + state.last[0] + 1)
    less = 1e5 / (gasless.parameters['fluid.density'] * model.wave_speed[0])
    for wave in (state.wave_p, state.wave_q):
        wave[line] -= less
    gasless.advance((WEIGH_EVERY - 1) * gasless.period)
    lost = 1e5 / model.wave_speed[0] ** 2 * model.area[0] * state.length[0]
    assert gasless.tally.mass.residual == pytest.approx(lost, rel=0.05)


def test_the_balance_begins_anew_with_a_reset(gasless):
    run(gasless, WEIGH_EVERY)
    gasless.reset()
    assert gasless.tally.mass.passed == gasless.tally.mass.residual == 0.0


def test_air_that_comes_into_the_oil_is_no_error():
    actuator = Actuator(Parameters().replace({**GASLESS, 'fault.enabled': True}))
    run(actuator, WEIGH_EVERY)
    actuator.set_faults({'fault.air_fraction': 0.01})
    run(actuator, 2 * WEIGH_EVERY)
    balance = actuator.tally.mass
    assert abs(balance.residual) < 1e-5 * balance.passed
