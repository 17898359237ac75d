# SPDX-License-Identifier: Apache-2.0
"""
Friction of the oil on a line's wall, as a deceleration [m/s^2] of the flow.

    J = lambda u|u|/2 + h(|u|) u + memory          dP/dt = -J along u + c, dQ/dt = +J along u - c

`constant`: lambda given, h = 0. `steady`: h = f |u|/(2 D) with the Darcy factor f of Churchill,
"Friction-factor equation spans all fluid-flow regimes", Chemical Engineering 84(24), 1977, 91-92:
all Reynolds numbers, relative roughness up to 0.05, smooth through transition, 64/Re when
laminar, where h = 32 nu/D^2 whatever the flow. `unsteady`: the steady law and the memory of
laminar flow (Zielke, "Frequency-dependent friction in transient pipe flow", J. Basic Eng. 90,
1968, 109-115), six decaying terms per node and what they leave out as an inertia:

    z = n nu dt/r^2,  y <- y exp(-z) + m (1 - exp(-z))/z du
    memory = nu/r^2 [4 sum y + 4 (1/12 - sum m/n) du r^2/(nu dt)]

Neglected: memory of turbulent profiles, entrance lengths, heating.
"""

import math

from hydra_actuator.core.compilation import formula
import numpy as np

# Fitted to Zielke's weight; its integral is exactly 1/12.
DECAY = (26.375, 85.016, 354.391, 1843.37, 10338.9, 59903.7)
WEIGHT = (1.0069, 1.7759, 4.6982, 11.5979, 28.1976, 69.2549)
TERMS = len(DECAY)

# h is tabled over sqrt|u|: exact where it is constant (laminar), dense where transition is.
TABLE_SIZE = 4096
LAST_PLACE = TABLE_SIZE - 1.000001


def darcy_factor(reynolds: np.ndarray, relative_roughness: float) -> np.ndarray:
    """Return Churchill's Darcy friction factor [-] of Reynolds numbers above 0."""
    reynolds = np.asarray(reynolds, float)
    rough = (7.0 / reynolds) ** 0.9 + 0.27 * relative_roughness
    a = (-2.457 * np.log(rough)) ** 16
    b = (37530.0 / reynolds) ** 16
    with np.errstate(over='ignore'):
        return 8.0 * ((8.0 / reynolds) ** 12 + (a + b) ** -1.5) ** (1.0 / 12.0)


def damping_table(diameter: float, viscosity: float, roughness: float,
                  fastest: float) -> np.ndarray:
    """
    Return h [1/s] of a line at TABLE_SIZE values of sqrt|u| from 0 to sqrt(fastest).

    diameter and roughness [m], kinematic viscosity [m^2/s], fastest |u| [m/s].
    """
    speed = fastest * np.linspace(0.0, 1.0, TABLE_SIZE) ** 2
    laminar = 32.0 * viscosity / diameter ** 2
    table = np.full(TABLE_SIZE, laminar)
    moving = speed[1:]
    factor = darcy_factor(moving * diameter / viscosity, roughness / diameter)
    table[1:] = 0.5 * factor * moving / diameter
    return table


def memory_constants(radius: float, viscosity: float,
                     step_time: float) -> tuple[np.ndarray, np.ndarray, float]:
    """
    Return (exp(-z) (TERMS,), gain of du on each y (TERMS,) [1/s], inertia [1/s]).

    The y's are kept times 4 nu/r^2, so that their sum is a deceleration [m/s^2].
    """
    rate = viscosity / radius ** 2
    n, m = np.array(DECAY), np.array(WEIGHT)
    z = n * rate * step_time
    gain = 4.0 * rate * m * -np.expm1(-z) / z
    inertia = 4.0 * (1.0 / 12.0 - np.sum(m / n)) / step_time
    return np.exp(-z), gain, float(inertia)


@formula
def damping_at(speed, table, table_scale):
    """Return h [1/s] at a speed [m/s]; table and table_scale as in `steady_drag`."""
    damping, start = table
    place = math.sqrt(speed) * table_scale
    # so put that what is no number has a place in the table too
    place = place if place < LAST_PLACE else LAST_PLACE
    k = int(place)
    low = damping[start + k]
    return low + (place - k) * (damping[start + k + 1] - low)


@formula
def steady_drag(velocity, loss_coefficient, table, table_scale):
    """
    Return the steady deceleration [m/s^2] at a velocity [m/s].

    table: (damping h [1/s] over sqrt|u| of all lines, where this line's begins);
    table_scale: entries per sqrt(m/s).
    """
    size = abs(velocity)
    return velocity * (0.5 * loss_coefficient * size + damping_at(size, table, table_scale))
