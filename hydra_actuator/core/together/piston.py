# SPDX-License-Identifier: Apache-2.0
"""The pistons of four actuators, one in each lane; see hydra_actuator.core.piston."""

from typing import NamedTuple

from hydra_actuator.core.choices import all_at_most, at_least, where_at_most, where_positive
from hydra_actuator.core.compilation import formula
from hydra_actuator.core.lanes import element, load, put
from hydra_actuator.core.orifice_lanes import relation_in_lanes, still_moves
from hydra_actuator.core.piston import balance_momentum, force_on_piston, position_after
from hydra_actuator.core.together.ends import end_in_lanes

# A lane that needs more is done alone.
MOST_PISTON_PASSES = 12
FAR = 1e300            # [m/s]: no velocity is beyond it


class PistonLanes(NamedTuple):
    """What the momentum balance knows of the pistons, in every lane."""

    mass: object
    stiffness: object
    viscous: object


@formula
def slide_together(now, junction):
    """
    Move pistons without seals and their faces; return False where one must be done alone.

    `slide` with nothing that holds: Newton inside a bracket.
    """
    ends = (end_in_lanes(now, junction.end[0]), end_in_lanes(now, junction.end[1]))
    piston = PistonLanes(load(now.mass, 0), load(now.stiffness, 0), load(now.viscous, 0))
    motion = (element(now.motion, 0), element(now.motion, 1), element(now.motion, 2),
              load(now.theta, 0), load(now.step_time, 0), 0.0)
    load_force = element(now.feed, junction.input)
    areas = (ends[0].area, ends[1].area)
    velocity = ends[0].velocity
    nothing = 0.0 * load_force
    low, high = nothing - FAR, nothing + FAR
    unsettled, strain = nothing + 1.0, nothing
    for _ in range(MOST_PISTON_PASSES):
        faces, strained = faces_together(ends, velocity)
        strain = at_least(strain, strained)
        defect, slope, _ = balance_momentum(areas, faces, piston, motion, load_force, velocity)
        high = where_positive(defect, velocity, high)
        low = where_positive(defect, low, velocity)
        trial = velocity - defect / slope
        middle = 0.5 * (low + high)
        trial = where_at_most(low, trial, where_at_most(trial, high, trial, middle), middle)
        change = trial - velocity
        velocity = where_positive(unsettled, trial, velocity)
        unsettled = still_moves(velocity, change, unsettled)
        if all_at_most(unsettled, nothing):
            break
    faces, strained = faces_together(ends, velocity)
    position = position_after(motion, velocity)
    if not (all_at_most(at_least(strain, strained), nothing + 1.0)
            and all_at_most(unsettled, nothing)
            and all_at_most(abs(position), load(now.limit, 0))):
        return False
    put(now.moved, 0, position)
    put(now.moved, 1, velocity)
    put(now.moved, 2, force_on_piston(
        areas, (faces[0], faces[1]), piston, (position, velocity), load_force))
    put(now.end_velocity, junction.end[0], velocity)
    put(now.end_velocity, junction.end[1], -velocity)
    put(now.length, junction.end[0] // 2, load(now.length_1, 0) + position)
    put(now.length, junction.end[1] // 2, load(now.length_2, 0) - position)
    return True


@formula
def faces_together(ends, velocity):
    """Return (p_E, p_F, their stiffness), and how far into the reach of the series that is."""
    (p_1, _, z_1, flatness_1), strain_1 = relation_in_lanes(ends[0], velocity)
    (p_2, _, z_2, flatness_2), strain_2 = relation_in_lanes(ends[1], -velocity)
    return (p_1, p_2, z_1 / flatness_1, z_2 / flatness_2), at_least(strain_1, strain_2)
