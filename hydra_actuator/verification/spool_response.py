# SPDX-License-Identifier: Apache-2.0
"""
From spool to piston velocity about the null of the valve, against the exact linear response.

    u_B -> B ==== C D ==== E ] M, k, delta [ F ==== G H ==== I -> u_I

At x = 0 all edges are closed and see (p_s - p_t)/2 each, so to first order the flow into B and
out of I is C_d w sqrt((p_s - p_t)/rho0) x for either sign of x, whatever supply and return line
do; ports and wall losses are of second order. What is left are lossless lines at the density of
the mean pressure, the piston and its spring. Second-order terms scale with the amplitude.
"""

from functools import cache
import math

from hydra_actuator.actuator import Actuator, SolverError
from hydra_actuator.geometry import wave_speed
from hydra_actuator.parameters import Parameters
from hydra_actuator.response.distributed import linear_plant, respond
from hydra_actuator.response.operating_point import find_operating_point
from hydra_actuator.verification.case import Case, Row
from hydra_actuator.verification.drawing import band, EXACT_LINE, SIMPLER, SOLVER_POINT
from hydra_actuator.verification.harmonics import first_harmonic
import numpy as np

# Spool amplitude, of its stroke: errs by the pressure's amplitude over p_s - p_t, below 1e-4.
AMPLITUDE = 1e-5
# Nothing but the piston's damper (25 1/s) ends a transient, so the sine fades in softly.
FADE_IN, WINDOW = 0.3, 0.1
SAMPLES = 48
# Frequency [Hz] and gain [1/s] computed independently, for config/paper.yaml.
EXPECTED = {10: 2848.5, 50: 3093.5, 100: 4220.6, 150: 10487.6, 200: 9742.5, 300: 1569.5,
            500: 469.94, 700: 264.47}
RESONANCE = 175.7
LUMPED_AT_700_HZ = 194.2
GAIN_BAR, PHASE_BAR = 2e-4, 1e-4


def paper_parameters() -> Parameters:
    """Return the parameters of the paper's reference, as config/paper.yaml has them."""
    return Parameters().replace({'tank.pressure': 0.0})


def exact_response(p: Parameters, frequency: float, lumped: bool = False) -> complex:
    """
    Return the exact response, piston velocity over spool displacement [1/s], at a frequency [Hz].

    lumped: with each line and chamber as one volume of oil without inertia.
    """
    s, c = 2j * math.pi * frequency, wave_speed(p)
    mean = 0.5 * (p['initial.pressure_1'] + p['initial.pressure_2'])
    ratio = 1.0 + mean / p['fluid.bulk_modulus']
    half_drop = 0.5 * (p['supply.pressure'] - p['tank.pressure'])
    flow_gain = (p['valve.discharge_coefficient'] * p['valve.area_gradient']
                 * math.sqrt(2.0 * half_drop / p['fluid.density'])) / ratio
    load = p['cylinder.mass'] * s + p['cylinder.viscous_friction'] + p['cylinder.stiffness'] / s
    drive = 0.0
    for side in (1, 2):
        area = p[f'cylinder.area_{side}']
        length = p[f'cylinder.dead_length_{side}'] + 0.5 * p['cylinder.stroke']
        bore = 0.25 * math.pi * p[f'line_{side}.diameter'] ** 2
        if lumped:
            volume = area * length + bore * p[f'line_{side}.length']
            top, bottom = 1.0, -s * volume / (p['fluid.density'] * ratio * c * c)
        else:
            density = p['fluid.density'] * ratio
            (top, _), (bottom, _) = (
                _line(s * length / c, density * c / area)
                @ _line(s * p[f'line_{side}.length'] / c, density * c / bore))
        # p_face = (top q_face - q_valve)/bottom, as the line's matrix has determinant 1; q runs
        # towards the piston: + flow_gain x and + A v on side 1, the negatives on side 2
        drive += area * flow_gain / bottom
        load -= area * area * top / bottom
    return -drive / load


def _line(travel: complex, impedance: float) -> np.ndarray:
    """Return the matrix of a lossless line from (p, q) before it to (p, q) after it."""
    return np.array([
        [np.cosh(travel), -impedance * np.sinh(travel)],
        [-np.sinh(travel) / impedance, np.cosh(travel)]])


