# SPDX-License-Identifier: Apache-2.0
"""
Orifices without gas at their ends, one in each lane: hydra_actuator.core.orifice, bit by bit.

Where an end is beyond the reach of the short series, which the formula for one leaves for others,
the answer is not to be used; that is said beside it.
"""

from hydra_actuator.core.choices import all_at_most, at_least, where_at_most, where_positive
from hydra_actuator.core.compilation import formula
from hydra_actuator.core.end import relation_of, SERIES_REACH, steering_series
from hydra_actuator.core.fluid import compression_series, SERIES_LIMIT
from hydra_actuator.core.lanes import multiply_add
from hydra_actuator.core.orifice import MOST_PASSES, NO_STEP, orifice_flow, STEP_TOLERANCE


@formula
def relation_in_lanes(end, velocity):
    """Return `end_relation` without gas, and how far it is into the reach of its series."""
    z = (end.wave - velocity) * end.slowness
    compression = compression_series(z)
    mach = velocity * end.slowness
    growth, lightness = steering_series(mach, compression)
    relation = relation_of(end, velocity, compression, (growth, lightness, 1.0))
    return relation, at_least(abs(z) * (1.0 / SERIES_LIMIT), abs(mach) * (1.0 / SERIES_REACH))


@formula
def still_moves(velocity, change, unsettled):
    """Return 0 in the lanes where a Newton step was the last needed, else `unsettled`."""
    return where_at_most(
        abs(change), STEP_TOLERANCE * abs(velocity) + NO_STEP, 0.0 * unsettled, unsettled)


@formula
def solve_orifices(end_1, end_2, coefficient, leakage):
    """Return (v_1, v_2, whether the series hold) of WIDTH orifices: `solve_orifice`."""
    v_1, v_2 = end_1.velocity, end_2.velocity
    nothing = 0.0 * coefficient
    unsettled, strain = nothing + 1.0, nothing
    for _ in range(MOST_PASSES):
        (p_1, q_1, z_1, flatness_1), strain_1 = relation_in_lanes(end_1, v_1)
        (p_2, q_2, z_2, flatness_2), strain_2 = relation_in_lanes(end_2, v_2)
        strain = at_least(strain, at_least(strain_1, strain_2))
        flow = orifice_flow(
            multiply_add(z_1, q_1, p_1) - multiply_add(z_2, q_2, p_2), z_1 + z_2,
            coefficient, leakage)
        change_1 = (flow - q_1) * flatness_1
        change_2 = -(flow + q_2) * flatness_2
        v_1 = where_positive(unsettled, v_1 + change_1, v_1)
        v_2 = where_positive(unsettled, v_2 + change_2, v_2)
        unsettled = at_least(
            still_moves(v_1, change_1, unsettled), still_moves(v_2, change_2, unsettled))
        if all_at_most(unsettled, nothing):
            break
    conducts = coefficient + leakage
    v_1 = where_at_most(conducts, nothing, nothing, v_1)
    v_2 = where_at_most(conducts, nothing, nothing, v_2)
    return v_1, v_2, all_at_most(strain, nothing + 1.0)
