# SPDX-License-Identifier: Apache-2.0
r"""
The piston between two chambers (Jankovic et al., equation 13), a moving boundary of both.

         chamber_1  W_E -> |      | <- W_F  chamber_2         v, x > 0 lengthen chamber_1
                   A1, p_E | mass | A2, p_F                   load_force > 0 opposes v > 0

    G(v) = m (v - v_k)/dt - th R(v) - (1 - th) R_k,   R = A1 p_E - A2 p_F - k x - delta v - F_load
    th = max(1/2, 1 - m/(Z dt)), Z = rho c (A1 + A2) + delta,   x = x_k + dt (th v + (1 - th) v_k)

Friction of the seals is set-valued at the new level: the piston rests if |G(0)| is at most the
breakaway force, else G(v) + sgn(v) F(|v|) = 0 with sgn v = -sgn G(0) (Coulomb and Stribeck).
End stops: the speed into a stop returns with its sign reversed, times the restitution; a piston
pressed against a stop rests. Leakage: q = k (p_E - p_F), rho0 q = rho_E A1 (u_E - v).
Neglected: elasticity of the rod and of the stops, tilting, cushioning.
"""

import math

from hydra_actuator.core.compilation import formula
from hydra_actuator.core.end import end_relation
from hydra_actuator.core.lanes import multiply_add
from hydra_actuator.core.orifice import settled

MOST_PASSES = 60
# Passes of a leaking piston that Newton is trusted alone; two are the rule, from rest three.
PATIENCE = 12
# Last change of the leaking flow, relative and, at balanced pressures, in m^3/s.
LEAKAGE_TOLERANCE, NO_LEAKAGE = 1e-11, 1e-20


@formula
def face_pressures(ends, piston, velocity, slip):
    """
    Return (p_E, p_F, stiffness_E, stiffness_F, u_E, u_F) at a piston velocity [m/s].

    ends: the faces of both chambers; slip: the last known (u_E - v, u_F - v) [m/s], where a
    leaking piston begins; stiffness = -dp/dv [Pa s/m]; u: the oil's velocity at each face [m/s],
    v itself unless the piston leaks.
    """
    end_1, end_2 = ends
    if piston.leakage > 0.0:
        return leaking_faces(ends, piston, velocity, slip)
    p_1, _, z_1, flatness_1 = end_relation(end_1, velocity)
    p_2, _, z_2, flatness_2 = end_relation(end_2, -velocity)
    return p_1, p_2, z_1 / flatness_1, z_2 / flatness_2, velocity, velocity


@formula
def leaking_faces(ends, piston, velocity, slip):
    """Return what `face_pressures` does, of a piston that leaks."""
    end_1, end_2 = ends
    flow, v_1, v_2 = 0.0, velocity + slip[0], -velocity - slip[1]
    p_1, p_2, z_1, z_2, flatness_1, flatness_2 = 0.0, 0.0, 0.0, 0.0, 1.0, 1.0
    low, high = -math.inf, math.inf
    for k in range(MOST_PASSES):
        p_1, _, z_1, flatness_1 = end_relation(end_1, v_1)
        p_2, _, z_2, flatness_2 = end_relation(end_2, v_2)
        if k == 0:
            flow = slip[0] * end_1.area * (1.0 + p_1 / end_1.bulk_modulus)
        defect = piston.leakage * (p_1 - p_2) - flow
        change = defect / (1.0 + piston.leakage * (z_1 + z_2))
        if k >= PATIENCE:
            # where a chamber boils Newton's step overshoots; the defect falls as the flow rises
            if defect > 0.0:
                low = flow
            else:
                high = flow
            if not low <= flow + change <= high:
                change = 0.5 * (low + high) - flow
        flow += change
        # rho A (u - v) = rho0 q, with rho from the pressure of this pass
        v_1 = velocity + flow * end_1.inverse_area / (1.0 + p_1 / end_1.bulk_modulus)
        v_2 = -velocity - flow * end_2.inverse_area / (1.0 + p_2 / end_2.bulk_modulus)
        if abs(change) <= LEAKAGE_TOLERANCE * abs(flow) + NO_LEAKAGE:
            break
    return p_1, p_2, z_1 / flatness_1, z_2 / flatness_2, v_1, -v_2


@formula
def seal_friction(piston, speed):
    """Return the seals' friction force [N] at a sliding speed [m/s], and its slope [N s/m]."""
    if piston.breakaway <= piston.coulomb:
        return piston.coulomb, 0.0
    ratio = speed / piston.stribeck_velocity
    extra = (piston.breakaway - piston.coulomb) * math.exp(-ratio * ratio)
    return piston.coulomb + extra, -2.0 * extra * ratio / piston.stribeck_velocity


