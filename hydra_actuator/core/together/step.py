# SPDX-License-Identifier: Apache-2.0
"""
One time step of four actuators, one in each lane: hydra_actuator.core.step, lane by lane.

Each lane has the bits it has alone: the formulas are those of the step alone. What few have goes
one by one; see hydra_actuator.core.together.junctions.
"""

from hydra_actuator.core.chamber import (
    beyond_through_face,
    beyond_through_nodes,
    NEAREST,
    wave_before_face,
    wave_to_node,
)
from hydra_actuator.core.choices import where_at_most
from hydra_actuator.core.compilation import formula
from hydra_actuator.core.lanes import element, gather, load, put, scatter, store, WIDTH
from hydra_actuator.core.line import beyond_by_cubic, LONG, new_waves_of, wave_between
from hydra_actuator.core.together.junctions import solve_junctions
from hydra_actuator.core.together.spools import move_spools_together


@formula
def step_together(now, models, shadows, inputs, passes):
    """
    Advance all by one step of their own; return whether it holds.

    False: a mesh got shorter than LONG cells or longer than its room, or oil so fast or dense
    that the step alone has other formulas for it; nothing is then worth keeping.
    """
    move_spools_together(now, models)
    fill_ghosts(now)
    sweep_lanes(now, passes)
    extrapolate(now)
    holds = True
    for k in range(max(1, len(passes) - 1)):
        carry_waves(now, (len(passes) > 1, k > 0))
        holds = solve_junctions(now, models, shadows, inputs) and holds
    holds = take_level(now, passes) and holds
    for k in range(3):
        put(now.motion, k, element(now.moved, k))
    for lane in range(WIDTH):
        count_step(shadows[lane])
    return holds


@formula
def count_step(shadow):
    """Let what was solved alone be where it is at the new level."""
    shadow.piston[0].stop_hits += shadow.piston[0].hit
    shadow.piston[0].hit = 0
    shadow.oil_stored[0] = shadow.oil_stored[1]
    shadow.step[0] += 1


@formula
def fill_ghosts(now):
    """Fill the ghost nodes of all domains."""
    for d in range(now.start.size):
        first = now.start[d]
        for values in (now.wave_p, now.wave_q):
            put(values, first - 1, beyond_by_cubic(
                element(values, first), element(values, first + 1),
                element(values, first + 2), element(values, first + 3)))
        if now.moving[d] == 1:
            fraction = (element(now.old_length, d) / element(now.spacing, d)
                        - lanes_of_count(now, d))
            extend_to_faces(now, now.wave_p, d, element(now.face_p, d), fraction)
            extend_to_faces(now, now.wave_q, d, element(now.face_q, 3 * d), fraction)
        else:
            for values in (now.wave_p, now.wave_q):
                scatter(values, now.place, WIDTH * d, WIDTH, beyond_by_cubic(
                    gather(values, now.place, WIDTH * d, 0),
                    gather(values, now.place, WIDTH * d, -WIDTH),
                    gather(values, now.place, WIDTH * d, -2 * WIDTH),
                    gather(values, now.place, WIDTH * d, -3 * WIDTH)))


@formula
def lanes_of_count(now, d):
    """Return the whole cells of a domain as lanes."""
    for lane in range(WIDTH):
        now.work[lane] = now.last[WIDTH * d + lane]
    return load(now.work, 0)


@formula
def extend_to_faces(now, values, d, face_value, fraction):
    """Fill three nodes beyond the last whole node of a chamber, in every lane."""
    here = gather(values, now.place, WIDTH * d, 0)
    second = gather(values, now.place, WIDTH * d, -WIDTH)
    third = gather(values, now.place, WIDTH * d, -2 * WIDTH)
    d_2, d_3 = here - second, second - third
    d_4 = third - gather(values, now.place, WIDTH * d, -3 * WIDTH)
    a_1, a_2, a_3 = beyond_through_nodes(here, d_2, d_3, d_4)
    b_1, b_2, b_3 = beyond_through_face(here, (face_value, fraction), d_2, d_3)
    nearest = NEAREST + 0.0 * fraction
    scatter(values, now.place, WIDTH * d, WIDTH, where_at_most(nearest, fraction, b_1, a_1))
    scatter(values, now.place, WIDTH * d, 2 * WIDTH, where_at_most(nearest, fraction, b_2, a_2))
    scatter(values, now.place, WIDTH * d, 3 * WIDTH, where_at_most(nearest, fraction, b_3, a_3))


@formula
def sweep_lanes(now, passes):
    """Sweep all nodes between the ends of every domain, up to the longest lane's."""
    for d in range(now.start.size):
        longest = 0
        for lane in range(WIDTH):
            longest = max(longest, now.last[WIDTH * d + lane])
        mesh = (element(now.courant, d), element(now.slope, d), element(now.friction, d))
        first = now.start[d] + 1
        p, q = now.wave_p, now.wave_q
        # what a node and the next both need is carried on
        slope_p = element(p, first - 1) - element(p, first)
        q_falls = element(q, first) - element(q, first - 1)
        rise = slope_p + q_falls
        for i in range(first, first + longest - 1 + 2 * now.moving[d]):
            p_here, p_ahead = element(p, i), element(p, i + 1)
            q_here = element(q, i)
            p_falls, slope_q = p_here - p_ahead, element(q, i + 1) - q_here
            fall = p_falls + slope_q
            new_p, new_q = new_waves_of(
                (p_here, slope_p, p_falls, element(p, i - 2) - p_ahead),
                (q_here, slope_q, q_falls, element(q, i + 2) - element(q, i - 1)),
                (rise, fall), mesh, now.third_order, passes)
            put(now.new_p, i, new_p)
            put(now.new_q, i, new_q)
            slope_p, q_falls, rise = p_falls, slope_q, fall


