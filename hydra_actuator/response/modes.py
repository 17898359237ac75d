# SPDX-License-Identifier: Apache-2.0
"""
Natural frequencies and damping of the distributed plant: zeros of its determinant.

Newton's method on det N(s) from many starts along the imaginary axis. A plant with waves has
infinitely many modes; those are kept that spool or load move the piston with. A mode is
s = omega (-zeta +- i sqrt(1 - zeta^2)).
"""

import math
from typing import NamedTuple

from hydra_actuator.response.distributed import Plant, SPEED, system
import numpy as np

STEPS = 40
# Last step of a found mode, how near two of them are one, and the longest step, all relative.
SETTLED, SAME, LONGEST = 1e-8, 1e-5, 0.3
DIFFERENCE = 1e-6
# Starts per search, by damping ratio: lightly and strongly damped modes are found.
STARTS, LEANS = 32, (0.01, 0.3)
# Share of a mode in the piston's speed, over that of the strongest, below which it is left out.
UNSEEN = 1e-5
# Distance at which residues are taken, relative, and by how much a pole stands out there.
NEAR, ABOVE_REST = 1e-4, 0.01


class Mode(NamedTuple):
    """A natural frequency [Hz], |s|/(2 pi), and its damping ratio [-]."""

    frequency: float
    damping: float


def find_modes(plant: Plant, highest: float, inputs: tuple[int, ...] = (0, 1)) -> list[Mode]:
    """
    Return the oscillating modes up to a frequency [Hz], lowest first.

    inputs: 0 those that the spool excites, 1 those that the load does.
    """
    lowest = highest / 1000.0
    starts = 2.0 * math.pi * np.concatenate([
        np.geomspace(lowest, highest, STARTS // 2), np.linspace(lowest, highest, STARTS)])
    starts = np.concatenate([starts * complex(-lean, 1.0) for lean in LEANS])
    with np.errstate(all='ignore'):
        found = _newton(plant, starts)
    found = found[(found.imag > 1e-6 * np.abs(found))
                  & (np.abs(found) <= 2.0 * math.pi * highest)]
    distinct: list[complex] = []
    for s in found[np.argsort(np.abs(found))]:
        if all(abs(s - other) > SAME * abs(s) for other in distinct):
            distinct.append(complex(s))
    if not distinct:
        return []
    shares = _shares(plant, np.array(distinct))[:, list(inputs)]
    strongest = shares.max(axis=0)
    strongest[strongest == 0.0] = math.inf
    seen = (shares / strongest > UNSEEN).any(axis=1)
    return [Mode(abs(s) / (2.0 * math.pi), -s.real / abs(s))
            for s, keep in zip(distinct, seen) if keep]


def _newton(plant: Plant, starts: np.ndarray) -> np.ndarray:
    """Return where the starts end, those that settled."""
    found: list[np.ndarray] = []
    s = starts
    for _ in range(STEPS):
        h = DIFFERENCE * np.abs(s)
        sign, size = np.linalg.slogdet(system(plant, np.concatenate([s, s + h, s - h]))[0])
        (here, ahead, behind), (at, to, back) = sign.reshape(3, -1), size.reshape(3, -1)
        rise = ahead / here * np.exp(to - at) - behind / here * np.exp(back - at)
        step = np.where(here == 0.0, 0.0, -2.0 * h / rise)
        sane = np.isfinite(step)
        step = np.where(sane, step, 0.0)
        step *= np.minimum(1.0, LONGEST * np.abs(s) / np.maximum(np.abs(step), 1e-300))
        s = s + step
        s = np.where(s.imag < 0.0, s.conj(), s)
        settled = np.abs(step) < SETTLED * np.abs(s)
        found.append(s[settled & sane])
        s = s[~settled & sane]
        if not len(s):
            break
    return np.concatenate(found)


def _shares(plant: Plant, s: np.ndarray) -> np.ndarray:
    """Return the residues (N, 2) of the piston's speed over |s|, for spool and load, 0: none."""
    near = NEAR * np.abs(s)
    with np.errstate(all='ignore'):
        ahead, behind = (np.linalg.solve(*system(plant, at))[:, SPEED]
                         for at in (s + near, s - near))
    pole, rest = np.abs(ahead - behind), np.abs(ahead + behind)
    return np.where(pole > ABOVE_REST * rest, 0.5 * NEAR * pole, 0.0)
