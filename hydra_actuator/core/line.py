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
from hydra_actuator.core.lanes import load, multiply_add, store, WIDTH

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
    return cubic_by_slopes(behind - here, here - ahead, far - ahead, third_order)


@formula
def cubic_by_slopes(slope, slope_ahead, span, third_order):
    """Return what `cubic` does, from behind - here, here - ahead and far - ahead."""
    half_slope = (0.5 * third_order) * slope
    second = half_slope - (0.5 * third_order) * slope_ahead
    third = (third_order * (1.0 / 6.0)) * span - half_slope
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
    third_order, passes = scheme
    first, end = nodes
    for i in range(first, end, WIDTH):
        p_ahead, p_here, p_behind = load(wave_p, i + 1), load(wave_p, i), load(wave_p, i - 1)
        q_ahead, q_here, q_behind = load(wave_q, i - 1), load(wave_q, i), load(wave_q, i + 1)
        slope_p, slope_q = p_behind - p_here, q_behind - q_here
        p_falls, q_falls = p_here - p_ahead, q_here - q_ahead
        p, q = new_waves_of(
            (p_here, slope_p, p_falls, load(wave_p, i - 2) - p_ahead),
            (q_here, slope_q, q_falls, load(wave_q, i + 2) - q_ahead),
            (slope_p + q_falls, p_falls + slope_q), mesh, third_order, passes)
        store(new_p, i, p)
        store(new_q, i, q)


@formula
def new_waves_of(wave_p, wave_q, rises, mesh, third_order, passes):
    """
    Return (P, Q) of a node one step later.

    wave_p, wave_q: (here, behind - here, here - ahead, far - ahead), ahead and behind as each
    wave travels; rises: of 2 u from the node back towards the left, and from its right
    neighbour to the node; the rest as `sweep`.
    """
    p_here, p_slope, p_falls, p_span = wave_p
    q_here, q_slope, q_falls, q_span = wave_q
    rise, fall = rises
    sigma, kappa, loss = mesh
    half_kappa, half_loss = 0.5 * kappa, 0.5 * loss
    a_1, a_2, a_3 = cubic_by_slopes(p_slope, p_falls, p_span, third_order)
    b_1, b_2, b_3 = cubic_by_slopes(q_slope, q_falls, q_span, third_order)
    here = p_here - q_here
    foot_p, foot_q = here + sigma * rise, here - sigma * fall
    theta_p, theta_q = sigma + kappa * foot_p, sigma - kappa * foot_q
    lost_p, lost_q = loss * (foot_p * abs(foot_p)), loss * (foot_q * abs(foot_q))
    for _ in range(len(passes) - 1):
        arrival = (here - lost_p - lost_q) + theta_p * (a_1 + theta_p * (a_2 + theta_p * a_3))
        arrival -= theta_q * (b_1 + theta_q * (b_2 + theta_q * b_3))
        drag = arrival * abs(arrival)
        foot_p, foot_q = here + theta_p * rise, here - theta_q * fall
        theta_p = sigma + half_kappa * (foot_p + arrival)
        theta_q = sigma - half_kappa * (foot_q + arrival)
        lost_p = half_loss * (foot_p * abs(foot_p) + drag)
        lost_q = half_loss * (foot_q * abs(foot_q) + drag)
    p = (p_here - lost_p) + theta_p * (a_1 + theta_p * (a_2 + theta_p * a_3))
    q = (q_here + lost_q) + theta_q * (b_1 + theta_q * (b_2 + theta_q * b_3))
    return p, q


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
    arrival, theta = guess
    nodes = ((outgoing[node - back], outgoing[node], outgoing[node + back],
              outgoing[node + 2 * back]), (returning[node], returning[node + back]))
    return wave_between(nodes, (courant[node], slope[node], friction[node]), third_order,
                        guess, (arrival == arrival, theta == theta))


@formula
def wave_between(nodes, mesh, third_order, guess, known):
    """
    Return what `arriving_wave` does.

    nodes: ((ahead, here, behind, far) of the wave that arrives, (here, behind) of the other);
    mesh: (courant, slope, friction); known: whether the guess's velocity and theta are.
    """
    (ahead, here, behind, far), (other_here, other_behind) = nodes
    sigma, kappa, loss = mesh
    arrival, theta = guess
    knows_arrival, knows_theta = known
    # twice the velocity towards the end, v = s u, as the mesh's constants want it
    speed = here - other_here
    rise = (behind - other_behind) - speed
    if not knows_theta:
        theta = sigma + kappa * (speed + sigma * rise)
    foot = speed + theta * rise
    drag = foot * abs(foot)
    if knows_arrival:
        theta = sigma + 0.5 * kappa * (foot + 2.0 * arrival)
        drag = 0.5 * multiply_add(4.0 * arrival, abs(arrival), drag)
    return interpolate(ahead, here, behind, far, theta, third_order) - loss * drag, theta


@formula
def beyond_by_cubic(first, second, third, fourth):
    """Return the cubic through four nodes, the first at the end, one node beyond it."""
    slope = first - second
    return first + (3.0 * (slope - (second - third)) + (third - fourth))


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
        values[end - inward] = beyond_by_cubic(
            first, second, values[end + 2 * inward], values[end + 3 * inward])
    elif cells >= 2:
        values[end - inward] = first + (2.0 * slope - (second - values[end + 2 * inward]))
    else:
        values[end - inward] = first + slope
