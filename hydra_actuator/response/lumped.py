# SPDX-License-Identifier: Apache-2.0
"""
The textbook's plant: two volumes of oil on a valve with constant supply, no line, no wave.

    C1 dp1/dt = Kq1 x - g1 p1 - G (p1 - p2) - A1 v        C = V_line/beta_line + A L/beta
    C2 dp2/dt = -Kq2 x - g2 p2 + G (p1 - p2) + A2 v
    m dv/dt = A1 p1 - A2 p2 - k y - delta v - F,  dy/dt = v

Merritt, "Hydraulic Control Systems", Wiley, 1967, chapter 6: omega_h = sqrt(4 beta A^2/(V_t M)),
delta_h = K_ce/A sqrt(beta M/V_t) + B/(4 A) sqrt(V_t/(beta M)); here for any two areas and volumes,

    omega_h^2 = (A1^2/C1 + A2^2/C2)/M
    2 omega_h delta_h = [g1 (A1/C1)^2 + g2 (A2/C2)^2 + G (A1/C1 + A2/C2)^2]/(M omega_h^2) + B/M

which are his where both sides are alike (g = 2 K_c, C = V_t/(2 beta)). beta = chi + p at the
operating point, softened by wall and free gas. Flows are volumes at the chamber's pressure.
"""

import math
from typing import NamedTuple

from hydra_actuator.response.distributed import Plant, Responses
from hydra_actuator.response.line_matrix import LineState, pressure_of_mu
from hydra_actuator.response.modes import Mode
import numpy as np


class Lumped(NamedTuple):
    """
    Coefficients of the lumped plant.

    flow_gain [m^2/s] of both sides, conductance [m^3/(s Pa)] of both, leakage past the piston,
    capacity [m^3/Pa] of both, area [m^2] of both; mass, viscous, stiffness.
    """

    flow_gain: tuple[float, float]
    conductance: tuple[float, float]
    leakage: float
    capacity: tuple[float, float]
    area: tuple[float, float]
    mass: float
    viscous: float
    stiffness: float

    @property
    def load_flow_gain(self) -> float:
        """Flow gain K_q of the load flow [m^2/s]: the mean of both sides."""
        return 0.5 * sum(self.flow_gain)

    @property
    def flow_pressure(self) -> float:
        """K_c [m^3/(s Pa)]: load flow lost per load pressure, both sides in series."""
        g_1, g_2 = self.conductance
        if math.isinf(g_1) or math.isinf(g_2):
            return min(g_1, g_2)
        return g_1 * g_2 / (g_1 + g_2) if g_1 + g_2 > 0.0 else 0.0

    @property
    def pressure_gain(self) -> float:
        """K_p = K_q/K_c [Pa/m], infinite where nothing is lost."""
        if self.flow_pressure == 0.0:
            return math.inf if self.load_flow_gain else 0.0
        return self.load_flow_gain / self.flow_pressure

    @property
    def oil_stiffness(self) -> float:
        """Stiffness of the trapped oil [N/m]: 4 beta A^2/V_t where both sides are alike."""
        return sum(a * a / c for a, c in zip(self.area, self.capacity))


def lumped_plant(plant: Plant) -> Lumped:
    """Return the lumped plant at the operating point of the distributed one."""
    point, p, valve = plant.point, plant.point.parameters, plant.valve
    chi = float(point.model.bulk_modulus[2])
    ratio = 1.0 + point.face_1 / chi, 1.0 + point.face_2 / chi
    conductance = valve.conductance
    with np.errstate(invalid='ignore'):
        g = (float(conductance[0] + conductance[2]), float(conductance[1] + conductance[3]))
    return Lumped(
        (float(valve.gain[0] - valve.gain[2]) / ratio[0],
         float(valve.gain[3] - valve.gain[1]) / ratio[1]),
        (g[0] / ratio[0], g[1] / ratio[1]), p['cylinder.leakage'] / ratio[0],
        (_capacity(plant.lines[1]) + _capacity(plant.lines[2]),
         _capacity(plant.lines[4]) + _capacity(plant.lines[3])),
        (p['cylinder.area_1'], p['cylinder.area_2']),
        p['cylinder.mass'], p['cylinder.viscous_friction'], p['cylinder.stiffness'])


