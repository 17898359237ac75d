# SPDX-License-Identifier: Apache-2.0
r"""
The oil in a line: two families of characteristics on a mesh at rest (Jankovic et al., eq. 5).

    along dx/dt = u + c:  d(mu + u)/dt = -1/2 lambda u|u|         P = mu + u
    along dx/dt = u - c:  d(mu - u)/dt = +1/2 lambda u|u|         Q = mu - u

      t + dt        (i)            The new P of node i comes from the foot of its characteristic,
                   / \            theta = (c + u) dt/dx cells behind it, by cubic interpolation
      t    (i-1)  /   \  (i+1)    over nodes i-2 .. i+1; Q the same, mirrored.
             foot      foot

u along a characteristic is taken at the foot in the first pass, then as the mean of foot and
arrival, for the slope and for u|u|: second order in time. u at the foot itself is interpolated
linearly between its two neighbours: its error, theta (1 - theta) dx^2 u_xx / 2 with theta near
one, enters only multiplied by u/c or lambda. A departure from the paper, whose net of
characteristics runs freely: here all nodes share one dt.
Values beyond the ends (ghosts) lie on the polynomial through the four nearest nodes, so every
node is swept alike. Neglected: variation over the cross-section, frequency-dependent friction.
"""

from hydra_actuator.core.compilation import formula

GHOSTS = 2


@formula
def interpolate(ahead, here, behind, far, theta, third_order):
    """
    Return the cubic through offsets -1 (ahead), 0 (here), 1, 2 (far), at offset theta.

    Offsets count cells against the direction of travel. third_order 1 is the cubic, 0 linear.
    """
    slope = behind - here
    second = third_order * (0.5 * (slope + (ahead - here)))
    third = third_order * ((far - ahead) * (1.0 / 6.0) - 0.5 * slope)
    return here + theta * ((slope - second - third) + theta * (second + theta * third))


@formula
def sweep(wave_p, wave_q, new_p, new_q, mesh, count, third_order, passes):
    """
    Write P and Q [m/s] one step later into new_p[2:count+2] and new_q[2:count+2].

    mesh: (courant, slope, friction) of every node: c dt/dx [-], dt/dx [s/m], lambda dt/2 [s/m].
    passes: a tuple whose length is the number of passes (so the compiler unrolls them).
    The offsets start at 0 and run forward, which lets the loop vectorise.
    """
    courant, slope, friction = mesh
    for i in range(count):
        q_behind, q_here, q_ahead = wave_q[i + 1], wave_q[i + 2], wave_q[i + 3]
        p_behind, p_here, p_ahead = wave_p[i + 1], wave_p[i + 2], wave_p[i + 3]
        p_far, q_far = wave_p[i], wave_q[i + 4]
        sigma, kappa, loss = courant[i + 2], slope[i + 2], friction[i + 2]
        here = 0.5 * (p_here - q_here)
        rise_p = 0.5 * (p_behind - q_behind) - here
        rise_q = 0.5 * (p_ahead - q_ahead) - here
        foot_p = here + sigma * rise_p
        foot_q = here + sigma * rise_q
        theta_p = sigma + kappa * foot_p
        theta_q = sigma - kappa * foot_q
        p = interpolate(p_ahead, p_here, p_behind, p_far, theta_p, third_order)
        q = interpolate(q_behind, q_here, q_ahead, q_far, theta_q, third_order)
        p -= loss * foot_p * abs(foot_p)
        q += loss * foot_q * abs(foot_q)
        for _ in range(len(passes) - 1):
            arrival = 0.5 * (p - q)
            foot_p = here + theta_p * rise_p
            foot_q = here + theta_q * rise_q
            theta_p = sigma + 0.5 * kappa * (foot_p + arrival)
            theta_q = sigma - 0.5 * kappa * (foot_q + arrival)
            p = interpolate(p_ahead, p_here, p_behind, p_far, theta_p, third_order)
            q = interpolate(q_behind, q_here, q_ahead, q_far, theta_q, third_order)
            p -= 0.5 * loss * (foot_p * abs(foot_p) + arrival * abs(arrival))
            q += 0.5 * loss * (foot_q * abs(foot_q) + arrival * abs(arrival))
        new_p[i + 2] = p
        new_q[i + 2] = q


@formula
def arriving_wave(outgoing, returning, node, side, mesh, third_order, last_pass):
    """
    Return (W [m/s], theta [-]): the wave that reaches a fixed end, and its foot in cells behind.

    outgoing, returning: the arrays of the wave that arrives (P at a right end, side 1; Q at a
    left) and of the other one. last_pass: (outflow velocity [m/s], theta) of the pass before;
    a NaN velocity marks the first pass, which uses the foot alone.
    """
    courant, slope, friction = mesh
    back = -1 if side == 1 else 1
    sigma, kappa, loss = courant[node], slope[node], friction[node]
    arrival, theta = last_pass
    # v = s u is the velocity towards the end, and W = mu + v, whichever the side
    here = 0.5 * (outgoing[node] - returning[node])
    rise = 0.5 * (outgoing[node + back] - returning[node + back]) - here
    if arrival != arrival:
        foot = here + sigma * rise
        theta = sigma + kappa * foot
        drag = foot * abs(foot)
    else:
        foot = here + theta * rise
        theta = sigma + 0.5 * kappa * (foot + arrival)
        drag = 0.5 * (foot * abs(foot) + arrival * abs(arrival))
    wave = interpolate(
        outgoing[node - back], outgoing[node], outgoing[node + back],
        outgoing[node + 2 * back], theta, third_order)
    return wave - loss * drag, theta


@formula
def fill_ghosts(values, end, inward, cells):
    """
    Continue `values` two nodes beyond the node `end` by the polynomial through the inner nodes.

    inward is the step (+1 or -1) towards the inside; the order drops below three cells. Written
    in differences, so that a constant stays constant to the last bit.
    """
    first = values[end]
    d_1 = first - values[end + inward]
    d_2, d_3 = 0.0, 0.0
    if cells >= 2:
        d_2 = d_1 - (values[end + inward] - values[end + 2 * inward])
    if cells >= 3:
        inner = values[end + 2 * inward] - values[end + 3 * inward]
        d_3 = d_2 - ((values[end + inward] - values[end + 2 * inward]) - inner)
    values[end - inward] = first + (d_1 + (d_2 + d_3))
    values[end - 2 * inward] = first + (2.0 * d_1 + (3.0 * d_2 + 4.0 * d_3))
