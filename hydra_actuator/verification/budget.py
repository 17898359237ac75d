# SPDX-License-Identifier: Apache-2.0
r"""
Mass and energy of two lines with an orifice between them, driven by a swinging pressure.

    p(t) ---- line 1 ---- M )( N ---- line 2 ---- p = constant

What flows in must flow out or be stored, and what energy is missing must be that of the losses:

    end      m (c mu + u^2/2), since e + p/rho = c mu
    line     integral of rho A lambda |u|^3 / 2
    orifice  m (c mu_M - c mu_N + (u_M^2 - u_N^2)/2)
"""

from dataclasses import dataclass
from functools import cache
import math

from hydra_actuator.core.model import Domain, Junction
from hydra_actuator.core.records import ORIFICE, PRESSURE
from hydra_actuator.verification.case import Case, Row
from hydra_actuator.verification.chains import (
    BULK_MODULUS,
    DENSITY,
    LoneChain,
    mesh_of,
    riemann_variable,
    WAVE_SPEED,
)
from hydra_actuator.verification.conservation import (
    energy_density,
    integral,
    mass_density,
    stored,
)
import numpy as np

LENGTHS = (1.2, 0.8)
AREAS = (2e-4, 3e-4)
LOSS = (1.9, 1.0)
ORIFICE_AREA = 1.2e-5
COEFFICIENT = ORIFICE_AREA * math.sqrt(2.0 / DENSITY)
BACK_PRESSURE = 5e6
FREQUENCY = 50.0
WARM_UP, DURATION = 0.02, 0.06
MASS_BAR, LAW_BAR, ENERGY_BAR = 1e-9, 1e-10, 1e-8
WEIGHINGS = 60
INLET, M, N, OUTLET = range(4)


@dataclass(frozen=True)
class Ledger:
    """
    Series (T,) or (T, 4) at every step, in the order of the ends, and what is stored.

    mass_flow [kg/s] and power [W] out of the lines, pressure [Pa], heat [W] of both lines;
    mass [kg] and energy [J] stored in both lines at the entries `weighed`, first and last among
    them.
    """

    step_time: float
    mass_flow: np.ndarray
    power: np.ndarray
    pressure: np.ndarray
    heat: np.ndarray
    weighed: np.ndarray
    mass: np.ndarray
    energy: np.ndarray

    def total(self, series: np.ndarray, last: int = -1) -> float:
        """Return the integral of a series over the time, to the end or to a `last` entry."""
        return integral(series[:last + 1] if last >= 0 else series, self.step_time)

    def mass_missing(self, weighing: int = -1) -> float:
        """Return in - out - stored up to a weighing, in parts of what comes in in all."""
        last = int(self.weighed[weighing])
        came = self.total(-self.mass_flow[:, INLET], last)
        went = self.total(self.mass_flow[:, OUTLET], last)
        kept = self.mass[weighing] - self.mass[0]
        return float((came - went - kept) / self.total(-self.mass_flow[:, INLET]))


def inlet_pressure(time: float, swing: float) -> float:
    """Return a gauge pressure [Pa] that rises smoothly from rest, then swings periodically."""
    part = min(1.0, time / WARM_UP)
    ramp = part ** 4 * (35.0 - 84.0 * part + 70.0 * part ** 2 - 20.0 * part ** 3)
    return BACK_PRESSURE + ramp * (5e6 + swing * math.sin(2.0 * math.pi * FREQUENCY * time))


@cache
def keep_ledger(cells: int, swing: float) -> Ledger:
    """Run the two lines on a mesh of some `cells` in all, with a swing [Pa] of the pressure."""
    mesh = mesh_of(sum(LENGTHS), cells)
    chain = LoneChain(
        [Domain(f'line {d + 1}', LENGTHS[d], AREAS[d], WAVE_SPEED, LOSS[d], BACK_PRESSURE)
         for d in (0, 1)],
        [Junction(PRESSURE, (INLET,), 0), Junction(ORIFICE, (M, N), coefficient=COEFFICIENT),
         Junction(PRESSURE, (OUTLET,), 1)], mesh)
    first, steps = round(WARM_UP / mesh.step_time), round(DURATION / mesh.step_time)
    weighed = np.linspace(0, steps, WEIGHINGS + 1).round().astype(int)
    due = set(first + weighed)
    entries, mass, energy = [], [], []
    for k in range(first + steps + 1):
        if k:
            chain.step(inlet_pressure(k * mesh.step_time, swing), BACK_PRESSURE)
        if k >= first:
            entries.append(entry(chain))
        if k in due:
            mass.append(sum(stored(chain, mass_density, d) for d in (0, 1)))
            energy.append(sum(stored(chain, energy_density, d) for d in (0, 1)))
    columns = np.array(entries)
    return Ledger(mesh.step_time, *np.split(columns, (4, 8, 12), axis=1),
                  weighed, np.array(mass), np.array(energy))


