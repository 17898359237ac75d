# SPDX-License-Identifier: Apache-2.0
r"""
Mass and energy of a whole actuator with every option on: what came in, went out, stayed, was lost.

    oil       in - out = change of what is stored, in mass and, with the losses, in energy
    piston    work of both faces = kinetic + spring + viscous + seals

An end passes m (c mu + u^2/2) [W]; a face that moves at v passes p A v and, where it leaks, the
same of the oil that goes by. Gas of volume V in a cell keeps oil out of it,

    integral of rho dV  [kg],  integral of p (1 + p/2 chi) dV  [J],   p = K/V - floor

The wall's friction takes rho A u J along the lines. Losses in valve, ports and seals are what
their ends do not pass on: the orifices' own law is judged by other cases.
"""

from dataclasses import dataclass
from functools import cache
import math

from hydra_actuator.actuator import Actuator
from hydra_actuator.errors import Failure
from hydra_actuator.parameters import Parameters
from hydra_actuator.parameters.options import EVERYTHING
from hydra_actuator.verification.case import Case, Row
from hydra_actuator.verification.conservation import integral
from hydra_actuator.verification.weighing import FACES, Weigher
import numpy as np

PUMP_END, TANK_END = 0, 11
RAMP, STEP = 0.02, 5e-5


def one_way(time: float) -> float:
    """Return a spool command that rises from 0, then swings without ever closing the valve."""
    part = min(1.0, time / RAMP)
    ramp = part ** 4 * (35.0 - 84.0 * part + 70.0 * part ** 2 - 20.0 * part ** 3)
    return ramp * (0.3 + 0.1 * math.sin(100.0 * math.pi * time))


def slamming(time: float) -> float:
    """Return the full-stroke sine of 50 Hz."""
    return math.sin(100.0 * math.pi * time)


@dataclass(frozen=True)
class Drive:
    """A way to drive the actuator: command, parameters, from and to when [s], and the bars."""

    command: object
    parameters: dict
    begin: float
    end: float
    mass_bar: float
    energy_bar: float
    work_bar: float
    reason: str


@dataclass(frozen=True)
class Ledger:
    """
    Series at every step of a run: (T, 12) in the order of the ends, or (T,).

    mass_flow [kg/s] and power [W] out of the oil; wall_heat [W]; work [W] of both faces on the
    piston; viscous and seals [W]; mass [kg] and energy [J] in the oil, kinetic and spring [J], at
    the first and the last step.
    """

    step_time: float
    mass_flow: np.ndarray
    power: np.ndarray
    wall_heat: np.ndarray
    work: np.ndarray
    viscous: np.ndarray
    seals: np.ndarray
    mass: tuple[float, float]
    energy: tuple[float, float]
    mechanical: tuple[float, float]

    def total(self, series: np.ndarray) -> float:
        """Return the integral of a series over the run."""
        return integral(series, self.step_time)

    def mass_missing(self) -> float:
        """Return in - out - stored, in parts of what passed the pump's end either way."""
        flow = self.mass_flow
        passed = self.total(np.abs(flow[:, PUMP_END]))
        net = self.total(-flow[:, PUMP_END] - flow[:, TANK_END])
        return (net - (self.mass[1] - self.mass[0])) / passed

    def losses(self) -> dict[str, float]:
        """Return the energy [J] that left the oil between the pump and the tank, by place."""
        power = self.power
        return {
            'walls of the lines': self.total(self.wall_heat),
            'valve': self.total(power[:, [1, 2, 9, 10]].sum(axis=1)),
            'ports': self.total(power[:, [3, 4, 8, 6]].sum(axis=1)),
            'past the piston': self.total(power[:, [5, 7]].sum(axis=1) - self.work),
            'into the piston': self.total(self.work),
        }

    def energy_missing(self) -> float:
        """Return in - out - stored - lost, in parts of what passed the pump's end either way."""
        power = self.power
        passed = self.total(np.abs(power[:, PUMP_END]))
        net = self.total(-power[:, PUMP_END] - power[:, TANK_END])
        kept = self.energy[1] - self.energy[0]
        return (net - kept - sum(self.losses().values())) / passed

    def work_missing(self) -> float:
        """Return work - kinetic - spring - viscous - seals, in parts of the work either way."""
        gained = self.mechanical[1] - self.mechanical[0]
        lost = self.total(self.viscous + self.seals)
        return (self.total(self.work) - gained - lost) / self.total(np.abs(self.work))


