# SPDX-License-Identifier: Apache-2.0
"""
Exact linear waves in a line with laminar friction, by Laplace transform.

    g(s) = sqrt(I0(z)/I2(z)), z = r sqrt(s/nu):  s -> s g in the lossless line's transfer functions

Stopped at x = L, pressure held at x = 0:   p'/(Zc Q0) = g tanh(s T g)/s,  T = L/c
Blocked at x = L, pressure driven at x = 0: p(L)/p(0) = 1/cosh(s T g)

Time is counted in T, so that z^2 = s/Dn with Dn = nu L/(c r^2). Zielke, J. Basic Eng. 90, 1968,
109-115; Talbot's contour as in Abate and Valko, Int. J. Numer. Meth. Engng 60, 2004, 979-993.
Neglected, as in the source: axial viscosity, radial pressure, convection, heat.
"""

import numpy as np

# Both converged: a third more points or twice the depth change no value by 1e-9.
CONTOUR_POINTS = 24
FRACTION_DEPTH = 300


def propagation(s, dissipation: float):
    """Return g [-] at complex s [1/T] off the negative real axis, for a dissipation number Dn."""
    z = np.sqrt(np.asarray(s, complex) / dissipation)
    ratio = np.zeros_like(z)
    below = ratio
    # Gauss's continued fraction from below: ratio = I_{k+1}/I_k, below = I_{k+2}/I_{k+1}
    for k in range(FRACTION_DEPTH, -1, -1):
        below, ratio = ratio, 1.0 / (2.0 * (k + 1) / z + ratio)
    return 1.0 / np.sqrt(ratio * below)


def stopped_flow(time: float, dissipation: float) -> float:
    """
    Return p'(L)/(Zc Q0) [-] at a time [T] after the stop, not at a front (an even time).

    tanh is opened into its echoes, 1 + 2 sum (-1)^n exp(-2 n s g): what is left of the n-th after
    its delay of 2 n is smooth, and its singularities are on the negative real axis.
    """
    total, echo = 0.0, 0
    while 2 * echo < time:
        weight = 2.0 * (-1.0) ** echo if echo else 1.0
        total += weight * _echo(time - 2.0 * echo, echo, dissipation)
        echo += 1
    return total


def _echo(time: float, echo: int, dissipation: float) -> float:
    """Invert g/s exp(-2 n s (g - 1)) on Talbot's contour at a time [T] after its front."""
    angle = np.arange(1, CONTOUR_POINTS) * np.pi / CONTOUR_POINTS
    cotangent = 1.0 / np.tan(angle)
    radius = 0.4 * CONTOUR_POINTS / time
    s = np.append(radius, radius * angle * (cotangent + 1j))
    speed = np.append(0.5, 1.0 + 1j * (angle * (1.0 + cotangent ** 2) - cotangent))
    g = propagation(s, dissipation)
    image = g / s * np.exp(-2.0 * echo * s * (g - 1.0))
    return float(np.sum((np.exp(time * s) * speed * image).real) * radius / CONTOUR_POINTS)


def blocked_response(frequency, dissipation: float) -> np.ndarray:
    """Return |p(L)/p(0)| [-] of a blocked line at frequencies [1/T]."""
    s = 2j * np.pi * np.asarray(frequency, float)
    return np.abs(1.0 / np.cosh(s * propagation(s, dissipation)))
