# SPDX-License-Identifier: Apache-2.0
"""
The slow limit of the linear responses, by formula: stiffness, no-load speed, droop.

Far below the natural frequency omega_h the waves and the oil's inertia vanish (Merritt, "Hydraulic
Control Systems", 1967):

    closed valve     F/x = 4 beta A^2/V_t + k - m omega^2
    no load          v/x_spool = (K_q/A)/(1 - (omega/omega_h)^2), K_q = C_d w sqrt((p_s - p_t)/rho)
    underlapped      v/x_spool = 2 K_q/A; F/v = A^2/K_c, K_c = K_q U/(p_s - p_t)

beta = chi + p and flows count at the density of the chambers, rho0 (1 + p/chi).
"""

import math

from hydra_actuator.parameters import Parameters
from hydra_actuator.response.distributed import linear_plant, respond
from hydra_actuator.response.operating_point import find_operating_point
from hydra_actuator.response.solver import solver_responses
from hydra_actuator.verification.case import Case, Row
import numpy as np

SLOW, DRIVEN = 0.1, 10.0
UNDERLAP = 2e-5
PRESSURE, SPAN = 10.5e6, 21e6
BASE = {'tank.pressure': 0.0, 'cylinder.viscous_friction': 0.0, 'cylinder.stiffness': 0.0}
LINES = ('supply_line', 'line_1', 'line_2', 'return_line')


def _parameters(changes: dict) -> Parameters:
    return Parameters().replace({
        **BASE, **{f'{line}.friction': 'none' for line in LINES}, **changes})


def _constants() -> tuple[float, float, float]:
    """Return stiffness of the oil [N/m], K_q/A at the chambers' density and K_c A^-2 for U."""
    p = Parameters()
    area, chi, rho = p['cylinder.area_1'], p['fluid.bulk_modulus'], p['fluid.density']
    volume = 2.0 * (area * 0.2 + 0.25 * math.pi * p['line_1.diameter'] ** 2 * 0.2)
    ratio = 1.0 + PRESSURE / chi
    flow_gain = (p['valve.discharge_coefficient'] * p['valve.area_gradient']
                 * math.sqrt(SPAN / rho)) / ratio
    return (4.0 * (chi + PRESSURE) * area ** 2 / volume, flow_gain / area,
            flow_gain * UNDERLAP / SPAN / area ** 2)


def response_low_frequency() -> list[Row]:
    """Compare the slow responses of plant and solver with the formulas."""
    name, rows = 'response_low_frequency', []
    oil, speed, droop = _constants()
    mass, spring = 10.0, 2e5
    closed = find_operating_point(_parameters({'cylinder.stiffness': spring}))
    free = find_operating_point(_parameters({}))
    laps = {f'valve.overlap_{edge}': -UNDERLAP for edge in ('pa', 'pb', 'at', 'bt')}
    open_ = find_operating_point(_parameters(laps))
    for label, f, tolerance, reason in (
            ('linear plant', SLOW, 1e-6, 'square of frequency over natural frequency, 3e-7'),
            ('solver', DRIVEN, 2e-4, "inertia of the oil and its mass in the spring's motion")):
        omega = 2.0 * math.pi * f
        stiffness, no_load, leaky = (_responses(point, f, label) for point in
                                     (closed, free, open_))
        natural = oil / mass
        # mass on the series of oil and leak: v (1 + m s (s/oil + droop)) = 2 K_q/A x
        inertia = complex(1.0 - omega ** 2 / natural, omega * droop * mass)
        for quantity, unit, expected, got in (
                (f'load stiffness, {label} at {f:g} Hz', 'N/m', oil + spring - mass * omega ** 2,
                 abs(stiffness.stiffness[0])),
                (f'no-load speed, {label} at {f:g} Hz', '1/s', speed / (1 - omega ** 2 / natural),
                 abs(no_load.velocity[0])),
                (f'speed of an underlapped valve, {label} at {f:g} Hz', '1/s',
                 2.0 * speed / abs(inertia), abs(leaky.velocity[0])),
                (f'load over speed of an underlapped valve, {label} at {f:g} Hz', 'N s/m',
                 abs(_load_over_speed(oil, droop, mass, omega)),
                 abs(leaky.stiffness[0]) / omega)):
            rows.append(Row(name, quantity, unit, expected, float(got), tolerance, True, reason))
    return rows


def _load_over_speed(oil: float, droop: float, mass: float, omega: float) -> complex:
    """Return F/v [N s/m] of oil and leak in series beside a mass."""
    s = 1j * omega
    return mass * s + 1.0 / (s / oil + droop)


def _responses(point, frequency: float, label: str):
    if label == 'solver':
        return solver_responses(point, np.array([frequency]))
    return respond(linear_plant(point), np.array([frequency]))


CASES = {'response_low_frequency': Case(
    response_low_frequency, 'stiffness, no-load speed and droop in the slow limit')}
