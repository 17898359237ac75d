# SPDX-License-Identifier: Apache-2.0
"""
What is in the oil of a chain: mass and energy, and a closed line that must keep its mass.

Nothing in the method enforces conservation: it solves the Riemann form. Sums over nodes use
weights of sixth order, so that they do not hide or add to the method's own error.

    rho (e + u^2/2),  e = (chi/rho0)(ln r + 1/r - 1),  r = rho/rho0

Gas of volume V in a cell keeps oil out of it:

    integral of rho dV  [kg],  integral of p (1 + p/2 chi) dV  [J],  p = K/V - floor

in closed form from V = 0 at a pressure p* of REST_STAR on. K is constant but at a moving face,
where it grows with the chamber; that it does so at REST_STAR is off by K ln(p*/REST_STAR).
"""

from dataclasses import replace
from functools import cache

from hydra_actuator.core.boiling import gas_amounts, gas_volumes
from hydra_actuator.core.model import Domain, Junction, set_domain
from hydra_actuator.core.records import CLOSED
from hydra_actuator.verification.case import Case, Row
from hydra_actuator.verification.chains import (
    BULK_MODULUS,
    DENSITY,
    GASSY,
    LoneChain,
    mesh_of,
    OIL,
    riemann_variable,
    WAVE_SPEED,
)
from hydra_actuator.verification.drawing import bar, EXACT_LINE, SERIES
import numpy as np

LENGTH = 2.0
AREA = 2e-4
MEAN = 10e6
COURANT = 1.0 / 1.025
FAINT = 0.01e6          # [Pa] of a wave that hardly steepens in 10 s
DRIFT_BAR = 1e-9        # of the mass, while the wave is smooth
# mass that fronts add, over the energy they lose: see closed_line
FRONT_GAIN = 0.5 * ((2.0 * COURANT - 1.0) / (COURANT * (1.0 - COURANT)) - 1.0)
REST_STAR = 10e6        # [Pa] absolute less vapour pressure
PARTS = 100             # of a closed line's run, with a weighing after each
# kinds of oil and of wall friction a closed line must keep its mass with
OILS = {
    'free gas': (GASSY, 'none'),
    'unsteady friction': (replace(OIL, kinematic_viscosity=46e-6), 'unsteady'),
}
# what the trapezoid lacks at each end, in the end's differences of first to fourth order (Gregory)
GREGORY = (1.0 / 12.0, -1.0 / 24.0, 19.0 / 720.0, -3.0 / 160.0)


def integral(values: np.ndarray, spacing: float) -> float:
    """Return the integral of evenly spaced samples, with an error of sixth order."""
    total = float(values.sum() - 0.5 * (values[0] + values[-1]))
    for side in (values[:5], values[:-6:-1]):
        total += sum(weight * float(np.diff(side, k)[0]) for k, weight in enumerate(GREGORY, 1))
    return spacing * total


def mass_density(chain: LoneChain, d: int) -> np.ndarray:
    """Return rho [kg/m^3] along a line."""
    return DENSITY * (1.0 + chain.pressure(d) / BULK_MODULUS)


def energy_density(chain: LoneChain, d: int) -> np.ndarray:
    """Return rho (e + u^2/2) [J/m^3] along a line."""
    r = 1.0 + chain.pressure(d) / BULK_MODULUS
    # the sum cancels to 3e-3 of its terms at 10 MPa: twelve digits remain
    elastic = BULK_MODULUS / DENSITY * (np.log(r) + 1.0 / r - 1.0)
    return DENSITY * r * (elastic + 0.5 * chain.velocity(d) ** 2)


def stored(chain: LoneChain, density, d: int) -> float:
    """Return the integral of density(chain, d) over the volume of a line."""
    return float(chain.model.area[d]) * integral(
        density(chain, d), float(chain.model.spacing[d]))


