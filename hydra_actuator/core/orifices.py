# SPDX-License-Identifier: Apache-2.0
"""
Both open edges of the valve and both ports solved at once, an orifice in each lane.

    lane 0, 1   direct: A to B (PA), I to J (BT);  reverse: A to I (PB), B to J (AT)
    lane 2, 3   the ports

One orifice is a chain of operations, each of which waits for the one before; four in a vector take
little longer than one, and have the same bits. Not solved here, but one by one, are edges that are
a ring, a valve that leaks, gas at the ends, and what is beyond the reach of the series of
hydra_actuator.core.end.
"""

from hydra_actuator.core.compilation import formula
from hydra_actuator.core.end import End
from hydra_actuator.core.lanes import gather, load, scatter, WIDTH
from hydra_actuator.core.orifice_lanes import solve_orifices
from hydra_actuator.core.records import ORIFICE, VALVE
import numpy as np

EDGES = 4               # of a valve; the ports' K' stand behind those of its edges
# Of the edges in lane 0 and 1, then where the ports' K' are.
DIRECT, REVERSE = (0, 3, EDGES, EDGES + 1), (1, 2, EDGES, EDGES + 1)
# Slowness, bulk modulus, area, impedance and its inverse area of four ends.
CONSTANTS = 5 * WIDTH


def port_coefficients(junctions: list) -> list[float]:
    """Return K' [m^3/(s sqrt(Pa))] of the first two orifices of a chain, 0 for none."""
    ports = [junction.coefficient for junction in junctions if junction.kind == ORIFICE]
    return [*ports, 0.0, 0.0][:WIDTH - 2]


def orifice_arrays(junctions: list, density: float, wave_speed: np.ndarray,
                   area: np.ndarray) -> dict[str, np.ndarray]:
    """
    Return the Model's fields of the four orifices, empty where a chain has not just these.

    junctions: hydra_actuator.core.model.Junction's; density [kg/m^3] at gauge zero; wave_speed
    [m/s], area [m^2] of the domains, (D,).
    """
    valves = [junction.ends for junction in junctions if junction.kind == VALVE]
    ports = [junction for junction in junctions if junction.kind == ORIFICE]
    if len(valves) != 1 or len(ports) != WIDTH - 2:
        return {'orifice_ends': np.zeros(0, np.int64), 'orifice_edges': np.zeros(0, np.int64),
                'orifice_constants': np.zeros(0), 'orifice_leakage': np.zeros(0)}
    a, b, i, j = valves[0]
    ends = np.array([(*pair, ports[0].ends[side % 2], ports[1].ends[side % 2])
                     for side, pair in enumerate(((a, i), (b, j), (a, b), (i, j)))])
    of_domain = (1.0 / wave_speed, density * wave_speed ** 2, area, density * wave_speed / area,
                 1.0 / area)
    constants = np.array([[values[four // 2] for values in of_domain] for four in ends])
    return {'orifice_ends': ends.ravel(), 'orifice_edges': np.array(DIRECT + REVERSE),
            'orifice_constants': constants.ravel(),
            'orifice_leakage': np.array([0.0, 0.0, *(port.leakage for port in ports)])}


@formula
def solve_open_orifices(model, state):
    """Solve the four orifices; return whether that could be done, else nothing is changed."""
    edges = state.edge_coefficient
    reverse = edges[1] > 0.0 or edges[2] > 0.0
    if len(model.extras) > 0 and model.gas == 1:
        return False
    if (model.orifice_ends.size == 0 or model.valve[0].leakage != 0.0
            or (reverse and (edges[0] > 0.0 or edges[3] > 0.0))):
        return False
    way = 1 if reverse else 0
    v_1, v_2, holds = solve_orifices(
        four_ends(model, state, 2 * way), four_ends(model, state, 2 * way + 1),
        gather(edges, model.orifice_edges, WIDTH * way, 0), load(model.orifice_leakage, 0))
    if holds:
        scatter(state.end_velocity, model.orifice_ends, 2 * WIDTH * way, 0, v_1)
        scatter(state.end_velocity, model.orifice_ends, 2 * WIDTH * way + WIDTH, 0, v_2)
    return holds


@formula
def four_ends(model, state, side):
    """Return the Ends on one side of the orifices; side: 0, 1 of direct flow, 2, 3 of reverse."""
    first, c = WIDTH * side, CONSTANTS * side
    constants = model.orifice_constants
    return End(
        gather(state.end_wave, model.orifice_ends, first, 0),
        gather(state.end_velocity, model.orifice_ends, first, 0),
        load(constants, c), load(constants, c + WIDTH), load(constants, c + 2 * WIDTH),
        load(constants, c + 3 * WIDTH), load(constants, c + 4 * WIDTH), 0.0, 0.0, 0.0)
