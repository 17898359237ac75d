# SPDX-License-Identifier: Apache-2.0
"""
Change the free gas in the oil of a chain between two steps.

The gas appears, or goes, at the pressure that there is: no pressure and no velocity jumps, the
oil only becomes softer or stiffer.
"""

from dataclasses import replace

from hydra_actuator.core.cavity import face_strength
from hydra_actuator.core.line import GHOSTS, GHOSTS_BEYOND_FACE
from hydra_actuator.core.oil import gas_constants, Oil
from hydra_actuator.core.records import Model, State
import numpy as np

# Of ambient less vapour pressure: where gas begins in oil that was below what gas can have.
LEAST = 1e-3


def set_gas(model: Model, state: State, air_fraction: float) -> Model:
    """
    Return the model with this much free gas by volume at ambient pressure, 0 for none.

    The arrays of `model` and `state` are changed in place; where a plain chain gets gas or loses
    it, the model returned has other `extras`, and the one given is of no more use.
    """
    strength, end_strength = gas_constants(
        Oil(0.0, air_fraction=air_fraction, floor=model.floor), model.wave_speed, model.spacing,
        model.step_time)
    had_gas = model.gas == 1
    for d, first in enumerate(model.start):
        model.strength[first + 1:first + model.capacity[d] + model.moving[d]] = strength[d]
        if not had_gas:
            _begin_at_the_pressure_there_is(model, state, d)
    model.end_strength[:] = end_strength
    for d in range(len(model.start)):
        place_gas(model, state, d)
    state.mass['began'] = 0
    if air_fraction > 0.0:
        return replace(model, gas=1, extras=(1,))
    counts = state.cavities
    counts['collapsed'] += counts['open']
    counts['open'] = 0
    state.was_open[:] = 0
    state.lowest_star[:] = np.inf
    return replace(model, gas=0, extras=(1,) if model.tabled else ())


def place_gas(model: Model, state: State, d: int) -> None:
    """Give a domain's gas to its nodes, and that beside a moving face to the face, at their p*."""
    first, end = model.start[d], model.start[d] + model.capacity[d] + 1
    state.strength[first:end] = model.strength[first:end]
    if model.moving[d]:
        state.strength[first + state.last[d]:end] = 0.0
        state.face_held[d] = face_strength.py_func(model, state, d) / state.end_star[2 * d + 1]


def _begin_at_the_pressure_there_is(model: Model, state: State, d: int) -> None:
    """Write absolute less vapour pressure of a domain's nodes and ends."""
    def star(twice_mu):
        pressure = model.bulk_modulus[d] * np.expm1(0.5 * twice_mu / model.wave_speed[d])
        return np.maximum(model.floor + pressure, LEAST * model.floor)

    first, last = model.start[d], model.start[d] + state.last[d]
    after = GHOSTS_BEYOND_FACE if model.moving[d] else GHOSTS
    nodes = slice(first - GHOSTS, first + model.capacity[d] + 1 + after)
    state.star[nodes] = star(state.wave_p[nodes] + state.wave_q[nodes])
    state.end_star[2 * d] = state.star[first]
    state.end_star[2 * d + 1] = (
        star(state.face_p[d] + state.face_q[d, 0]) if model.moving[d] else state.star[last])