@formula
def extrapolate(now):
    """Let the outflow velocities of all ends go on as they went in the last step."""
    for end in range(2 * now.start.size):
        velocity = element(now.end_velocity, end)
        put(now.end_velocity, end,
            velocity + (velocity - element(now.end_velocity_before, end)))
        put(now.end_velocity_before, end, velocity)


@formula
def carry_waves(now, known):
    """Carry the waves to all ends; known: whether velocity and theta of the guess are."""
    for d in range(now.start.size):
        first, left, right = now.start[d], 2 * d, 2 * d + 1
        mesh = (element(now.courant, d), element(now.slope, d), element(now.friction, d))
        p, q = now.wave_p, now.wave_q
        wave, theta = wave_between(
            ((element(q, first - 1), element(q, first), element(q, first + 1),
              element(q, first + 2)), (element(p, first), element(p, first + 1))),
            mesh, now.third_order, guess_of(now, left), known)
        put(now.end_wave, left, wave)
        put(now.end_theta, left, theta)
        at = WIDTH * d
        nodes = (
            (gather(p, now.place, at, WIDTH), gather(p, now.place, at, 0),
             gather(p, now.place, at, -WIDTH), gather(p, now.place, at, -2 * WIDTH)),
            (gather(q, now.place, at, 0), gather(q, now.place, at, -WIDTH)))
        if now.moving[d] == 1:
            if not known[1]:
                put(now.length, d, element(now.old_length, d) + 0.5 * load(now.step_time, 0) * (
                    element(now.old_velocity, d) + element(now.end_velocity, right)))
            distance = element(now.length, d) / element(now.spacing, d) - lanes_of_count(now, d)
            wave, theta = wave_before_face(
                nodes, distance, (mesh[0], mesh[1]), now.third_order, guess_of(now, right), known)
        else:
            wave, theta = wave_between(
                nodes, mesh, now.third_order, guess_of(now, right), known)
        put(now.end_wave, right, wave)
        put(now.end_theta, right, theta)


@formula
def guess_of(now, end):
    """Return (outflow velocity, theta) an arriving wave starts from."""
    return element(now.end_velocity, end), element(now.end_theta, end)


@formula
def take_level(now, passes):
    """Write the ends into the field, move the meshes; return whether all of them hold."""
    holds = True
    for d in range(now.start.size):
        left, right, at = 2 * d, 2 * d + 1, WIDTH * d
        put(now.new_q, now.start[d], element(now.end_wave, left))
        put(now.new_p, now.start[d],
            element(now.end_wave, left) - 2.0 * element(now.end_velocity, left))
        arrived, velocity = element(now.end_wave, right), element(now.end_velocity, right)
        returned = arrived - 2.0 * velocity
        if now.moving[d] == 1:
            store(now.work, WIDTH, element(now.length, d) / element(now.spacing, d))
            gained = 0
            for lane in range(WIDTH):
                cells = int(now.work[WIDTH + lane])
                holds = holds and LONG <= cells <= now.capacity[at + lane]
                gained = max(gained, cells - now.last[at + lane])
            # a face faster than sound uncovers nodes that no sweep has been to
            holds = holds and gained <= 1
            if holds:
                renew_nodes(now, d, gained, returned, passes)
                for lane in range(WIDTH):
                    cells = int(now.work[WIDTH + lane])
                    now.place[at + lane] += WIDTH * (cells - now.last[at + lane])
                    now.last[at + lane] = cells
            for k in range(2, 0, -1):
                put(now.face_q, 3 * d + k, element(now.face_q, 3 * d + k - 1))
            put(now.face_q, 3 * d, returned)
            put(now.face_p, d, arrived)
            put(now.old_length, d, element(now.length, d))
            put(now.old_velocity, d, velocity)
        else:
            scatter(now.new_p, now.place, at, 0, arrived)
            scatter(now.new_q, now.place, at, 0, returned)
    return holds


@formula
def renew_nodes(now, d, gained, returned, passes):
    """Write the wave that left the faces into the nodes it feeds; work[WIDTH:] is new cells."""
    at = WIDTH * d
    path = ((element(now.face_q, 3 * d), element(now.face_q, 3 * d + 1)), returned)
    speeds = (element(now.end_velocity, 2 * d + 1), element(now.wave_speed, d),
              load(now.step_time, 0))
    for k in range(max(gained, 0) + 1):
        node = lanes_of_count(now, d) + 1.0 * k
        distance = element(now.length, d) - node * element(now.spacing, d)
        q = wave_to_node(gather(now.new_p, now.place, at, WIDTH * k), distance, path, speeds,
                         (now.third_order, passes))
        store(now.work, 0, q)
        for lane in range(WIDTH):
            if now.last[at + lane] + k <= int(now.work[WIDTH + lane]):
                now.new_q[now.place[at + lane] + WIDTH * k] = now.work[lane]
