# SPDX-License-Identifier: Apache-2.0
"""
Waves in lone lines of constant length: sudden stop, organ pipes, a travelling Gaussian.

Exact solutions of the lossless equations. A sudden stop is exact at any size (mu + u arrives
unchanged); pipes and Gaussian are linear, so they run at gauge pressure zero and 1 Pa, where
u + c differs from c by 1e-9.
"""

from functools import cache
import math

from hydra_actuator.core.model import Domain, Junction, set_domain
from hydra_actuator.core.records import CLOSED, PRESSURE
from hydra_actuator.verification.case import Case, Row
from hydra_actuator.verification.chains import (
    BULK_MODULUS,
    DENSITY,
    LoneChain,
    mesh_of,
    pressure_of,
    riemann_variable,
    WAVE_SPEED,
)
import numpy as np

LENGTH = 2.0
AREA = 2e-4
SMALL = 1.0
OPEN = PRESSURE


def lone_line(ends: tuple[int, int], cells: int, initial: dict[str, float] | None = None,
              **mesh) -> LoneChain:
    """Return one lossless line between two junction kinds; mesh: as mesh_of takes it."""
    line = Domain('line', LENGTH, AREA, WAVE_SPEED, **(initial or {}))
    junctions = [Junction(kind, (end,)) for end, kind in enumerate(ends)]
    return LoneChain([line], junctions, mesh_of(LENGTH, cells, **mesh))


STOPPED, HEAD, STOP_CELLS = 0.5, 10e6, 200      # [m/s], gauge [Pa]


