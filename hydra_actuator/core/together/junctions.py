# SPDX-License-Identifier: Apache-2.0
"""
The junctions of four actuators, one in each lane; see hydra_actuator.core.junctions.

Pump, open edges of the valve, ports, piston and tank are solved in lanes. What only some have is
solved one by one by the formulas for one: an accumulator, a pump at its largest flow, edges that
are a ring, seals, a piston at its stop.
"""

from hydra_actuator.core.choices import all_at_most
from hydra_actuator.core.compilation import formula
from hydra_actuator.core.fluid import riemann_variable
from hydra_actuator.core.junctions import solve_junction
from hydra_actuator.core.lanes import element, load, put, WIDTH
from hydra_actuator.core.records import ORIFICE, PISTON, PRESSURE, PUMP, VALVE
from hydra_actuator.core.together.ends import end_in_lanes
from hydra_actuator.core.together.orifices import is_ring, solve_edges, solve_port
from hydra_actuator.core.together.piston import slide_together


@formula
def solve_junctions(now, models, shadows, inputs):
    """Solve all junctions of all lanes; return whether the series used hold."""
    holds = True
    for j in range(models[0].junctions.size):
        junction = models[0].junctions[j]
        kind = junction.kind
        if kind == PUMP and now.alone[0] == 0 and relieve(now, junction.end[0]):
            continue
        if kind == PRESSURE:
            hold_pressure(now, junction.end[0], junction.input)
        elif kind == ORIFICE:
            holds = solve_port(now, j, junction.end) and holds
        elif kind == VALVE and not is_ring(now):
            holds = solve_edges(now, junction.end) and holds
        elif not (kind == PISTON and now.alone[1] == 0 and slide_together(now, junction)):
            solve_alone(now, models, shadows, j, inputs)
    return holds


@formula
def solve_alone(now, models, shadows, j, inputs):
    """Solve a junction lane by lane, as each alone does."""
    for lane in range(WIDTH):
        model, shadow = models[lane], shadows[lane]
        junction = model.junctions[j]
        for k in range(4):
            end = junction.end[k]
            shadow.edge_coefficient[k] = now.edge[WIDTH * k + lane]
            if end >= 0:
                shadow.end_wave[end] = now.end_wave[WIDTH * end + lane]
                shadow.end_velocity[end] = now.end_velocity[WIDTH * end + lane]
        motion = shadow.piston[0]
        motion.position = now.motion[lane]
        motion.velocity = now.motion[WIDTH + lane]
        motion.force = now.motion[2 * WIDTH + lane]
        solve_junction(model, shadow, j, inputs[lane])
        for k in range(4):
            end = junction.end[k]
            if end >= 0:
                now.end_velocity[WIDTH * end + lane] = shadow.end_velocity[end]
            if end >= 0 and junction.kind == PISTON:
                now.length[WIDTH * (end // 2) + lane] = shadow.length[end // 2]
        if junction.kind == PISTON:
            now.moved[lane] = motion.new_position
            now.moved[WIDTH + lane] = motion.new_velocity
            now.moved[2 * WIDTH + lane] = motion.new_force


@formula
def relieve(now, end):
    """Hold the pump's end at the relief pressure; return False where the pump cannot."""
    at = end_in_lanes(now, end)
    free = at.wave - load(now.relief_mu, 0)
    drawn = -free * at.area * load(now.relief_density, 0)
    if not all_at_most(drawn, load(now.max_flow, 0)):
        return False
    put(now.end_velocity, end, free)
    return True


@formula
def hold_pressure(now, end, column):
    """Hold an end at the pressure of an input."""
    d = end // 2
    for lane in range(WIDTH):
        pressure = now.feed[WIDTH * column + lane]
        if pressure != now.tank_pressure[lane]:
            now.tank_pressure[lane] = pressure
            now.tank_mu[lane] = riemann_variable(
                pressure, 1.0 / now.slowness[WIDTH * d + lane],
                now.bulk_modulus[WIDTH * d + lane])
    put(now.end_velocity, end, element(now.end_wave, end) - load(now.tank_mu, 0))