@cache
def keep_ledger(name: str, cells: int) -> Ledger:
    """Run a drive on a mesh of some `cells` and write down every step."""
    drive = DRIVES[name]
    parameters = Parameters().replace({
        **EVERYTHING, **drive.parameters, 'solver.cells': cells})
    actuator = Actuator(parameters)
    times = np.arange(0.0, drive.end + 4.0 * STEP, STEP)
    command = np.array([drive.command(time) for time in times])
    schedule = (times, np.column_stack((command, command, 0.0 * command)), False)
    weigher, step_time = Weigher(actuator), actuator.step_time
    _follow(actuator, schedule, round(drive.begin / step_time))
    before = (weigher.stored(), _mechanical(actuator))
    entries = [_entry(weigher)]
    for _ in range(round((drive.end - drive.begin) / step_time)):
        _follow(actuator, schedule, 1)
        entries.append(_entry(weigher))
    flows, heat, velocity = np.split(np.array(entries), (36, 37), axis=1)
    velocity = velocity[:, 0]
    mass_flow, power, pressure = np.split(flows, 3, axis=1)
    work = sum(way * weigher.area[end] * pressure[:, end] for end, way in FACES.items()) * velocity
    (mass, energy), after = weigher.stored(), _mechanical(actuator)
    return Ledger(
        step_time, mass_flow, power, heat[:, 0], work,
        parameters['cylinder.viscous_friction'] * velocity ** 2,
        _seal_friction(parameters, np.abs(velocity)) * np.abs(velocity),
        (before[0][0], mass), (before[0][1], energy), (before[1], after))


def _follow(actuator: Actuator, schedule: tuple, steps: int) -> None:
    code = actuator.follow(schedule, steps)
    if code:
        raise Failure(actuator.status_message(code))


def _entry(weigher: Weigher) -> np.ndarray:
    return np.concatenate((
        weigher.flows(), (weigher.wall_heat(), weigher.state.piston[0]['velocity'])))


def _mechanical(actuator: Actuator) -> float:
    """Return the energy [J] of the piston's motion and of its spring."""
    p, state = actuator.parameters, actuator.state
    return 0.5 * (p['cylinder.mass'] * state.velocity ** 2
                  + p['cylinder.stiffness'] * state.position ** 2)


def _seal_friction(parameters: Parameters, speed: np.ndarray) -> np.ndarray:
    """Return the law of Coulomb and Stribeck [N] at sliding speeds [m/s]."""
    coulomb = parameters['cylinder.coulomb_friction']
    extra = parameters['cylinder.static_friction'] - coulomb
    return coulomb + extra * np.exp(-(speed / parameters['cylinder.stribeck_velocity']) ** 2)


DRIVES = {
    'smooth': Drive(one_way, {}, 0.03, 0.05, 1e-8, 1e-6, 1e-6,
                    'smooth waves, the valve never shut'),
    'boiling': Drive(slamming, {'tank.pressure': 0.0}, 0.03, 0.07, 1e-3, 1e-3, 1e-5,
                     'fronts of collapsing cavities, a valve that shuts'),
}


def whole_budget() -> list[Row]:
    """Weigh an actuator with every option on, driven smoothly and until it boils."""
    rows = []
    for name, drive in DRIVES.items():
        for cells in (100, 200):
            ledger = keep_ledger(name, cells)
            for what, value, bar, of in (
                    ('mass: in - out - stored', ledger.mass_missing(), drive.mass_bar,
                     'of throughput'),
                    ('energy: in - out - stored - lost', ledger.energy_missing(),
                     drive.energy_bar, 'of throughput'),
                    ('piston: work - kept - lost', ledger.work_missing(), drive.work_bar,
                     'of the work')):
                rows.append(Row('whole_budget', f'{what}, {name}, {cells} cells', of, 0.0, value,
                                bar, False, drive.reason))
    return rows


CASES = {
    'whole_budget': Case(
        whole_budget, 'mass and energy of a whole actuator with every option on', 'slow'),
}
