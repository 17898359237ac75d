# SPDX-License-Identifier: Apache-2.0
"""
Natural frequencies of the lines and of the piston between its oil columns, valve closed.

    pump at constant pressure |---- supply_line ----| closed valve:  (2 n - 1) c / (4 l)
    closed valve |- line_1 -|- chamber_1 -] M [- chamber_2 -|- line_2 -| closed valve

The second is a mass on two stepped tubes. With B_i the susceptance that the piston sees on a
side (W = A/(rho c), l the length, a = omega l/c of line and chamber),

    B = W_c (W_l tan a_l + W_c tan a_c) / (W_c - W_l tan a_l tan a_c)
    stiffness k - omega^2 M + omega (A_1^2/B_1 + A_2^2/B_2) = 0

Linear lossless waves (Wylie and Streeter, "Fluid Transients in Systems", 1993, chapter 12);
neglected: friction, the resistance of the ports, the valve's opening, free gas, the piston's
travel about its place.
"""

from collections.abc import Mapping
import math
from typing import NamedTuple

from hydra_actuator.parameters.streamline import wave_speed
import numpy as np

GRID = 40_000           # frequencies among which a root is looked for
BISECTIONS = 60


class Frequency(NamedTuple):
    """A natural frequency [Hz] and whose it is."""

    value: float
    name: str


def line_frequencies(values: Mapping[str, object], position: float,
                     highest: float) -> list[Frequency]:
    """Return the frequencies up to the highest [Hz], piston about a position [m], sorted."""
    found = []
    for line in ('supply_line', 'return_line'):
        quarter = wave_speed(values, line) / (4.0 * values[f'{line}.length'])
        count = int((highest / quarter + 1.0) // 2.0)
        found += [Frequency((2 * n + 1) * quarter, line) for n in range(count)]
    found += [Frequency(value, 'piston and oil')
              for value in piston_frequencies(values, position, highest)]
    return sorted(found)


def piston_frequencies(values: Mapping[str, object], position: float,
                       highest: float) -> list[float]:
    """Return the roots [Hz] of the piston between its columns of oil, lowest first."""
    omega = np.linspace(0.0, 2.0 * math.pi * highest, GRID + 1)[1:]
    residue = _residue(values, position, omega)
    signs = np.signbit(residue[:-1]) != np.signbit(residue[1:])
    roots = []
    for k in np.flatnonzero(signs):
        low, high = omega[k], omega[k + 1]
        below = np.signbit(residue[k])
        for _ in range(BISECTIONS):
            middle = 0.5 * (low + high)
            if np.signbit(_residue(values, position, np.array([middle]))[0]) == below:
                low = middle
            else:
                high = middle
        roots.append(0.5 * (low + high) / (2.0 * math.pi))
    return roots


def _residue(values: Mapping[str, object], position: float, omega: np.ndarray) -> np.ndarray:
    """Return the determinant at omega [rad/s], without poles: signs change at roots alone."""
    sides = [_side(values, number, sign * position, omega)
             for number, sign in ((1, 1.0), (2, -1.0))]
    (top_1, under_1, area_1), (top_2, under_2, area_2) = sides
    inertia = values['cylinder.stiffness'] - omega**2 * values['cylinder.mass']
    return (inertia * top_1 * top_2
            + omega * (area_1**2 * under_1 * top_2 + area_2**2 * under_2 * top_1))


def _side(values: Mapping[str, object], number: int, position: float,
          omega: np.ndarray) -> tuple[np.ndarray, np.ndarray, float]:
    """Return numerator and denominator of a side's susceptance, and the piston's area."""
    line, area = f'line_{number}', values[f'cylinder.area_{number}']
    speeds = wave_speed(values, line), wave_speed(values)
    chamber = (values[f'cylinder.dead_length_{number}'] + 0.5 * values['cylinder.stroke']
               + position)
    along_line, along_chamber = (omega * length / speed for length, speed in zip(
        (values[f'{line}.length'], chamber), speeds))
    density = values['fluid.density']
    of_line = 0.25 * math.pi * values[f'{line}.diameter']**2 / (density * speeds[0])
    of_chamber = area / (density * speeds[1])
    sin_l, cos_l = np.sin(along_line), np.cos(along_line)
    sin_c, cos_c = np.sin(along_chamber), np.cos(along_chamber)
    top = of_chamber * (of_line * sin_l * cos_c + of_chamber * cos_l * sin_c)
    return top, of_chamber * cos_l * cos_c - of_line * sin_l * sin_c, area
