# SPDX-License-Identifier: Apache-2.0
"""
Ports and open edges of four valves, one in each lane.

See hydra_actuator.core.orifice and hydra_actuator.core.valve.
"""

from hydra_actuator.core.choices import (
    all_at_most,
    at_least,
    at_most,
    where_at_most,
    where_positive,
)
from hydra_actuator.core.compilation import formula
from hydra_actuator.core.end import End
from hydra_actuator.core.lanes import element, multiply_add, put
from hydra_actuator.core.orifice import MOST_PASSES, orifice_flow
from hydra_actuator.core.together.ends import end_in_lanes, relation_in_lanes, still_moves
from hydra_actuator.core.valve import A, B, I, J


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


@formula
def solve_port(now, j, ends):
    """Solve an orifice in every lane; return whether its series hold."""
    v_1, v_2, holds = solve_orifices(
        end_in_lanes(now, ends[0]), end_in_lanes(now, ends[1]),
        element(now.coefficient, j), element(now.leakage, j))
    put(now.end_velocity, ends[0], v_1)
    put(now.end_velocity, ends[1], v_2)
    return holds


@formula
def is_ring(now):
    """Return whether some lane's edges share a station."""
    direct = at_least(element(now.edge, 0), element(now.edge, 3))
    reverse = at_least(element(now.edge, 1), element(now.edge, 2))
    return not all_at_most(at_most(direct, reverse), 0.0 * direct)


@formula
def chosen(switch, then, otherwise):
    """Return an End whose lanes are `then`'s where the switch is above 0."""
    return End(
        where_positive(switch, then.wave, otherwise.wave),
        where_positive(switch, then.velocity, otherwise.velocity),
        where_positive(switch, then.slowness, otherwise.slowness),
        where_positive(switch, then.bulk_modulus, otherwise.bulk_modulus),
        where_positive(switch, then.area, otherwise.area),
        where_positive(switch, then.impedance, otherwise.impedance),
        where_positive(switch, then.inverse_area, otherwise.inverse_area), 0.0, 0.0, 0.0)


@formula
def solve_edges(now, ends):
    """Solve the two edges that join two stations each; return whether their series hold."""
    end_a, end_b = end_in_lanes(now, ends[A]), end_in_lanes(now, ends[B])
    end_i, end_j = end_in_lanes(now, ends[I]), end_in_lanes(now, ends[J])
    reverse = at_least(element(now.edge, 1), element(now.edge, 2))
    v_a, v_out, held_1 = solve_orifices(
        end_a, chosen(reverse, end_i, end_b),
        where_positive(reverse, element(now.edge, 1), element(now.edge, 0)), 0.0 * reverse)
    v_back, v_j, held_2 = solve_orifices(
        chosen(reverse, end_b, end_i), end_j,
        where_positive(reverse, element(now.edge, 2), element(now.edge, 3)), 0.0 * reverse)
    put(now.end_velocity, ends[A], v_a)
    put(now.end_velocity, ends[B], where_positive(reverse, v_back, v_out))
    put(now.end_velocity, ends[I], where_positive(reverse, v_out, v_back))
    put(now.end_velocity, ends[J], v_j)
    return held_1 and held_2
