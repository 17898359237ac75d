# SPDX-License-Identifier: Apache-2.0
"""
The classical, quasi-static model of the same actuator: two volumes of oil and no waves.

    pump --line, edge, line, port--> [ V1, p1 | piston | V2, p2 ] --port, line, edge, line--> tank

    chi (1 + p/chi) dV/dt + V dp/dt = chi q       (continuity, rho = rho0 (1 + p/chi))
    p_from - p_to = R q|q|                        (edge, port and wall losses in series)
    m dv/dt = A1 p1 - A2 p2 - k x - delta v

Each chamber holds the oil of its line too. q is volume at rho0, V_1 grows with x. The pump gives
at most max_flow. Neglected: the oil's inertia, compressibility of supply and return line, end
stops. Merritt, "Hydraulic Control Systems" (1967), chapter 6, without its linearisation.
"""

from collections.abc import Callable
from dataclasses import dataclass
import math

from hydra_actuator.core.port import port_coefficient
from hydra_actuator.errors import InputError
from hydra_actuator.parameters import Parameters
import numpy as np

RELATIVE, ABSOLUTE = 1e-9, (1e-12, 1e-10, 1e-2, 1e-2)
LONGEST_STEP = 1e-4     # [s]: the command must not be stepped over
ABSENT = (
    'valve.leakage', 'valve.natural_frequency', 'valve.slew_rate', 'valve.overlap_pa',
    'valve.overlap_pb', 'valve.overlap_at', 'valve.overlap_bt', 'cylinder.leakage',
    'cylinder.coulomb_friction', 'cylinder.static_friction', 'supply.accumulator_volume')


@dataclass(frozen=True)
class Side:
    """What lies between valve and piston: area [m^2], lengths, port and wall loss."""

    area: float             # of the piston [m^2]
    volume: float           # of line and chamber at mid-stroke [m^3]
    resistance: float       # of line and port [Pa s^2/m^6]


@dataclass(frozen=True)
class LumpedTrace:
    """
    The solution at given times, each of shape (N,).

    position [m], velocity [m/s], gauge pressures of the chambers [Pa], drops [Pa] at the edge
    through which the oil comes from the pump and at the one through which it goes to the tank.
    """

    time: np.ndarray
    position: np.ndarray
    velocity: np.ndarray
    pressure_1: np.ndarray
    pressure_2: np.ndarray
    inlet_drop: np.ndarray
    outlet_drop: np.ndarray


class LumpedActuator:
    """An actuator of two volumes, from the same parameters."""

    def __init__(self, parameters: Parameters) -> None:
        """Raise InputError for what this model does not have."""
        p = self.parameters = parameters
        for name in ABSENT:
            if p[name] != 0.0:
                raise InputError(f'{name} = {p[name]:g}: the lumped model has none')
        density = self._density = p['fluid.density']
        self.bulk_modulus = p['fluid.bulk_modulus']
        self._edge = (p['valve.discharge_coefficient'] * p['valve.area_gradient']
                      * p['valve.stroke'] * math.sqrt(2.0 / density))
        self.sides = tuple(self._side(k) for k in (1, 2))
        self._supply_line, self._return_line = (
            self._wall_resistance(name) for name in ('supply_line', 'return_line'))

    def _bore(self, line: str) -> float:
        return 0.25 * math.pi * self.parameters[f'{line}.diameter'] ** 2

    def _wall_resistance(self, line: str) -> float:
        """Return R [Pa s^2/m^6] of a line: rho0 lambda L/(2 A^2)."""
        p = self.parameters
        if p[f'{line}.friction'] not in ('none', 'constant'):
            raise InputError(f'{line}.friction = {p[f"{line}.friction"]}: the lumped model has '
                             'constant friction or none')
        loss = p[f'{line}.loss_coefficient'] if p[f'{line}.friction'] == 'constant' else 0.0
        return 0.5 * self._density * loss * p[f'{line}.length'] / self._bore(line) ** 2

    def _side(self, k: int) -> Side:
        p, line = self.parameters, f'line_{k}'
        area, bore = p[f'cylinder.area_{k}'], self._bore(line)
        port = port_coefficient(p[f'cylinder.port_loss_{k}'], bore, area)
        return Side(
            area,
            area * (p[f'cylinder.dead_length_{k}'] + 0.5 * p['cylinder.stroke'])
            + bore * p[f'{line}.length'],
            self._wall_resistance(line) + 0.5 * self._density / port ** 2)

    def path(self, opening: float, side: int, pressure: float) -> tuple[float, float]:
        """
        Return (flow towards the chamber [m^3/s], drop over its edge [Pa] in that direction).

        opening: of the valve, -1 to 1; side: 0 or 1; pressure: of the chamber [Pa].
        """
        p, from_pump = self.parameters, (opening > 0.0) == (side == 0)
        outer, far = ((self._supply_line, p['supply.pressure']) if from_pump
                      else (self._return_line, p['tank.pressure']))
        square = (self._edge * opening) ** 2
        drop = (far - pressure) / (1.0 + (outer + self.sides[side].resistance) * square)
        flow = math.copysign(math.sqrt(square * abs(drop)), drop)
        most = p['supply.max_flow']
        if from_pump and 0.0 < most < flow:
            flow, drop = most, most ** 2 / square
        return flow, drop

    def slope(self, state: np.ndarray, opening: float) -> list[float]:
        """Return d/dt of (position, velocity, pressure_1, pressure_2) at a valve opening."""
        p, chi = self.parameters, self.bulk_modulus
        x, v, p_1, p_2 = state
        one, two = self.sides
        force = (one.area * p_1 - two.area * p_2 - p['cylinder.stiffness'] * x
                 - p['cylinder.viscous_friction'] * v)
        flow_1, flow_2 = self.path(opening, 0, p_1)[0], self.path(opening, 1, p_2)[0]
        return [
            v, force / p['cylinder.mass'],
            chi * (flow_1 - (1.0 + p_1 / chi) * one.area * v) / (one.volume + one.area * x),
            chi * (flow_2 + (1.0 + p_2 / chi) * two.area * v) / (two.volume - two.area * x)]

    def drops(self, state: np.ndarray, opening: float) -> tuple[float, float]:
        """Return the drops [Pa] over inlet and outlet edge, positive from pump to tank."""
        drop_1, drop_2 = (self.path(opening, side, state[2 + side])[1] for side in (0, 1))
        return (drop_1, -drop_2) if opening > 0.0 else (drop_2, -drop_1)

    def follow(self, command: Callable, times: np.ndarray,
               start: tuple[float, float] | None = None) -> LumpedTrace:
        """
        Integrate under a command and return the solution at `times` [s], from times[0] on.

        command: of an array of times, the opening -1..1; start: position [m] and velocity [m/s],
        of the parameters and at rest by default. Raises ArithmeticError if it does not converge.
        """
        from scipy.integrate import solve_ivp

        p = self.parameters
        first = (*(start or (p['initial.position'], 0.0)),
                 p['initial.pressure_1'], p['initial.pressure_2'])
        found = solve_ivp(
            lambda time, state: self.slope(state, float(command(np.float64(time)))),
            (times[0], times[-1]), first, method='LSODA', t_eval=times, rtol=RELATIVE,
            atol=ABSOLUTE, max_step=LONGEST_STEP)
        if not found.success:
            raise ArithmeticError(found.message)
        drops = np.array([self.drops(state, opening)
                          for state, opening in zip(found.y.T, command(times))])
        return LumpedTrace(times, *found.y, *drops.T)
