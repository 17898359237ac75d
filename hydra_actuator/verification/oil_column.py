# SPDX-License-Identifier: Apache-2.0
"""
A piston between two columns of oil: what tells a wave solver from a lumped one.

    closed |<---- L1, A1 ---->[ M ]<---- L2, A2 ---->| closed

Linear waves give omega M = rho c [A1 cot(omega L1/c) + A2 cot(omega L2/c)]; as the oil's mass
vanishes beside M this becomes the lumped omega^2 = chi/M (A1/L1 + A2/L2). The solver starts in
the shape of the first mode, at rest, at gauge pressure zero, with an amplitude so small that
nothing nonlinear is left of it: a frequency shifts with the square of it.
"""

from dataclasses import dataclass
from functools import cache
import math

from hydra_actuator.core.model import Domain, Junction, Mesh, set_domain
from hydra_actuator.core.oil import Oil
from hydra_actuator.core.records import CLOSED, PISTON, PISTON_PARAMETERS
from hydra_actuator.parameters.streamline import fit_step
from hydra_actuator.verification.case import Case, Row
from hydra_actuator.verification.chains import LoneChain
from hydra_actuator.verification.drawing import EXACT_LINE, MILLI, SIMPLER, SOLVER
from hydra_actuator.verification.harmonics import fit_oscillation
import numpy as np

DENSITY, BULK_MODULUS = 870.0, 1.5e9
SPEED = math.sqrt(BULK_MODULUS / DENSITY)
MACH = 0.01
AMPLITUDE = 2e-5        # of the shorter chamber's length
PERIODS = 20
SAMPLES = 40            # in a period
SHOWN_PERIODS = 4       # in a figure


@dataclass(frozen=True)
class Column:
    """Areas [m^2] and lengths [m] of both chambers, and the mass [kg] between them."""

    areas: tuple[float, float]
    lengths: tuple[float, float]
    mass: float

    def exact_frequency(self) -> float:
        """Return the first root [rad/s] of the distributed model, by bisection."""
        low, high = 0.0, 0.5 * math.pi * SPEED / max(self.lengths)
        for _ in range(200):
            middle = 0.5 * (low + high)
            stiffness = DENSITY * SPEED * sum(
                area / math.tan(middle * length / SPEED)
                for area, length in zip(self.areas, self.lengths))
            if middle * self.mass > stiffness:
                high = middle
            else:
                low = middle
        return low

    def lumped_frequency(self) -> float:
        """Return the frequency [rad/s] of a mass on two springs of oil without mass."""
        return math.sqrt(BULK_MODULUS / self.mass * sum(
            area / length for area, length in zip(self.areas, self.lengths)))

    def measured_frequency(self, cells: int) -> float:
        """Return the solver's frequency [rad/s], on `cells` cells over both chambers."""
        return fit_oscillation(*swing(self, cells), self.exact_frequency())[0]


@cache
def swing(column: Column, cells: int) -> tuple[np.ndarray, np.ndarray]:
    """Return time [s] and piston position [m] over PERIODS, from the first mode at rest."""
    omega = column.exact_frequency()
    chain, samples = _chain(column, cells, 2.0 * math.pi / omega)
    _deflect(chain, column, omega)
    steps = round(2.0 * math.pi / omega / chain.model.step_time) // samples
    trace = np.empty((PERIODS * samples, 2))
    for row in trace:
        chain.advance(steps)
        row[:] = chain.time, chain.state.piston[0]['position']
    time, position = trace.T
    return time, position


def _chain(column: Column, cells: int, period: float) -> tuple[LoneChain, int]:
    total = sum(column.lengths)
    mesh = Mesh(fit_step(period / SAMPLES, total, cells, SPEED, MACH), MACH)
    limit = 0.1 * min(column.lengths)
    piston = np.zeros(1, PISTON_PARAMETERS)
    piston['mass'], piston['limit'] = column.mass, limit
    piston['length_1'], piston['length_2'] = column.lengths
    chambers = [
        Domain(f'chamber_{k + 1}', length, area, SPEED, longest=length + limit,
               origin=k * total, direction=1.0 - 2.0 * k)
        for k, (area, length) in enumerate(zip(column.areas, column.lengths))]
    junctions = [Junction(CLOSED, (0,)), Junction(CLOSED, (2,)), Junction(PISTON, (1, 3))]
    return LoneChain(chambers, junctions, mesh, Oil(DENSITY), piston=piston), SAMPLES


