# SPDX-License-Identifier: Apache-2.0
"""
The work that all do, and how what comes out is judged.

    reservoir ======== 1000 m, 200 reaches, 0.5 m/s ======== valve, closed within one step

Water, 1219.2 m/s (RTHYM-MOC's only speed for a rigid pipe), walls as smooth as each program takes.
The valve's head must rise by a V/g at once (Joukowsky) and stay there until the wave has been to
the reservoir and back. A script of this folder gets the work as JSON and prints as JSON: version,
seconds (computing time of all steps, without set-up), steps, nodes, velocity before, wave_speed,
closed (the first
step with the valve shut), head [m] at the valve by step.
"""

from typing import NamedTuple

import numpy as np

GRAVITY = 9.80665
WORK = {'length': 1000.0, 'diameter': 0.3, 'velocity': 0.5, 'head': 150.0, 'wave_speed': 1219.2,
        'cells': 200}


class Measured(NamedTuple):
    """One run: node updates per second, error of the rise as a part of it, version."""

    updates: float
    error: float
    version: str


def judge(found: dict) -> Measured:
    """Return what the JSON of a script says."""
    rise = found['wave_speed'] * found['velocity'] / GRAVITY
    return Measured(found['nodes'] * found['steps'] / found['seconds'],
                    rise_error(np.array(found['head']), found['closed'], found['nodes'], rise),
                    found['version'])


def rise_error(head: np.ndarray, closed: int, nodes: int, rise: float) -> float:
    """
    Return the mean of the first plateau less the exact rise, as a part of it.

    head [m] at the valve by step; closed: the step from which it is; rise [m].
    """
    first, last = closed + nodes // 4, closed + 7 * nodes // 4
    return float(head[first:last].mean() - head[closed - 1]) / rise - 1.0