@formula
def implicitness(ends, piston, step_time):
    """Return theta of the momentum balance: 1/2, more where the mass is light against the oil."""
    end_1, end_2 = ends
    damping = multiply_add(
        end_1.impedance, end_1.area ** 2, end_2.impedance * end_2.area ** 2) + piston.viscous
    return max(0.5, 1.0 - piston.mass / (damping * step_time))


@formula
def momentum_defect(ends, piston, motion, load_force, velocity):
    """
    Return (G [N], dG/dv [N s/m], R [N]) at a trial velocity [m/s].

    motion: (position, velocity, R) of the old level, theta, step time, slip (see face_pressures).
    """
    p_1, p_2, stiffness_1, stiffness_2, _, _ = face_pressures(ends, piston, velocity, motion[5])
    return balance_momentum(
        (ends[0].area, ends[1].area), (p_1, p_2, stiffness_1, stiffness_2), piston, motion,
        load_force, velocity)


@formula
def balance_momentum(areas, faces, piston, motion, load_force, velocity):
    """Return what `momentum_defect` does; faces: (p_E, p_F, stiffness_E, stiffness_F)."""
    _, v_old, force_old, theta, step_time, _ = motion
    p_1, p_2, stiffness_1, stiffness_2 = faces
    force = force_on_piston(
        areas, (p_1, p_2), piston, (position_after(motion, velocity), velocity), load_force)
    defect = (piston.mass * (velocity - v_old) / step_time
              - theta * force - (1.0 - theta) * force_old)
    softness = multiply_add(areas[0], stiffness_1, areas[1] * stiffness_2)
    slope = piston.mass / step_time + theta * (
        softness + piston.viscous + piston.stiffness * theta * step_time)
    return defect, slope, force


@formula
def position_after(motion, velocity):
    """Return the position [m] after a step that ends at a velocity [m/s]."""
    x_old, v_old, _, theta, step_time, _ = motion
    return x_old + step_time * multiply_add(theta, velocity, (1.0 - theta) * v_old)


@formula
def force_on_piston(areas, pressures, piston, place, load_force):
    """Return R [N]; place: (position [m], velocity [m/s])."""
    position, velocity = place
    oil = multiply_add(areas[0], pressures[0], -areas[1] * pressures[1])
    return oil - piston.stiffness * position - piston.viscous * velocity - load_force


@formula
def slide(ends, piston, motion, load_force, guess):
    """
    Return the velocity [m/s] of the momentum balance with seal friction, 0 when the seals hold.

    Newton's steps, kept inside a bracket that starts at rest and shrinks at each pass. G rises by
    mass/dt and more with v: where that alone takes it past the seals' hold on the way from rest to
    the guess, the piston slides that way and G(0) is not asked for.
    """
    holds = max(piston.breakaway, piston.coulomb)
    inertia = piston.mass / motion[4]
    direction = 0.0
    low, high = -math.inf, math.inf
    velocity = guess
    for _ in range(MOST_PASSES):
        defect, slope, _ = momentum_defect(ends, piston, motion, load_force, velocity)
        if holds > 0.0 and direction == 0.0:
            slides = abs(velocity) * inertia > abs(defect) + holds
            if not slides and velocity != 0.0:
                velocity = 0.0
                continue
            if not slides and abs(defect) <= holds:
                return 0.0
            direction = math.copysign(1.0, velocity if slides else -defect)
            low, high = (0.0, high) if direction > 0.0 else (low, 0.0)
            if not slides:
                velocity = -defect / slope if guess * direction <= 0.0 else guess
                continue
        if direction != 0.0:
            friction, steepness = seal_friction(piston, abs(velocity))
            defect += direction * friction
            slope += steepness
        if defect != defect:
            return defect
        if defect > 0.0:
            high = velocity
        else:
            low = velocity
        trial = velocity - defect / slope
        if not low <= trial <= high:
            trial = 0.5 * (low + high)
            if not abs(trial) < math.inf:
                trial = 2.0 * velocity
        change = trial - velocity
        velocity = trial
        if settled(velocity, change):
            break
    return velocity


@formula
def move_piston(ends, piston, motion, load_force, guess):
    """Return (position [m], velocity [m/s], hit) after one step, end stops included."""
    v_old = motion[1]
    velocity = slide(ends, piston, motion, load_force, guess)
    position = position_after(motion, velocity)
    if not abs(position) > piston.limit:
        return position, velocity, 0
    side = math.copysign(1.0, position)
    position = side * piston.limit
    if v_old * side > 0.0:
        return position, -piston.restitution * v_old, 1
    return position, 0.0, 0
