# SPDX-License-Identifier: Apache-2.0
"""
Ports and open edges of four valves, one in each lane.

See hydra_actuator.core.orifice and hydra_actuator.core.valve.
"""

from hydra_actuator.core.choices import all_at_most, at_least, at_most, where_positive
from hydra_actuator.core.compilation import formula
from hydra_actuator.core.end import End
from hydra_actuator.core.lanes import element, put
from hydra_actuator.core.orifice_lanes import solve_orifices
from hydra_actuator.core.together.ends import end_in_lanes
from hydra_actuator.core.valve import A, B, I, J


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
