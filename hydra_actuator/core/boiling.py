# SPDX-License-Identifier: Apache-2.0
"""
Where the oil boils: how large the cavities are, how many are open, how many opened and collapsed.

A place is a whole node of a domain or the face of a chamber. Its gas is V = held room / p*, with
held = alpha0 (ambient - p_v) and room its cell A dx (half of it at a fixed end; at a face half a
cell and all from the last whole node on, which has none then). Its void fraction is
held / p*; above 1 a lumped cavity has outgrown its cell.

    volume of cavities   gas beyond what it takes at ambient pressure, where p is below ambient
    a place opens        where p* falls below OPENS (ambient - p_v): a hundred times that volume
    it closes            where p* rises above CLOSES (ambient - p_v)
    a cavity             open places side by side in one domain

Counts are taken once a period, from the lowest p* of every place since the last time: a cavity
that opens and collapses in between counts as opened and as collapsed. One that does so twice
at the same places counts once. Cavities that merge count as collapsed, parts as opened: open =
opened - collapsed. Without gas all this is 0, and costs a step nothing.
"""

import math

from hydra_actuator.core.cavity import face_strength
from hydra_actuator.core.choices import at_most
from hydra_actuator.core.compilation import formula
from hydra_actuator.core.fluid import pressure_of
from hydra_actuator.core.lanes import load, store, WIDTH
import numpy as np

OPENS, CLOSES = 0.01, 0.02
# In a row of observations: what comes before the volumes of the domains.
VOLUME, LOWEST, OPEN, OPENED, COLLAPSED, OF_DOMAINS = range(6)


def gas_volumes(model, state, d: int) -> np.ndarray:
    """Return the gas [m^3] at the whole nodes of a domain with gas, then at its moving face."""
    first, last = model.start[d], model.start[d] + state.last[d]
    star = np.array(state.star[first:last + 1])
    if model.moving[d]:
        star = np.append(star, 1.0)
    volumes = gas_amounts(model, state, d) / star
    if model.moving[d]:
        volumes[-1] = state.face_held[d] * model.step_time * model.area[d]
    return volumes


def gas_amounts(model, state, d: int) -> np.ndarray:
    """
    Return held room [Pa m^3] of the same places: p* times volume.

    The last whole node of a chamber has none, its face all from the node before on.
    """
    cells = np.full(state.last[d] + 1 + model.moving[d], 2.0)
    cells[0] = cells[-1] = 1.0
    if model.moving[d]:
        cells[-2:] = 0.0, face_strength.py_func(model, state, d) / model.end_strength[d]
    return half_a_cell(model, d) * cells


def half_a_cell(model, d: int) -> float:
    """Return held room [Pa m^3] of half a cell of a domain, as an end has it."""
    return model.end_strength[d] * model.step_time * model.area[d]


@formula
def domain_cavity_volume(model, state, d):
    """Return the volume of cavities [m^3] in a domain."""
    half = model.end_strength[d] * model.step_time * model.area[d]
    at_ambient = 1.0 / model.floor
    first, last = model.start[d], model.start[d] + state.last[d]
    total = max(1.0 / state.end_star[2 * d] - at_ambient, 0.0)
    if model.moving[d] == 1:
        swollen = state.face_held[d] - face_strength(model, state, d) * at_ambient
        total += max(swollen / model.end_strength[d], 0.0)
    else:
        total += max(1.0 / state.end_star[2 * d + 1] - at_ambient, 0.0)
    for i in range(first + 1, last):
        total += 2.0 * max(1.0 / state.star[i] - at_ambient, 0.0)
    return half * total


