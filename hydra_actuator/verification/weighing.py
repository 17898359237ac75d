# SPDX-License-Identifier: Apache-2.0
"""
What is in a whole actuator's oil, and what passes its ends, read from the state in plain numbers.

Chambers are weighed up to the moving face, their last part by a cubic through it.
"""

from hydra_actuator.actuator import Actuator
from hydra_actuator.verification.chains import DENSITY
from hydra_actuator.verification.conservation import displaced, integral
import numpy as np

ENDS = np.arange(12)
FACES = {5: 1.0, 7: -1.0}       # ends that move with the piston, and which way they are stretched
NEAR = 0.4                      # of a cell: a face closer to a node than this is left out


class Weigher:
    """Reads an actuator's state in plain numbers."""

    def __init__(self, actuator: Actuator):
        """Take an actuator whose oil holds gas."""
        self._actuator = actuator
        self.model = actuator._model
        self.domain = ENDS // 2
        self.area = self.model.area[self.domain]
        self.chi = self.model.bulk_modulus[self.domain]
        self.wave_speed = self.model.wave_speed[self.domain]

    @property
    def state(self):
        """The state now: each step hands out another."""
        return self._actuator._state

    def flows(self) -> np.ndarray:
        """Return mass flows [kg/s] out of the oil, then powers [W], then gauge pressures [Pa]."""
        pressure = self.state.end_star - self.model.floor
        velocity = self.state.end_velocity.copy()
        face = np.zeros(12)
        for end, way in FACES.items():
            face[end] = way * self.state.piston[0]['velocity']
        mass_flow = DENSITY * (1.0 + pressure / self.chi) * self.area * (velocity - face)
        enthalpy = self.wave_speed ** 2 * np.log1p(pressure / self.chi)
        power = mass_flow * (enthalpy + 0.5 * velocity ** 2) + pressure * self.area * face
        return np.concatenate((mass_flow, power, pressure))

    def wall_heat(self) -> float:
        """Return what the walls of all lines take from the oil now [W]."""
        return sum(self.model.area[d] * integral(*self._drag(d)) for d in (0, 1, 4, 5))

    def _drag(self, d: int) -> tuple[np.ndarray, float]:
        nodes = self._nodes(d)
        state = self.state
        velocity = 0.5 * (state.wave_p[nodes] - state.wave_q[nodes])
        density = DENSITY * (1.0 + (state.star[nodes] - self.model.floor)
                             / self.model.bulk_modulus[d])
        return density * velocity * state.drag[nodes], float(self.model.spacing[d])

    def stored(self) -> tuple[float, float]:
        """Return the mass [kg] and the energy [J] of the oil now."""
        mass, energy = 0.0, 0.0
        for d in range(6):
            gas = displaced(self.model, self.state, d)
            for sign, (m, e) in ((1.0, self._oil(d)), (-1.0, gas)):
                mass += sign * m
                energy += sign * e
        return mass, energy

    def _nodes(self, d: int) -> slice:
        first = self.model.start[d]
        return slice(first, first + self.state.last[d] + 1)

    def _oil(self, d: int) -> tuple[float, float]:
        """Return mass and energy of a domain full of oil."""
        state, nodes = self.state, self._nodes(d)
        star, p, q = state.star[nodes], state.wave_p[nodes], state.wave_q[nodes]
        if self.model.moving[d]:
            star = np.append(star, state.end_star[2 * d + 1])
            p, q = np.append(p, state.face_p[d]), np.append(q, state.face_q[d, 0])
        r = 1.0 + (star - self.model.floor) / self.model.bulk_modulus[d]
        elastic = self.model.bulk_modulus[d] / DENSITY * (np.log(r) + 1.0 / r - 1.0)
        density = DENSITY * r
        return (self._over_domain(d, density),
                self._over_domain(d, density * (elastic + 0.125 * (p - q) ** 2)))

    def _over_domain(self, d: int, values: np.ndarray) -> float:
        """Return the integral over a domain's volume of values at its nodes and its face."""
        spacing, area = float(self.model.spacing[d]), float(self.model.area[d])
        if not self.model.moving[d]:
            return area * integral(values, spacing)
        whole, face = values[:-1], values[-1]
        part = float(self.state.length[d]) / spacing - (len(whole) - 1)
        offsets, last = np.array([-2.0, -1.0, 0.0]), whole[-3:]
        if part > NEAR:
            offsets, last = np.append(offsets, part), np.append(last, face)
        curve = np.polyint(np.polyfit(offsets, last, len(last) - 1))
        beyond = np.polyval(curve, part) - np.polyval(curve, 0.0)
        return area * (integral(whole, spacing) + spacing * float(beyond))
