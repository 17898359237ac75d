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
Values beyond the ends (ghosts) lie on the polynomial through the nearest nodes, so every node is
swept alike. Neglected: variation over the cross-section, frequency-dependent friction.
"""

from hydra_actuator.core.compilation import formula
from hydra_actuator.core.lanes import load, store, WIDTH

# Cells from which on no wave grows with cubics at both ends, whatever the Courant number, the next
# line and what the ends reflect; with a parabola none does in shorter lines either.
LONG = 8

# Spare nodes beyond each end; beyond a moving face.
GHOSTS, GHOSTS_BEYOND_FACE = 1, 3


@formula
def cubic(ahead, here, behind, far, third_order):
    """
    Return (b1, b2, b3) of here + theta (b1 + theta (b2 + theta b3)).

    The polynomial through offsets -1 (ahead), 0 (here), 1 (behind) and 2 (far), which count cells
    against the direction of travel; third_order 1 is the cubic, 0 the line through 0 and 1.
    """
    slope = behind - here
    half_slope = (0.5 * third_order) * slope
    second = (0.5 * third_order) * (ahead - here) + half_slope
    third = (third_order * (1.0 / 6.0)) * (far - ahead) - half_slope
    return slope - second - third, second, third


@formula
def interpolate(ahead, here, behind, far, theta, third_order):
    """Return the value `theta` cells behind `here`; see `cubic`."""
    b_1, b_2, b_3 = cubic(ahead, here, behind, far, third_order)
    return here + theta * (b_1 + theta * (b_2 + theta * b_3))


@formula
def sweep(waves, new_waves, mesh, nodes, scheme):
    """
    Write P and Q [m/s] one step later into new_waves, at the nodes of one domain.

    waves: (P, Q); mesh: its (courant, slope, friction): c dt/dx [-], dt/dx / 2 [s/m],
    lambda dt / 8 [s/m], the last two for velocities 2 u = P - Q; nodes: (first, end) of the node
    arrays; scheme: (third_order, a tuple whose length is the number of passes, so that the
    compiler unrolls them). Nodes go WIDTH at a time: up to WIDTH - 1 beyond the end are written
    too, and two more are read.
    """
    wave_p, wave_q = waves
    new_p, new_q = new_waves
    sigma, kappa, loss = mesh
    half_kappa, half_loss = 0.5 * kappa, 0.5 * loss
    third_order, passes = scheme
    first, end = nodes
    for i in range(first, end, WIDTH):
        p_far, p_behind, p_here = load(wave_p, i - 2), load(wave_p, i - 1), load(wave_p, i)
        p_ahead, q_ahead = load(wave_p, i + 1), load(wave_q, i - 1)
        q_here, q_behind, q_far = load(wave_q, i), load(wave_q, i + 1), load(wave_q, i + 2)
        a_1, a_2, a_3 = cubic(p_ahead, p_here, p_behind, p_far, third_order)
        b_1, b_2, b_3 = cubic(q_ahead, q_here, q_behind, q_far, third_order)
        here = p_here - q_here
        rise_p = (p_behind - p_here) - (q_ahead - q_here)
        rise_q = (p_ahead - p_here) - (q_behind - q_here)
        foot_p, foot_q = here + sigma * rise_p, here + sigma * rise_q
        theta_p, theta_q = sigma + kappa * foot_p, sigma - kappa * foot_q
        lost_p, lost_q = loss * (foot_p * abs(foot_p)), loss * (foot_q * abs(foot_q))
        for _ in range(len(passes) - 1):
            arrival = (here - lost_p - lost_q) + theta_p * (a_1 + theta_p * (a_2 + theta_p * a_3))
            arrival -= theta_q * (b_1 + theta_q * (b_2 + theta_q * b_3))
            drag = arrival * abs(arrival)
            foot_p, foot_q = here + theta_p * rise_p, here + theta_q * rise_q
            theta_p = sigma + half_kappa * (foot_p + arrival)
            theta_q = sigma - half_kappa * (foot_q + arrival)
            lost_p = half_loss * (foot_p * abs(foot_p) + drag)
            lost_q = half_loss * (foot_q * abs(foot_q) + drag)
        p = (p_here - lost_p) + theta_p * (a_1 + theta_p * (a_2 + theta_p * a_3))
        q = (q_here + lost_q) + theta_q * (b_1 + theta_q * (b_2 + theta_q * b_3))
        store(new_p, i, p)
        store(new_q, i, q)


@formula
def inner_nodes(model, state, d):
    """
    Return (first, end) of the nodes between the ends of a domain.

    In a chamber also the last whole node and the next: it may appear.
    """
    first = model.start[d] + 1
    return first, first + state.last[d] - 1 + 2 * model.moving[d]


@formula
def sweep_domain(model, state, nodes, passes):
    """Sweep nodes (first, end) of one domain, into new_p and new_q."""
    first, _ = nodes
    sweep((state.wave_p, state.wave_q), (state.new_p, state.new_q),
          (model.courant[first], model.slope[first], model.friction[first]), nodes,
          (model.third_order, passes))


@formula
def sweep_domains(model, state, passes):
    """Sweep all nodes between the ends of every domain, into new_p and new_q."""
    for d in range(model.start.size):
        sweep_domain(model, state, inner_nodes(model, state, d), passes)


@formula
def arriving_wave(outgoing, returning, node, side, mesh, third_order, guess):
    """
    Return (W [m/s], theta [-]): the wave that reaches a fixed end, and its foot in cells behind.

    outgoing, returning: the arrays of the wave that arrives (P at a right end, side 1; Q at a
    left) and of the other one. guess: (outflow velocity at arrival [m/s], NaN to use the foot
    alone; theta of the pass before, NaN in the first).
    """
    courant, slope, friction = mesh
    back = -1 if side == 1 else 1
    sigma, kappa, loss = courant[node], slope[node], friction[node]
    arrival, theta = guess
    # twice the velocity towards the end, v = s u, as the mesh's constants want it
    here = outgoing[node] - returning[node]
    rise = (outgoing[node + back] - returning[node + back]) - here
    if theta != theta:
        theta = sigma + kappa * (here + sigma * rise)
    foot = here + theta * rise
    drag = foot * abs(foot)
    if arrival == arrival:
        theta = sigma + 0.5 * kappa * (foot + 2.0 * arrival)
        drag = 0.5 * (drag + 4.0 * arrival * abs(arrival))
    wave = interpolate(
        outgoing[node - back], outgoing[node], outgoing[node + back],
        outgoing[node + 2 * back], theta, third_order)
    return wave - loss * drag, theta


@formula
def fill_ghost(values, end, inward, cells, leaving):
    """
    Continue `values` one node beyond the node `end` by the polynomial through the inner nodes.

    inward is the step (+1 or -1) towards the inside. A cubic for the wave that arrives at the
    end and, from LONG cells on, for the one that is leaving it; a parabola (still third-order
    interpolation) for the latter in shorter lines, which would ring up with a cubic that looks
    downstream alone. The order drops below three cells. Written in differences: a constant stays
    constant to the last bit.
    """
    first, second = values[end], values[end + inward]
    slope = first - second
    if cells >= LONG or (cells >= 3 and not leaving):
        third, fourth = values[end + 2 * inward], values[end + 3 * inward]
        values[end - inward] = first + (3.0 * (slope - (second - third)) + (third - fourth))
    elif cells >= 2:
        values[end - inward] = first + (2.0 * slope - (second - values[end + 2 * inward]))
    else:
        values[end - inward] = first + slope