def _deflect(chain: LoneChain, column: Column, omega: float) -> None:
    """Put the chain, at rest, into the shape of a mode: p ~ cos(k x) from the closed end."""
    model, state, k = chain.model, chain.state, omega / SPEED
    shift = AMPLITUDE * min(column.lengths)
    piston = state.piston[0]
    piston['position'] = piston['new_position'] = shift
    for d, (sign, length) in enumerate(zip((1.0, -1.0), column.lengths)):
        state.length[d] = state.old_length[d] = length + sign * shift
        top = -sign * SPEED * k * shift / math.sin(k * length)
        mu = top * np.cos(k * chain.positions(d))
        set_domain(model, state, d, mu[:-1], mu[:-1])
        state.face_p[d] = state.face_q[d] = mu[-1]
        pressure = float(BULK_MODULUS * np.expm1(mu[-1] / SPEED))
        piston['force'] += sign * column.areas[d] * pressure


# Areas, length per side, mass, and the independently computed frequency [rad/s] of each.
SYMMETRIC = (
    (5e-4, 0.2, 20.0, 611.4859),
    (1e-3, 0.5, 5.0, 1064.6707),
    (2e-3, 1.0, 2.0, 1358.2738),
)
CELLS = 200
UNEQUAL = Column((2e-3, 1e-3), (0.3, 0.7), 4.0)
HEAVY = Column((2e-3, 1e-3), (0.1, 0.15), 200.0)


def oil_column() -> list[Row]:
    """Let the piston swing on equal columns, against the exact frequency."""
    return [
        Row('oil_column', f'A {area:g} m^2, L {length:g} m, M {mass:g} kg', 'rad/s', expected,
            Column((area, area), (length, length), mass).measured_frequency(CELLS), 1e-5, True,
            'second order in time: (omega dt)^2/12 is 9e-6 in the coarsest row')
        for area, length, mass, expected in SYMMETRIC]


def oil_column_unequal() -> list[Row]:
    """Let it swing on unequal columns, and heavy on short ones, where lumping is right."""
    name = 'oil_column_unequal'
    unequal, heavy = UNEQUAL, HEAVY
    got = heavy.measured_frequency(CELLS)
    return [
        Row(name, 'light piston, exact', 'rad/s', unequal.exact_frequency(),
            unequal.measured_frequency(CELLS), 1e-5, True, 'as with equal columns'),
        Row(name, 'heavy piston, exact', 'rad/s', heavy.exact_frequency(), got, 1e-6, True,
            'omega dt is below 1e-3'),
        Row(name, 'heavy piston, lumped', 'rad/s', heavy.lumped_frequency(), got, 3e-4,
            True, "a third of the oil's 0.3 kg swings along: 2.5e-4 of the frequency"),
    ]


def draw_oil_column(figure) -> None:
    """Draw the swing on equal columns."""
    _draw_swings(figure, [Column((area, area), (length, length), mass)
                          for area, length, mass, _ in SYMMETRIC])


def draw_oil_column_unequal(figure) -> None:
    """Draw the swing on unequal columns."""
    _draw_swings(figure, [UNEQUAL, HEAVY])


def _draw_swings(figure, columns: list[Column]) -> None:
    """Draw the last periods of each swing, where an error of the frequency shows as a shift."""
    for axes, column in zip(figure.subplots(len(columns)), columns):
        omega, lumped = column.exact_frequency(), column.lumped_frequency()
        time, position = swing(column, CELLS)
        shift = 1e6 * AMPLITUDE * min(column.lengths)
        shown = time > (PERIODS - SHOWN_PERIODS) * 2.0 * np.pi / omega
        time, position = MILLI * time[shown], 1e6 * position[shown]
        axes.plot(time, shift * np.cos(omega * time / MILLI), **{
            **EXACT_LINE, 'label': f'exact, {omega:.4f} rad/s'})
        got = column.measured_frequency(CELLS)
        axes.plot(time, position, **{**SOLVER, 'label': f'solver, {got:.4f} rad/s'})
        axes.plot(time, shift * np.cos(lumped * time / MILLI), label=(
            f'lumped oil, {lumped:.4f} rad/s'), **SIMPLER)
        areas, lengths = ({f'{one:g}': None for one in pair}
                          for pair in (column.areas, column.lengths))
        axes.set_title(f'A {" and ".join(areas)} m$^2$, L {" and ".join(lengths)} m, '
                       f'M {column.mass:g} kg', loc='left')
        axes.set_ylabel('piston position [\u00b5m]')
        axes.legend(loc='lower right', bbox_to_anchor=(1.0, 1.0), ncols=3, borderpad=0)
        axes.grid(True)
    axes.set_xlabel(f'time [ms], the last {SHOWN_PERIODS} of {PERIODS} periods')


CASES = {
    'oil_column': Case(oil_column, 'a piston swings on two columns of oil',
                       figure=draw_oil_column),
    'oil_column_unequal': Case(oil_column_unequal, 'the same with unequal areas and lengths',
                               figure=draw_oil_column_unequal),
}