@formula
def lowest_pressure(model, state):
    """Return the lowest gauge pressure [Pa] at any node or face now."""
    lowest = math.inf
    for d in range(model.start.size):
        first, last = model.start[d], model.start[d] + state.last[d]
        if len(model.extras) > 0 and model.end_strength[d] > 0.0:
            for i in range(first, last + 1):
                lowest = min(lowest, state.star[i] - model.floor)
            lowest = min(lowest, state.end_star[2 * d + 1] - model.floor)
        else:
            twice = math.inf
            for i in range(first, last + 1):
                twice = min(twice, state.wave_p[i] + state.wave_q[i])
            if model.moving[d] == 1:
                twice = min(twice, state.face_p[d] + state.face_q[d, 0])
            lowest = min(lowest, pressure_of(
                0.5 * twice, model.wave_speed[d], model.bulk_modulus[d]))
    return lowest


@formula
def note_lowest(model, state):
    """Keep the lowest p* [Pa] of every place since the counts were last taken."""
    nodes = state.star.size
    for d in range(model.start.size):
        first = model.start[d]
        for i in range(first, first + state.last[d] + 1, WIDTH):
            lowest = at_most(load(state.star, i), load(state.lowest_star, i))
            store(state.lowest_star, i, lowest)
        face = nodes + d
        state.lowest_star[face] = min(state.lowest_star[face], state.end_star[2 * d + 1])


@formula
def count_cavities(model, state):
    """Bring the counts of open, opened and collapsed cavities up to date; keep the largest."""
    counts = state.cavities[0]
    volume, open_now = 0.0, 0
    for d in range(model.start.size):
        volume += domain_cavity_volume(model, state, d)
        open_now += count_in_domain(model, state, counts, d)
        forget_lowest(model, state, d)
    counts.open = open_now
    counts.largest = max(counts.largest, volume)


@formula
def count_in_domain(model, state, counts, d):
    """
    Add what opened and collapsed in a domain to the counts; return how many are open.

    Places that were open, are or have been since form zones, and each zone is told by how many
    cavities it had and has.
    """
    nodes, places = state.star.size, state.last[d] + 1 + model.moving[d]
    had, has, in_zone, in_old, in_new, open_now = 0, 0, False, False, False, 0
    for k in range(places + 1):
        old, new, reached = False, False, False
        if k < places:
            i = model.start[d] + k if k <= state.last[d] else nodes + d
            star = state.star[i] if i < nodes else state.end_star[2 * d + 1]
            old = state.was_open[i] == 1
            new = star < (CLOSES if old else OPENS) * model.floor
            reached = old or new or state.lowest_star[i] < OPENS * model.floor
            state.was_open[i] = 1 if new else 0
        if in_zone and not reached:
            counts.opened += max(has - had, 0 if had + has > 0 else 1)
            counts.collapsed += max(had - has, 0 if had + has > 0 else 1)
            open_now += has
            had, has = 0, 0
        had += 1 if old and not in_old else 0
        has += 1 if new and not in_new else 0
        in_zone, in_old, in_new = reached, old, new
    return open_now


@formula
def forget_lowest(model, state, d):
    """Begin anew to keep the lowest p* of a domain; what its face has left behind is closed."""
    first = model.start[d]
    for i in range(first, first + model.capacity[d] + 1):
        state.lowest_star[i] = math.inf
        if i > first + state.last[d]:
            state.was_open[i] = 0
    state.lowest_star[state.star.size + d] = math.inf


@formula
def write_cavities(model, state, ambient_pressure, row, first):
    """Write lowest absolute pressure [Pa], volumes [m^3] and counts into a row from `first` on."""
    row[first + LOWEST] = lowest_pressure(model, state) + ambient_pressure
    row[first + VOLUME] = 0.0
    for k in range(OPEN, OF_DOMAINS + model.start.size):
        row[first + k] = 0.0
    if len(model.extras) > 0 and model.gas == 1:
        counts = state.cavities[0]
        row[first + OPEN] = counts.open
        row[first + OPENED] = counts.opened
        row[first + COLLAPSED] = counts.collapsed
        for d in range(model.start.size):
            volume = domain_cavity_volume(model, state, d)
            row[first + OF_DOMAINS + d] = volume
            row[first + VOLUME] += volume