def entry(chain: LoneChain) -> np.ndarray:
    """Return mass flows and powers out of the four ends, their pressures, heat of both lines."""
    pressure = np.array([chain.end_pressure(end) for end in range(4)])
    velocity = np.array([chain.end_velocity(end) for end in range(4)])
    area = np.repeat(AREAS, 2)
    mass_flow = DENSITY * (1.0 + pressure / BULK_MODULUS) * area * velocity
    power = mass_flow * (WAVE_SPEED * riemann_variable(pressure) + 0.5 * velocity ** 2)
    heat = [stored(chain, loss_density, d) for d in (0, 1)]
    return np.concatenate((mass_flow, power, pressure, heat))


def loss_density(chain: LoneChain, d: int) -> np.ndarray:
    """Return rho lambda |u|^3 / 2 [W/m^3] along a line."""
    return 0.5 * LOSS[d] * mass_density(chain, d) * np.abs(chain.velocity(d)) ** 3


def mass_balance() -> list[Row]:
    """Weigh what goes in, comes out and stays."""
    rows = []
    for cells in (200, 400):
        ledger = keep_ledger(cells, 2e6)
        missing = [abs(ledger.mass_missing(k)) for k in range(1, WEIGHINGS + 1)]
        for when, value in (('', ledger.mass_missing()),
                            (f', worst of {WEIGHINGS} instants', max(missing))):
            rows.append(Row(
                'mass_balance', f'in - out - stored, {cells} cells{when}', 'of throughput', 0.0,
                value, MASS_BAR, False, 'boundary laws hold to 1e-10, waves are smooth'))
    return rows


SWINGS = {'one way': 2e6, 'reversing': 8e6}


def law_errors(name: str) -> tuple[np.ndarray, np.ndarray]:
    """
    Return errors at every step of (mass in = mass out, law) of an orifice.

    In parts of the value itself, or, where the flow reverses, of the largest: it passes zero.
    """
    ledger = keep_ledger(100, SWINGS[name])
    flow, pressure = ledger.mass_flow, ledger.pressure
    q, drop = flow[:, M] / DENSITY, pressure[:, M] - pressure[:, N]
    own = name == 'one way'
    gap = (flow[:, M] + flow[:, N]) / (np.abs(flow[:, M]) if own else np.abs(flow[:, M]).max())
    off = (drop - q * np.abs(q) / COEFFICIENT ** 2) / (
        np.abs(drop) if own else np.abs(drop).max())
    return gap, off


def orifice_law() -> list[Row]:
    """Hold mass and law of the orifice at every step, with and without reversal."""
    rows = []
    for name in SWINGS:
        gap, off = (float(np.abs(errors).max()) for errors in law_errors(name))
        reason = ('of the value itself' if name == 'one way'
                  else 'of the largest value: it passes zero')
        rows += [
            Row('orifice_law', f'mass in = mass out, worst step, {name}', '-', 0.0, gap,
                LAW_BAR, False, reason),
            Row('orifice_law', f'drop = rho0 q|q|/2K^2, worst step, {name}', '-', 0.0, off,
                LAW_BAR, False, reason),
        ]
    return rows


@dataclass(frozen=True)
class Budget:
    """Energy [J] that came in, went out and was kept, and each loss by its name."""

    came: float
    went: float
    kept: float
    losses: dict[str, float]


@cache
def budget() -> Budget:
    """Return the energy budget of one run."""
    ledger = keep_ledger(200, 2e6)
    return Budget(
        ledger.total(-ledger.power[:, INLET]), ledger.total(ledger.power[:, OUTLET]),
        float(ledger.energy[-1] - ledger.energy[0]), {
            'friction of line 1': ledger.total(ledger.heat[:, 0]),
            'orifice': ledger.total(ledger.power[:, M] + ledger.power[:, N]),
            'friction of line 2': ledger.total(ledger.heat[:, 1]),
        })


def energy_budget() -> list[Row]:
    """Name every loss: each must be what the rest of the budget leaves for it."""
    found = budget()
    came, losses = found.came, found.losses
    missing = came - found.went - found.kept
    rows = [Row('energy_budget', 'in - out - stored - losses', 'of what came in', 0.0,
                (missing - sum(losses.values())) / came, ENERGY_BAR, False,
                'third order, waves are smooth')]
    for name, loss in losses.items():
        rows.append(Row('energy_budget', name, 'J', missing - (sum(losses.values()) - loss), loss,
                        ENERGY_BAR * came / loss, True, 'the tolerance of the budget'))
    return rows


CASES = {
    'mass_balance': Case(mass_balance, 'oil in, out and stored, through an orifice', 'slow'),
    'orifice_law': Case(orifice_law, 'mass and law of an orifice at every step'),
    'energy_budget': Case(energy_budget, 'energy with every loss named'),
}