def displaced(model, state, d: int) -> tuple[float, float]:
    """Return mass [kg] and energy [J] of the oil whose place the gas of a domain takes."""
    if model.end_strength[d] == 0.0:
        return 0.0, 0.0
    floor, chi = model.floor, model.bulk_modulus[d]
    volume, held = gas_volumes(model, state, d), gas_amounts(model, state, d)
    volume, held = volume[held > 0.0], held[held > 0.0]
    star = held / volume
    ratio, gap = np.log(REST_STAR / star), 1.0 / REST_STAR - 1.0 / star
    work = held * (ratio + floor * gap + (REST_STAR - floor) / REST_STAR)
    square = held * (REST_STAR - star - 2.0 * floor * ratio - floor ** 2 * gap
                     + (REST_STAR - floor) ** 2 / REST_STAR)
    return (float(np.sum(DENSITY * (volume + work / chi))),
            float(np.sum(work + square / (2.0 * chi))))


def closed_line(duration: float = 10.0) -> list[Row]:
    """
    Let the first mode of a closed line ring for a time [s], small and so large that it steepens.

    Interpolation damps a front like a viscosity nu(u) = dx^2/(2 dt) theta (1 - theta), and the
    foot theta = (c +- u) dt/dx of P and Q differs. Summed over the line the damping of mu^2 costs
    mass and the difference gives mass: with E the waves' energy over c^2, equally in mu and u,
    drift = ((2 C - 1)/(C (1 - C)) - 1) (E_before - E_after)/2 at Courant number C.
    """
    rows = []
    for cells in (200, 400):
        drift, _ = mass_drift(0.1e6, cells, duration)
        rows.append(Row(
            'closed_line', f'mass drift in {duration:g} s, +-0.1 MPa, {cells} cells', 'of mass',
            0.0, drift, DRIFT_BAR, False, 'third order: the wave stays smooth'))
    for cells in (200, 400):
        drift, damped = mass_drift(1.5e6, cells, duration)
        rows.append(Row(
            'closed_line', f'mass drift in {duration:g} s, +-1.5 MPa, {cells} cells', 'of mass',
            FRONT_GAIN * damped, drift, 0.1, True,
            'linear theory of what interpolating a front adds'))
    for kind in OILS:
        drift, _ = mass_drift(0.1e6, 100, duration, kind)
        rows.append(Row(
            'closed_line', f'mass drift in {duration:g} s, +-0.1 MPa, 100 cells, {kind}',
            'of mass', 0.0, drift, DRIFT_BAR, False, 'third order: the wave stays smooth'))
    _, _, damped = drift_history(FAINT, 200, duration)
    rows.append(Row(
        'closed_line', f'energy of the wave lost in {duration:g} s, +-0.01 MPa, 200 cells', '-',
        interpolation_loss(200, duration), float(damped[-1]) / first_energy(FAINT), 0.05, True,
        'linear theory of cubic interpolation'))
    return rows


def interpolation_loss(cells: int, duration: float) -> float:
    """Return the part of a first mode's energy that cubic interpolation takes in a time [s]."""
    phase, theta = np.pi / cells, COURANT
    ahead = -theta * (1 - theta) * (2 - theta) / 6
    here = (1 - theta) * (1 + theta) * (2 - theta) / 2
    behind, far = theta * (1 + theta) * (2 - theta) / 2, -theta * (1 - theta) * (1 + theta) / 6
    gain = abs(ahead * np.exp(1j * phase) + here + behind * np.exp(-1j * phase)
               + far * np.exp(-2j * phase))
    steps = duration / mesh_of(LENGTH, cells, COURANT).step_time
    return float(-np.expm1(2.0 * steps * np.log(gain)))


def first_energy(amplitude: float) -> float:
    """Return `wave_energy` of the first mode of an amplitude [Pa] about MEAN."""
    velocity = amplitude / (DENSITY * (1.0 + MEAN / BULK_MODULUS) * WAVE_SPEED)
    return 0.25 * (velocity / WAVE_SPEED) ** 2