def solver_response(p: Parameters, frequency: float) -> complex:
    """Return the solver's response [1/s] to a small sine of the spool about null."""
    actuator = Actuator(p)
    omega, dt = 2.0 * math.pi * frequency, actuator.step_time
    every = max(1, round(1.0 / (frequency * SAMPLES * dt)))
    _follow(actuator, omega, round(FADE_IN / dt))
    trace = np.empty((round(WINDOW / dt) // every, 2))
    for row in trace:
        _follow(actuator, omega, every)
        row[:] = actuator.time, actuator.row[actuator.channels.VELOCITY]
    return first_harmonic(*trace.T, omega) / (AMPLITUDE * p['valve.stroke'])


@cache
def paper_response(frequency: float) -> complex:
    """Return the solver's response [1/s] with the paper's parameters."""
    return solver_response(paper_parameters(), frequency)


def _follow(actuator: Actuator, omega: float, steps: int) -> None:
    first = round(actuator.time / actuator.step_time)
    times = np.arange(first + 1, first + steps + 1) * actuator.step_time
    commands = np.zeros((steps, 3))
    spool = AMPLITUDE * soft_step(times / FADE_IN) * np.sin(omega * times)
    commands[:, 0] = commands[:, 1] = spool
    code = actuator.follow((times, commands, True), steps)
    if code:
        raise SolverError(actuator.status_message(code))


def soft_step(phase: np.ndarray) -> np.ndarray:
    """Return a step from 0 to 1 over the phase 0 to 1, with three continuous derivatives."""
    z = np.clip(phase, 0.0, 1.0)
    return z ** 4 * (35.0 - 84.0 * z + 70.0 * z ** 2 - 20.0 * z ** 3)


def spool_response() -> list[Row]:
    """Compare gain and phase at eight frequencies; the general linear plant with the formula."""
    name, p, rows = 'spool_response', paper_parameters(), []
    general = respond(linear_plant(find_operating_point(p)), list(EXPECTED)).velocity
    formula = np.array([exact_response(p, frequency) for frequency in EXPECTED])
    rows.append(Row(
        name, 'linear plant of the whole streamline, largest distance from the formula', '-', 0.0,
        float(np.abs(general / formula - 1.0).max()), 1e-11, False,
        'rounding, times the resonance'))
    for frequency, gain in EXPECTED.items():
        exact, got = exact_response(p, frequency), paper_response(frequency)
        rows += [
            Row(name, f'{frequency} Hz, exact formula', '1/s', gain, abs(exact), 5e-5, True,
                'digits of the expected value'),
            Row(name, f'{frequency} Hz, solver', '1/s', abs(exact), abs(got), GAIN_BAR, True,
                'second order in the cell: 1e-4 at 700 Hz, where a wave has 93 cells'),
            Row(name, f'{frequency} Hz, solver against exact, phase', 'rad', 0.0,
                float(np.angle(got / exact)), PHASE_BAR, False, 'as the gain'),
        ]
    rows.append(Row(
        name, '700 Hz, lumped model', '1/s', LUMPED_AT_700_HZ,
        abs(exact_response(p, 700, lumped=True)), 5e-4, True,
        'digits of the expected value; 27 % below the distributed model'))
    frequencies = np.arange(170.0, 180.0, 0.05)
    gains = [abs(exact_response(p, frequency)) for frequency in frequencies]
    rows.append(Row(name, 'resonance, exact formula', 'Hz', RESONANCE,
                    float(frequencies[np.argmax(gains)]), 0.1, False, 'digits and the search'))
    return rows


def draw_spool_response(figure) -> None:
    """Draw Bode's diagram, with the lumped model for comparison, and the errors."""
    p, panels = paper_parameters(), figure.subplots(2, 2, sharex=True, height_ratios=(3, 1.4))
    fine = np.geomspace(5.0, 1000.0, 600)
    exact = np.array([exact_response(p, frequency) for frequency in fine])
    lumped = np.array([exact_response(p, frequency, lumped=True) for frequency in fine])
    places = np.array(list(EXPECTED), float)
    got = np.array([paper_response(frequency) for frequency in EXPECTED])
    ratio = got / np.array([exact_response(p, frequency) for frequency in EXPECTED])
    gain, phase = panels[0]
    for axes, value in ((gain, np.abs), (phase, lambda response: np.degrees(np.angle(response)))):
        axes.plot(fine, value(exact), **{**EXACT_LINE, 'label': 'exact, distributed oil'})
        axes.plot(fine, value(lumped), **{**SIMPLER, 'label': 'lumped oil'})
        axes.plot(places, value(got), **SOLVER_POINT)
        axes.set_xscale('log')
        axes.legend()
    gain.set_yscale('log')
    gain.set_title('gain, piston velocity over spool displacement [1/s]', loc='left')
    phase.set_title('phase [degrees]', loc='left')
    phase.set_yticks(range(-180, 1, 45))
    for axes, error, tolerance, label in (
            (panels[1, 0], np.abs(ratio) - 1.0, GAIN_BAR, 'error of the gain, relative'),
            (panels[1, 1], np.angle(ratio), PHASE_BAR, 'error of the phase [rad]')):
        axes.plot(places, error, **SOLVER_POINT)
        band(axes, tolerance)
        axes.set_title(label, loc='left')
        axes.set_xlabel('frequency [Hz]')
    ticks = (5, 10, 20, 50, 100, 200, 500, 1000)
    panels[1, 0].set_xticks(ticks, [str(one) for one in ticks])
    panels[1, 0].set_xticks([], minor=True)
    panels[1, 0].legend(ncols=2, loc='lower left')
    for axes in panels.flat:
        axes.grid(True)


CASES = {
    'spool_response': Case(spool_response, 'spool to piston velocity about null',
                           figure=draw_spool_response),
}
