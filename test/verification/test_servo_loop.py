# SPDX-License-Identifier: Apache-2.0
"""
A position servo against its published trace, and against a lumped model that shares no code.

The lumped model says what of the distance to the trace is the relief valve's, the oil's mass and
the equation of state's.
"""

import math

from hydra_actuator.verification import servo_loop
from hydra_actuator.verification.case import failures
import numpy as np
import pytest

STEP = 1e-5
DURATION = 0.05
LUMPED = 1e-4           # m: explicit steps of 10 us here, waves there
TRACE = np.array(servo_loop.BEFORE_VAPOUR).T


def root(drop: float) -> float:
    return math.copysign(math.sqrt(abs(drop)), drop)


def lumped_position(times, mass: float = 100.0, relief_slope: float = 0.5e-8,
                    mass_of_oil_kept: bool = True) -> np.ndarray:
    """Return positions [m] of Hopsan's example, all volumes lumped, before oil boils."""
    bulk, area, tank, gain = 1e9, 1e-3, 1e5, 0.67 * 0.01 * math.pi * math.sqrt(2.0 / 890.0)
    x = v = spool = spool_speed = total = 0.0
    supply = p_1 = p_2 = 1e5
    trace = []
    for k in range(round(DURATION / STEP) + 1):
        trace.append(x)
        if k % 10 == 0:
            command = 0.0264249 * (0.2 - x) + 6.72426e-4 * total
            total += (0.2 - x) * 1e-4
        spool_speed += STEP * (4e4 * (command - spool) - 400.0 * spool_speed)
        spool += STEP * spool_speed
        opening = gain * max(0.0, spool - 1e-4)
        q_1, q_2 = opening * root(supply - p_1), opening * root(p_2 - tank)
        ratio_1, ratio_2 = (1.0 + (p - tank) / bulk * mass_of_oil_kept for p in (p_1, p_2))
        p_1 += STEP * bulk * (q_1 - area * v * ratio_1) / (3e-4 + area * x)
        p_2 += STEP * bulk * (area * v * ratio_2 - q_2) / (1.3e-3 - area * x)
        supply += STEP * 1e12 * (7.9577e-3 - q_1)
        if supply > 20e6:
            stiffness = STEP * 1e12 * relief_slope
            supply = (supply + stiffness * 20e6) / (1.0 + stiffness)
        v += STEP * (area * (p_1 - p_2) - 100.0 * x) / mass
        x += STEP * v
    return np.interp(times, STEP * np.arange(len(trace)), trace)


def solver_position(times, **changes) -> np.ndarray:
    slope = changes.pop('relief_slope', servo_loop.RELIEF_SLOPE)
    loop = servo_loop.published_loop(slope)
    return np.interp(times, *loop.run(
        servo_loop.published_servo().replace(changes), DURATION))


def test_the_servo_follows_the_published_trace():
    assert not failures(servo_loop.published())


def test_the_gentle_servo_follows_the_lumped_solution():
    assert not failures(servo_loop.gentle())


def test_a_lumped_model_explains_what_is_left_to_the_trace():
    times, expected = TRACE
    assert lumped_position(times) == pytest.approx(solver_position(times), abs=LUMPED)
    loose = lumped_position(times, mass_of_oil_kept=False)
    assert loose == pytest.approx(expected, abs=0.6e-3)
    assert lumped_position(times)[-1] < loose[-1] - 0.4e-3


def test_oil_left_on_top_of_the_mass_is_felt_as_mass():
    times, expected = TRACE
    heavy = solver_position(times, **{'cylinder.mass': 100.0})
    assert heavy == pytest.approx(
        lumped_position(times, mass=100.0 + servo_loop.OIL), abs=LUMPED)
    assert heavy[-1] < expected[-1] - 3e-3


def test_an_ideal_relief_valve_is_a_loss_of_pressure():
    times, expected = TRACE
    ideal = solver_position(times, relief_slope=math.inf)
    assert ideal == pytest.approx(
        lumped_position(times, relief_slope=1.0), abs=LUMPED)
    assert ideal[-1] < expected[-1] - 8e-3