def _capacity(line: LineState) -> float:
    """Return what a line takes per pressure [m^3/Pa]: V/(rho c^2) and its gas."""
    middle = float(line.mu[len(line.mu) // 2])
    density = line.density * math.exp(middle / line.speed)
    star = pressure_of_mu(line, middle) + line.floor
    gas = line.gas / star ** 2 if line.gas > 0.0 else 0.0
    return line.area * line.length * (1.0 / (density * line.speed ** 2) + gas)


def textbook_mode(lumped: Lumped) -> Mode | None:
    """Return Merritt's natural frequency [Hz] and damping, spring left out; None without mass."""
    if lumped.mass == 0.0:
        return None
    rate = [a / c for a, c in zip(lumped.area, lumped.capacity)]
    omega = math.sqrt(lumped.oil_stiffness / lumped.mass)
    lost = (sum(g * r * r for g, r in zip(lumped.conductance, rate))
            + lumped.leakage * sum(rate) ** 2) / omega ** 2
    return Mode(omega / (2.0 * math.pi), (lost + lumped.viscous) / (2.0 * lumped.mass * omega))


def lumped_modes(lumped: Lumped) -> list[Mode]:
    """Return the oscillating modes of the lumped plant, spring included; [] if none or no mass."""
    if lumped.mass == 0.0 or not np.isfinite(lumped.conductance).all():
        return []
    import control

    (g_1, g_2), leak, (c_1, c_2) = lumped.conductance, lumped.leakage, lumped.capacity
    (a_1, a_2), m = lumped.area, lumped.mass
    # states p1, p2 [scaled to N], v, y
    matrix = np.array([
        [-(g_1 + leak) / c_1, leak / c_1 * a_1 / a_2, -a_1 * a_1 / c_1, 0.0],
        [leak / c_2 * a_2 / a_1, -(g_2 + leak) / c_2, a_2 * a_2 / c_2, 0.0],
        [1.0 / m, -1.0 / m, -lumped.viscous / m, -lumped.stiffness / m],
        [0.0, 0.0, 1.0, 0.0]])
    plant = control.ss(matrix, np.zeros((4, 1)), np.eye(4), np.zeros((4, 1)))
    with np.errstate(invalid='ignore'):      # a position without spring: a pole at 0
        omega, damping, poles = plant.damp()
    return sorted({Mode(float(w) / (2.0 * math.pi), float(z))
                   for w, z, s in zip(omega, damping, poles) if s.imag > 1e-6 * abs(s)})


def respond_lumped(lumped: Lumped, frequency: np.ndarray) -> Responses:
    """Return the responses of the lumped plant at frequencies [Hz]; NaN where g is infinite."""
    frequency = np.asarray(frequency, float)
    s = 2j * math.pi * frequency
    m = np.zeros((len(s), 3, 3), complex)
    right = np.zeros((len(s), 3, 2), complex)
    a_1, a_2 = lumped.area
    scale = a_1 / max(lumped.oil_stiffness, 1e-300) * 1e0
    g = [x if math.isfinite(x) else math.nan for x in lumped.conductance]
    m[:, 0, 0] = lumped.capacity[0] * s + g[0] + lumped.leakage
    m[:, 0, 1] = -lumped.leakage
    m[:, 0, 2] = a_1
    m[:, 1, 1] = lumped.capacity[1] * s + g[1] + lumped.leakage
    m[:, 1, 0] = -lumped.leakage
    m[:, 1, 2] = -a_2
    m[:, 2, 0], m[:, 2, 1] = -a_1 * scale, a_2 * scale
    m[:, 2, 2] = (lumped.mass * s + lumped.viscous + lumped.stiffness / s) * scale
    right[:, 0, 0], right[:, 1, 0] = lumped.flow_gain[0], -lumped.flow_gain[1]
    right[:, 2, 1] = -scale
    found = np.linalg.solve(m, right)
    p_1, p_2, v = found[:, 0, 0], found[:, 1, 0], found[:, 2, 0]
    return Responses(frequency, v, p_1, p_2, p_1 - a_2 / a_1 * p_2, -s / found[:, 2, 1])
