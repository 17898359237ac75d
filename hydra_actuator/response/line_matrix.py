# SPDX-License-Identifier: Apache-2.0
"""
A line, linear about its steady flow: the matrix from (dp, dq) at its start to those at its end.

With m = d mu, w = d u about mu0(x), u0(x), s the complex frequency, primes d/dx:

    s g m + u0 m' + mu0' w + c w' = 0
    s w + u0 w' + u0' w + c m' + J'(u0) w + memory(s) w = 0

    dp = rho c m,   dq = A (rho/rho0) (w + u0 m/c)

J is the line's own law of friction; memory(s) = s (I0(z)/I2(z) - 1) - 8 nu/r^2, z = r sqrt(s/nu),
what Zielke's weight does in the exact laminar line (J. Basic Eng. 90, 1968, 109-115);
g = 1 + alpha0 floor rho c^2/p*^2 the free gas (hydra_actuator.core.cavity). Exact where oil is at
rest or nothing resists it; where the steady flow loses pressure mu0 and u0 vary, and the line is
cut into SEGMENTS of constant coefficients, of second order. Neglected: that gas is carried along.
"""

import math
from typing import NamedTuple

from hydra_actuator.core.friction import steady_drag
from hydra_actuator.core.model import Model
from hydra_actuator.steady_flow import line_profile, mu_of
import numpy as np

SEGMENTS = 32
# Relative step of the slope of the friction's law, which is tabled.
SPEED_STEP = 1e-4


class LineState(NamedTuple):
    """
    The steady state along a line, in its own direction of positive flow.

    length [m]; mu and u [m/s] at the two ends and in the middle of each segment, gradients of
    both [1/s] and J' [1/s] there; wave speed [m/s], area [m^2], density at gauge 0 [kg/m^3];
    memory: nu/r^2 [1/s], 0 without; gas: alpha0 floor [Pa]; floor [Pa].
    """

    length: float
    mu: np.ndarray
    u: np.ndarray
    mu_slope: np.ndarray
    u_slope: np.ndarray
    resistance: np.ndarray
    mu_ends: tuple[float, float]
    u_ends: tuple[float, float]
    speed: float
    area: float
    density: float
    memory: float
    gas: float
    floor: float


def line_state(model: Model, d: int, length: float, pressure: float, flow: float,
               unsteady_rate: float, gas: float) -> LineState:
    """
    Return the steady state of domain d.

    length [m]; pressure: gauge [Pa] where it begins (chamber_2: at the face); flow [m^3/s at
    reference density] along the streamline; unsteady_rate: nu/r^2 [1/s] of a line with memory,
    else 0; gas: alpha0 times floor [Pa].
    """
    speed, area, node = float(model.wave_speed[d]), float(model.area[d]), model.start[d]
    table = (model.damping, model.table_start[node])

    def drag(u: float) -> float:
        return float(steady_drag.py_func(u, model.loss[node], table, model.table_scale))

    mu_start = mu_of(model, d, pressure)
    resists = flow != 0.0 and not model.moving[d] and drag(
        flow / area) != 0.0
    count = SEGMENTS if resists else 1
    profile = (line_profile(model, d, mu_start, flow, 2 * count) if resists
               else np.full(3, mu_start))
    u = flow / area * np.exp(-profile / speed)
    middle, at = profile[1::2], u[1::2]
    falls = np.array([drag(x) for x in at])
    mu_slope = -falls / (speed * (1.0 - (at / speed) ** 2))
    step = np.maximum(SPEED_STEP * np.abs(at), 1e-9)
    resistance = np.array([(drag(x + h) - drag(x - h)) / (2.0 * h) for x, h in zip(at, step)])
    return LineState(
        length, middle, at, mu_slope, -at * mu_slope / speed, resistance,
        (float(profile[0]), float(profile[-1])), (float(u[0]), float(u[-1])), speed, area,
        float(model.bulk_modulus[d]) / speed ** 2, unsteady_rate, gas, float(model.floor))


def line_matrix(line: LineState, s: np.ndarray) -> np.ndarray:
    """Return the matrices (F, 2, 2) from (dp, dq) at the start to (dp, dq) at the end."""
    s = np.asarray(s, complex)
    product = np.broadcast_to(np.eye(2, dtype=complex), (len(s), 2, 2))
    extra = memory(line.memory, s)
    for k in range(len(line.mu)):
        product = _exponential(_generator(line, k, s, extra)) @ product
    return _to_flow(line, 1) @ product @ np.linalg.inv(_to_flow(line, 0))


def memory(rate: float, s: np.ndarray) -> np.ndarray:
    """Return what laminar friction remembers [1/s], for a rate nu/r^2 [1/s]; 0 for rate 0."""
    if rate == 0.0:
        return np.zeros_like(s)
    from scipy.special import ive

    z = np.sqrt(s / rate)
    return s * (ive(0, z) / ive(2, z) - 1.0) - 8.0 * rate


def pressure_of_mu(line: LineState, mu: float) -> float:
    """Return the gauge pressure [Pa] at mu [m/s]."""
    return line.density * line.speed ** 2 * math.expm1(mu / line.speed)


def _generator(line: LineState, k: int, s: np.ndarray, extra: np.ndarray) -> np.ndarray:
    """Return the matrices (F, 2, 2) of d(m, w)/dx times the length of segment k."""
    u, c = line.u[k], line.speed
    rho = line.density * math.exp(line.mu[k] / c)
    star = pressure_of_mu(line, line.mu[k]) + line.floor
    softness = 1.0 + (line.gas * rho * c * c / star ** 2 if line.gas > 0.0 else 0.0)
    rate = np.zeros((len(s), 2, 2), complex)
    rate[:, 0, 0] = s * softness
    rate[:, 0, 1] = line.mu_slope[k]
    rate[:, 1, 1] = s + line.resistance[k] + line.u_slope[k] + extra
    inverse = np.array([[u, -c], [-c, u]]) / (c * c - u * u)
    return (inverse @ rate) * (line.length / len(line.mu))


def _exponential(a: np.ndarray) -> np.ndarray:
    """Return exp of matrices (F, 2, 2): e^t (cosh d + sinh(d)/d (A - t)), t half the trace."""
    t = 0.5 * (a[:, 0, 0] + a[:, 1, 1])
    rest = a - t[:, None, None] * np.eye(2)
    square = rest[:, 0, 0] ** 2 + rest[:, 0, 1] * rest[:, 1, 0]
    d = np.sqrt(square)
    small = np.abs(d) < 1e-6
    quotient = np.where(small, 1.0 + square / 6.0, np.sinh(d) / np.where(small, 1.0, d))
    result = np.cosh(d)[:, None, None] * np.eye(2) + quotient[:, None, None] * rest
    return np.exp(t)[:, None, None] * result


def _to_flow(line: LineState, end: int) -> np.ndarray:
    """Return the matrix from (m, w) to (dp, dq) at an end."""
    ratio = math.exp(line.mu_ends[end] / line.speed)
    area = line.area * ratio
    return np.array([[line.density * ratio * line.speed, 0.0],
                     [area * line.u_ends[end] / line.speed, area]])
