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
    face_value, fraction = face
    here = values[last_node]
    d_2 = here - values[last_node - 1]
    d_3, d_4 = d_2, d_2
    if cells >= 2:
        d_3 = values[last_node - 1] - values[last_node - 2]
        d_4 = d_3 + (d_3 - d_2)
    through_face = fraction >= NEAREST and cells >= 2
    if cells >= LONG or (cells >= 3 and not leaving):
        d_4 = values[last_node - 2] - values[last_node - 3]
    if not through_face:
        curve = d_2 - d_3
        twist = (d_2 - d_3) - (d_3 - d_4)
        values[last_node + 1] = here + (d_2 + (curve + twist))
        values[last_node + 2] = here + (2.0 * d_2 + (3.0 * curve + 4.0 * twist))
        values[last_node + 3] = here + (3.0 * d_2 + (6.0 * curve + 10.0 * twist))
        return
    # divided differences over the offsets 0, fraction, -1, -2, evaluated at 1, 2 and 3
    first = (face_value - here) / fraction
    second = (first - d_2) / (fraction + 1.0)
    third = (second - 0.5 * (d_2 - d_3)) / (fraction + 2.0)
    gap = 1.0 - fraction
    values[last_node + 1] = here + (first + gap * (second + 2.0 * third))
    values[last_node + 2] = here + 2.0 * (first + (gap + 1.0) * (second + 3.0 * third))
    values[last_node + 3] = here + 3.0 * (first + (gap + 2.0) * (second + 4.0 * third))


@formula
def wave_at_face(waves, node, distance, mesh, third_order, guess):
    """
    Return (W [m/s], theta [cells]) arriving at the moving face; theta counts from the face.

    waves: (P, Q); node: the last whole one; distance: of the face beyond it at arrival, in cells;
    guess: (velocity of the oil at arrival, theta of the pass before) as in `arriving_wave`.
    """
    wave_p, wave_q = waves
    courant, slope, _ = mesh
    sigma, kappa = courant[node], slope[node]
    arrival, theta = guess
    # twice the velocity, as the mesh's constants want it
    here = wave_p[node] - wave_q[node]
    rise = (wave_p[node - 1] - wave_q[node - 1]) - here
    if theta != theta:
        theta = sigma + kappa * (here + (sigma - distance) * rise)
    if arrival == arrival:
        foot = here + (theta - distance) * rise
        theta = sigma + 0.5 * kappa * (foot + 2.0 * arrival)
    wave = interpolate(
        wave_p[node + 1], wave_p[node], wave_p[node - 1], wave_p[node - 2],
        theta - distance, third_order)
    return wave, theta


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
    for node in range(old_last, new_last + 1):
        distance = state.length[domain] - node * spacing
        p = state.new_p[start + node]
        q = 0.0
        here = face_velocity
        for _ in range(len(passes)):
            lag = distance / ((wave_speed + 0.5 * (face_velocity - here)) * model.step_time)
            q = wave_from_face(state.face_q[domain], returned, lag, model.third_order)
            here = 0.5 * (p - q)
        state.new_q[start + node] = q
