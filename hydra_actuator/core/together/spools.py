# SPDX-License-Identifier: Apache-2.0
"""The spools of four valves and their edges, one in each lane; see hydra_actuator.core.valve."""

import math

from hydra_actuator.core.choices import at_least, at_most, where_at_most, where_positive
from hydra_actuator.core.compilation import formula
from hydra_actuator.core.lanes import element, load, put
from hydra_actuator.core.records import VALVE
from hydra_actuator.core.valve import LEAST_CONDUCTANCE, let_go


@formula
def move_spools_together(now, models):
    """Move the spools of all lanes and set the opening of their edges."""
    for j in range(models[0].junctions.size):
        junction = models[0].junctions[j]
        if junction.kind == VALVE:
            for k in range(2):
                command = element(now.feed, junction.input + k) * load(now.stroke, 0)
                moved, speed = spool_after(
                    now, element(now.spool, 2 * k), element(now.spool, 2 * k + 1), command)
                put(now.spool, 2 * k, moved)
                put(now.spool, 2 * k + 1, speed)
    spool_1, spool_2 = element(now.spool, 0), element(now.spool, 2)
    put(now.edge, 0, conductances(now, 0, spool_1))
    put(now.edge, 1, conductances(now, 1, -spool_2))
    put(now.edge, 2, conductances(now, 2, -spool_1))
    put(now.edge, 3, conductances(now, 3, spool_2))


@formula
def conductances(now, edge, displacement):
    """Return K' of an edge in every lane, 0 where it overlaps."""
    beyond = displacement - element(now.overlap, edge)
    nothing = 0.0 * abs(beyond)
    k = element(now.flow_gain, edge) * where_positive(beyond, beyond, nothing)
    return where_at_most(nothing + LEAST_CONDUCTANCE, k, k, nothing)


@formula
def spool_after(now, position, velocity, command):
    """Return (displacement [m], velocity [m/s]) of a spool in every lane: `move_spool`."""
    stroke, step_time = load(now.stroke, 0), load(now.step_time, 0)
    frequency, slew_rate = load(now.natural_frequency, 0), load(now.slew_rate, 0)
    target = where_at_most(abs(command), stroke, command, math.copysign(stroke, command))
    let, speed = let_go(
        (element(now.transition, 0), element(now.transition, 1),
         element(now.transition, 2), element(now.transition, 3)), position - target, velocity)
    moved = where_positive(frequency, let + target, target)
    speed = where_positive(frequency, speed, (moved - position) / step_time)
    reach = slew_rate * step_time
    way = moved - position
    held = where_at_most(abs(way), reach, moved, position + math.copysign(reach, way))
    slowed = at_most(at_least(speed, -slew_rate), slew_rate)
    moved = where_positive(slew_rate, held, moved)
    speed = where_positive(slew_rate, slowed, speed)
    inside = where_at_most(abs(moved), stroke, moved, math.copysign(stroke, moved))
    return inside, where_at_most(abs(moved), stroke, speed, 0.0 * speed)