@cache
def stop() -> tuple[np.ndarray, ...]:
    """Return time [s], gauge pressures [Pa] at the far end and at mid-line after a sudden stop."""
    chain = lone_line((PRESSURE, CLOSED), STOP_CELLS, {'pressure': HEAD, 'velocity': STOPPED})
    trace = []
    for _ in range(STOP_CELLS):
        chain.step(HEAD)
        trace.append((chain.time, chain.end_pressure(1), chain.pressure(0)[STOP_CELLS // 2]))
    return tuple(np.array(trace).T)


def stop_rise() -> float:
    """Return the exact rise [Pa] of a sudden stop."""
    return float(pressure_of(riemann_variable(HEAD) + STOPPED)) - HEAD


def stop_front() -> float:
    """Return when [s] the front passes mid-line: a shock of the Riemann form runs at the mean."""
    return 0.5 * LENGTH / (WAVE_SPEED - 0.5 * STOPPED)


def joukowsky() -> list[Row]:
    """Stop a uniform flow at once at its far end."""
    name = 'joukowsky'
    time, at_end, at_middle = stop()
    exact = stop_rise()
    linear = DENSITY * (1.0 + HEAD / BULK_MODULUS) * WAVE_SPEED * STOPPED
    step_time = float(time[0])
    half = float(np.interp(HEAD + 0.5 * exact, at_middle, time)) / step_time
    rise = at_end - HEAD
    worst = rise[np.argmax(np.abs(rise - exact))]
    return [
        Row(name, 'rise, worst of all steps', 'Pa', exact, float(worst), 1e-9, True,
            'mu + u arrives unchanged: rounding'),
        Row(name, 'rise over rho c du', 'Pa', linear, float(rise[-1]), 5e-4, True,
            'what is claimed for RTHYM-MOC; du/2c = 0.02 % of it is physical'),
        Row(name, 'front at mid-line, half height', 'steps', stop_front() / step_time, half,
            1.0, False, 'a front lies between two nodes'),
    ]


PIPES = {
    'open-closed': ((OPEN, CLOSED), lambda mode: 0.5 * mode - 0.25),
    'closed-closed': ((CLOSED, CLOSED), lambda mode: 0.5 * mode),
    'open-open': ((OPEN, OPEN), lambda mode: 0.5 * mode),
}


def organ_pipe() -> list[Row]:
    """Time standing waves in pipes, three modes each, over ten periods."""
    rows = []
    for pipe, (ends, waves) in PIPES.items():
        for mode in (1, 2, 3):
            exact = LENGTH / (waves(mode) * WAVE_SPEED)
            rows.append(Row(
                'organ_pipe', f'{pipe}, period of mode {mode}', 's', exact,
                ringing_period(ends, waves(mode) / LENGTH), 2e-3, True,
                'what is claimed for RTHYM-MOC'))
    return rows


def ringing_period(ends: tuple[int, int], wave_number: float) -> float:
    """Return the period [s] at which a standing wave of a wave number [1/m] rings."""
    time, pressure = ringing(ends, wave_number)
    low = np.nonzero(pressure[:-1] * pressure[1:] < 0.0)[0]
    crossings = time[low] - pressure[low] * np.diff(time)[low] / np.diff(pressure)[low]
    return float(2.0 * (crossings[-1] - crossings[0]) / (len(crossings) - 1))


@cache
def ringing(ends: tuple[int, int], wave_number: float) -> tuple[np.ndarray, np.ndarray]:
    """Return time [s] and gauge pressure [Pa] at an antinode of a standing wave, ten periods."""
    cells, periods = 200, 10
    chain = lone_line(ends, cells)
    phase = 2.0 * np.pi * wave_number * chain.positions(0)
    shape = np.sin(phase) if ends[0] == OPEN else np.cos(phase)
    mu = riemann_variable(SMALL) * shape
    set_domain(chain.model, chain.state, 0, mu, mu)
    antinode = int(np.argmax(np.abs(shape)))
    every = max(1, round(cells / (wave_number * LENGTH) / 100))
    count = math.ceil(periods * cells * 1.03 / (wave_number * LENGTH) / every)
    trace = [(0.0, chain.pressure(0)[antinode])]
    for _ in range(count):
        chain.advance(every)
        trace.append((chain.time, chain.pressure(0)[antinode]))
    time, pressure = np.array(trace).T
    return time, pressure


CROSSINGS = 20
WIDTH = 0.08
# Height lost [%] after the last whole step before the twentieth crossing, 0.4 cells from where
# the halves meet (a loss of 0.06 % in itself), at Courant 0.99 and 0.9: (expected, rounding).
HEIGHT_LOST = {
    'linear': {0.99: (13.0, 0.5), 0.9: (51.0, 0.5)},
    'cubic': {0.99: (0.12, 0.005), 0.9: (0.7, 0.05)},
}
# (tolerance, relative, reason) of the loss against the symbol of the interpolation on a ring
AGAINST_RING = {
    'linear': (1e-6, True, 'two nodes make the same stencil at an end as inside'),
    'cubic': (0.05, True, 'next to an end the cubic is one-sided, which damps less'),
}


def gaussian() -> list[Row]:
    """Let a Gaussian split, cross a closed line twenty times and meet itself again."""
    rows = []
    for interpolation, cases in HEIGHT_LOST.items():
        for courant, (expected, rounding) in cases.items():
            what = f'{interpolation}, Courant {courant:g}'
            steps = int(CROSSINGS * 200 / courant)
            before = 1.0 - crossed(200, steps, courant, interpolation).max()
            steps = round(CROSSINGS * 200 / courant)
            exactly = CROSSINGS * 200 / steps
            lost = 1.0 - crossed(200, steps, exactly, interpolation).max()
            rows += [
                Row('gaussian', f'height lost at the last step before, {what}', '%', expected,
                    100.0 * float(before), rounding, False, 'digits of the expected value'),
                Row('gaussian', f'height lost at the crossing, {what}', '%',
                    100.0 * height_lost_on_ring(200, steps, interpolation),
                    100.0 * float(lost), *AGAINST_RING[interpolation]),
            ]
    return rows + gaussian_orders()


ORDER_CELLS = (50, 100, 200, 400, 800)


def crossing_errors(interpolation: str) -> list[float]:
    """Return the RMS error [heights] after the crossings, on each of ORDER_CELLS."""
    errors = []
    for cells in ORDER_CELLS:
        steps = round(CROSSINGS * cells / 0.99)
        after = crossed(cells, steps, CROSSINGS * cells / steps, interpolation)
        errors.append(float(np.sqrt(np.mean((after - bell(cells)) ** 2))))
    return errors


def gaussian_orders() -> list[Row]:
    """Return the RMS error on 200 cells, and the order on 50 to 800 cells."""
    rows = []
    for interpolation, order, bar in (('linear', 1.0, 0.05), ('cubic', 3.0, 5e-4)):
        errors = crossing_errors(interpolation)
        rows += [
            Row('gaussian', f'RMS error, 200 cells, {interpolation}', 'heights', 0.0,
                errors[2], bar, False, 'below the loss of height: the bell is narrow'),
            Row('gaussian', f'order, 400 to 800 cells, {interpolation}', '-', order,
                float(np.log2(errors[-2] / errors[-1])), 0.1, False,
                'next term of the error, at 64 cells a width'),
        ]
    return rows


def bell(cells: int) -> np.ndarray:
    """Return the Gaussian of height 1 at the nodes of a line."""
    return np.exp(-((np.arange(cells + 1) / cells - 0.5) / WIDTH) ** 2)


@cache
def crossed(cells: int, steps: int, courant: float, interpolation: str) -> np.ndarray:
    """Return the pressure along the line, in parts of the first height, after so many steps."""
    chain = lone_line((CLOSED, CLOSED), cells, courant=courant, interpolation=interpolation)
    mu = riemann_variable(SMALL * bell(cells))
    set_domain(chain.model, chain.state, 0, mu, mu)
    chain.advance(steps)
    return chain.pressure(0) / SMALL


def height_lost_on_ring(cells: int, steps: int, interpolation: str) -> float:
    """
    Return the part of the height that interpolation alone takes from the bell.

    On a ring of 2 L each step multiplies a Fourier mode by the interpolation's symbol: Lagrange's
    polynomial over the foot's two neighbours (linear) or four (cubic).
    """
    theta = CROSSINGS * cells / steps
    offsets = (0, 1) if interpolation == 'linear' else (-1, 0, 1, 2)
    stencil = np.zeros(2 * cells)
    for k in offsets:
        stencil[k] = math.prod((theta - j) / (k - j) for j in offsets if j != k)
    shape = bell(cells)
    ring = np.concatenate((shape, shape[-2:0:-1]))
    after = np.fft.irfft(np.fft.rfft(ring) * np.fft.rfft(stencil) ** steps, 2 * cells)
    return 1.0 - float(after.max())


CASES = {
    'joukowsky': Case(joukowsky, 'sudden stop of a flow'),
    'organ_pipe': Case(organ_pipe, 'periods of open and closed pipes'),
    'gaussian': Case(gaussian, 'a pulse after twenty crossings'),
}