def mass_drift(amplitude: float, cells: int, duration: float,
               kind: str = '') -> tuple[float, float]:
    """
    Return (mass gained, wave energy over c^2 lost) by a closed line; amplitude [Pa].

    kind: '' for plain oil, or one of OILS.
    """
    _, drift, damped = drift_history(amplitude, cells, duration, kind)
    return float(drift[-1]), float(damped[-1])


@cache
def drift_history(amplitude: float, cells: int, duration: float,
                  kind: str = '') -> tuple[np.ndarray, ...]:
    """Return time [s], mass gained and wave energy over c^2 lost, from first to last."""
    mesh = mesh_of(LENGTH, cells, COURANT)
    oil, friction = OILS.get(kind, (OIL, 'none'))
    chain = LoneChain([Domain('line', LENGTH, AREA, WAVE_SPEED, friction=friction)],
                      [Junction(CLOSED, (0,)), Junction(CLOSED, (1,))], mesh, oil)
    mu = riemann_variable(
        MEAN + amplitude * np.cos(np.pi * chain.positions(0) / LENGTH))
    set_domain(chain.model, chain.state, 0, mu, mu)
    mass, energy = oil_mass(chain), wave_energy(chain)
    ends = np.linspace(0, round(duration / mesh.step_time), PARTS + 1).round().astype(int)
    history = [(0.0, 0.0, 0.0)]
    for steps in np.diff(ends):
        chain.advance(int(steps))
        history.append((chain.time, oil_mass(chain) / mass - 1.0,
                        energy - wave_energy(chain)))
    return tuple(np.array(history).T)


def oil_mass(chain: LoneChain) -> float:
    """Return the mass of the oil [kg] in a lone line."""
    return stored(chain, mass_density, 0) - displaced(chain.model, chain.state, 0)[0]


def wave_energy(chain: LoneChain) -> float:
    """Return the mean of (mu^2 + u^2)/(2 c^2) along a line, mu from its mean."""
    p, q = chain.waves(0)
    mean = integral(0.5 * (p + q), 1.0) / (len(p) - 1)
    return integral((p - mean) ** 2 + (q - mean) ** 2, 0.25 / (len(p) - 1)) / WAVE_SPEED ** 2


def draw_closed_line(figure, duration: float = 10.0) -> None:
    """Draw mass gained over time: a smooth wave, and one that becomes a front."""
    above, below = figure.subplots(2, sharex=True)
    for cells, colour, dashes in ((200, SERIES[0], '-'), (400, SERIES[1], '--')):
        for axes, amplitude in ((above, 0.1e6), (below, 1.5e6)):
            time, drift, damped = drift_history(amplitude, cells, duration)
            if axes is below:
                axes.plot(time, FRONT_GAIN * damped, **{
                    **EXACT_LINE, 'label': 'linear theory' if cells == 200 else '_'})
            shown = np.abs(drift[1:]) if axes is above else drift[1:]
            axes.plot(time[1:], shown, dashes, color=colour, linewidth=1.2,
                      label=f'solver, {cells} cells')
    bar(above, DRIFT_BAR)
    above.set_yscale('log')
    above.set_ylim(1e-16, 1e-7)
    above.set_title(r'first mode of $\pm$0.1 MPa: stays smooth', loc='left')
    below.set_title(r'first mode of $\pm$1.5 MPa: steepens to a front', loc='left')
    above.set_ylabel('|mass gained|, of all')
    below.set_ylabel('mass gained, of all')
    below.set_xlabel('time [s]')
    for axes in (above, below):
        axes.grid(True)
        axes.legend(ncols=4, loc='upper left')
    below.set_ylim(top=6.5e-6)


CASES = {
    'closed_line': Case(closed_line, 'oil kept by a line without outlet', 'slow',
                        draw_closed_line),
}
