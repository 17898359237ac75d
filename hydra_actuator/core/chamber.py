# SPDX-License-Identifier: Apache-2.0
"""
A chamber's mesh: anchored at the fixed end, with a partial cell before the moving face.

    node 0      1      2          n    face           whole cells dx, nodes never move
      |------|------|-- ... --|---s--]                0 <= s < dx, face moves with the piston

The face's arriving wave is interpolated in space. Nodes from n on take their outgoing wave from
the face's path in time: it left the face g ago, x_face(t - g) = x_node + (c - u) g. With the mean
u of foot and arrival the acceleration cancels: g = d / (c + (v - u_node)/2), d the distance from
node to face at arrival. Whole nodes appear and vanish as s leaves [0, dx).
"""

from hydra_actuator.core.compilation import formula
from hydra_actuator.core.line import interpolate, LONG

# Of a cell: a face closer to the last whole node is left out of the polynomial beyond it. At one
# half and more, the waves of a chamber of three cells grow; at 0.4 and less none does.
NEAREST = 0.4


@formula
def extend_to_face(values, last_node, cells, face, leaving):
    """
    Fill three nodes beyond the last whole node, using the face where it is far enough.

    face: (value there, fraction s/dx [-] of its cell). From NEAREST on the polynomial runs
    through the face and up to three whole nodes; below (a point close to the node would amplify
    rounding) through whole nodes alone, in a short chamber as a parabola for the wave that is
    leaving the face: see fill_ghost. All ghosts lie on the same polynomial.
    A node that appears takes P from a sweep that reads the third.
    """
    _, fraction = face
    here = values[last_node]
    d_2 = here - values[last_node - 1]
    d_3, d_4 = d_2, d_2
    if cells >= 2:
        d_3 = values[last_node - 1] - values[last_node - 2]
        d_4 = d_3 + (d_3 - d_2)
    through_face = fraction >= NEAREST and cells >= 2
    if cells >= LONG or (cells >= 3 and not leaving):
        d_4 = values[last_node - 2] - values[last_node - 3]
    if through_face:
        beyond = beyond_through_face(here, face, d_2, d_3)
    else:
        beyond = beyond_through_nodes(here, d_2, d_3, d_4)
    values[last_node + 1], values[last_node + 2], values[last_node + 3] = beyond


@formula
def beyond_through_nodes(here, d_2, d_3, d_4):
    """Return three nodes beyond the last one, by it and the differences of four nodes."""
    curve = d_2 - d_3
    twist = (d_2 - d_3) - (d_3 - d_4)
    return (here + (d_2 + (curve + twist)),
            here + (2.0 * d_2 + (3.0 * curve + 4.0 * twist)),
            here + (3.0 * d_2 + (6.0 * curve + 10.0 * twist)))


@formula
def beyond_through_face(here, face, d_2, d_3):
    """Return three nodes beyond the last one, by the face and three nodes; see extend_to_face."""
    face_value, fraction = face
    # divided differences over the offsets 0, fraction, -1, -2, evaluated at 1, 2 and 3
    first = (face_value - here) / fraction
    second = (first - d_2) / (fraction + 1.0)
    third = (second - 0.5 * (d_2 - d_3)) / (fraction + 2.0)
    gap = 1.0 - fraction
    return (here + (first + gap * (second + 2.0 * third)),
            here + 2.0 * (first + (gap + 1.0) * (second + 3.0 * third)),
            here + 3.0 * (first + (gap + 2.0) * (second + 4.0 * third)))


@formula
def wave_at_face(waves, node, distance, mesh, third_order, guess):
    """
    Return (W [m/s], theta [cells]) arriving at the moving face; theta counts from the face.

    waves: (P, Q); node: the last whole one; distance: of the face beyond it at arrival, in cells;
    guess: (velocity of the oil at arrival, theta of the pass before) as in `arriving_wave`.
    """
    wave_p, wave_q = waves
    courant, slope, _ = mesh
    arrival, theta = guess
    nodes = ((wave_p[node + 1], wave_p[node], wave_p[node - 1], wave_p[node - 2]),
             (wave_q[node], wave_q[node - 1]))
    return wave_before_face(nodes, distance, (courant[node], slope[node]), third_order, guess,
                            (arrival == arrival, theta == theta))


@formula
def wave_before_face(nodes, distance, mesh, third_order, guess, known):
    """
    Return what `wave_at_face` does.

    nodes: (P (beyond the last whole node, there, behind, far), Q (there, behind)); mesh:
    (courant, slope); known: whether the guess's velocity and theta are.
    """
    (ahead, here, behind, far), (other_here, other_behind) = nodes
    sigma, kappa = mesh
    arrival, theta = guess
    knows_arrival, knows_theta = known
    # twice the velocity, as the mesh's constants want it
    speed = here - other_here
    rise = (behind - other_behind) - speed
    if not knows_theta:
        theta = sigma + kappa * (speed + (sigma - distance) * rise)
    if knows_arrival:
        foot = speed + (theta - distance) * rise
        theta = sigma + 0.5 * kappa * (foot + 2.0 * arrival)
    return interpolate(ahead, here, behind, far, theta - distance, third_order), theta


@formula
def wave_from_face(history, returned, lag, third_order):
    """
    Return Q [m/s] that left the face `lag` steps before the new level, by a parabola in time.

    returned: Q of the new level; history: of the levels before. A cubic over three levels before
    lets chambers of three to twelve cells ring up.
    """
    d_1 = history[0] - returned
    d_2 = history[1] - history[0]
    return returned + lag * (d_1 + third_order * (lag - 1.0) * (0.5 * (d_2 - d_1)))


@formula
def renew_last_nodes(model, state, domain, new_last, returned, passes):
    """
    Write the wave that left the face into the nodes its path feeds, from old last to new.

    returned: the wave that leaves the face now [m/s].
    """
    start, old_last = model.start[domain], state.last[domain]
    end = 2 * domain + 1
    face_velocity = state.end_velocity[end]
    spacing, wave_speed = model.spacing[domain], model.wave_speed[domain]
    history = (state.face_q[domain, 0], state.face_q[domain, 1])
    speeds = (face_velocity, wave_speed, model.step_time)
    for node in range(old_last, new_last + 1):
        distance = state.length[domain] - node * spacing
        state.new_q[start + node] = wave_to_node(
            state.new_p[start + node], distance, (history, returned), speeds,
            (model.third_order, passes))


@formula
def wave_to_node(p, distance, path, speeds, scheme):
    """
    Return Q [m/s] of a node that the face feeds, from its own P [m/s] and distance [m].

    path: (Q that left the face one and two levels ago, the same now); speeds: (of the face, of
    waves [m/s], step time [s]); scheme as of `sweep`.
    """
    history, returned = path
    face_velocity, wave_speed, step_time = speeds
    third_order, passes = scheme
    q, here = returned, face_velocity
    for _ in range(len(passes)):
        lag = distance / ((wave_speed + 0.5 * (face_velocity - here)) * step_time)
        q = wave_from_face(history, returned, lag, third_order)
        here = 0.5 * (p - q)
    return q
