# SPDX-License-Identifier: Apache-2.0
"""
Friction of the seals: it holds, lets go, never chatters, and sticks and slips as it must.

Stick-slip: a mass m that a spring k draws along at speed V, breakaway force F_s, Coulomb force F_c
(Stribeck's speed so low that nothing lies between). With w^2 = k/m, D = F_s - F_c, the stretch
of the spring swings about F_c/k while the mass slides, from F_s/k to (F_c - D)/k:

    slides for (2 pi - 2 atan(D w/(k V)))/w, rests for 2 D/(k V), v_max = V + sqrt(V^2 + (D w/k)^2)
"""

import math

from hydra_actuator.actuator import Actuator, SolverError
from hydra_actuator.assembly import LOAD_FORCE
from hydra_actuator.core.model import Domain, Junction, Mesh
from hydra_actuator.core.records import PISTON, PISTON_PARAMETERS, PRESSURE
from hydra_actuator.parameters import Parameters
from hydra_actuator.verification.case import Case, Row
from hydra_actuator.verification.chains import LoneChain, WAVE_SPEED
import numpy as np

STATIC, COULOMB = 800.0, 500.0
SHUT = {'valve.overlap_pa': 1e-6, 'valve.overlap_pb': 1e-6, 'valve.overlap_at': 1e-6,
        'valve.overlap_bt': 1e-6}
SEALS = {**SHUT, 'cylinder.static_friction': STATIC, 'cylinder.coulomb_friction': COULOMB,
         'cylinder.stiffness': 0.0}
# Bore of what oil there must be around a piston that is to move as if there were none: its
# waves bear rho c A = 1e-6 N s/m.
NO_BORE = 1e-12
CALM = 100.0            # 1/m, a loss that ends the waves of each jolt
DRAWN = {'mass': 10.0, 'stiffness': 1e5, 'drive': 0.05}
DRAWN_STEP = 1e-5


def lone_piston(step_time: float, travel: float, **fields) -> LoneChain:
    """
    Return a piston between chambers of almost no bore; input 0 is their pressure, 1 the load.

    fields: of PISTON_PARAMETERS; travel [m] to either side. The piston starts in the middle.
    """
    length = travel + 3.0 * WAVE_SPEED * step_time
    piston = np.zeros(1, PISTON_PARAMETERS)
    piston['length_1'] = piston['length_2'] = length
    piston['limit'], piston['stribeck_velocity'] = travel, 1e-6
    for name, value in fields.items():
        piston[name] = value
    chambers = [
        Domain(f'chamber_{k + 1}', length, NO_BORE, WAVE_SPEED, CALM, longest=length + travel,
               origin=2.0 * k * length, direction=1.0 - 2.0 * k) for k in range(2)]
    return LoneChain(
        chambers, [Junction(PRESSURE, (0,), 0), Junction(PRESSURE, (2,), 0),
                   Junction(PISTON, (1, 3), 1)],
        Mesh(step_time), piston=piston)


def held_for_a_second() -> tuple[float, float]:
    """Return (way [m], largest speed [m/s]) of a piston loaded to just below the breakaway."""
    actuator = Actuator(Parameters().replace({**SEALS, 'initial.position': 0.0123}))
    fastest = 0.0
    for _ in range(1000):
        code = actuator.tick_once(0.0, 0.0, 0.999 * STATIC)
        if code:
            raise SolverError(actuator.status_message(code))
        fastest = max(fastest, abs(actuator.row[actuator.channels.VELOCITY]))
    return abs(float(actuator.row[actuator.channels.POSITION]) - 0.0123), float(fastest)


def breakaway_load(first: float, rise: float) -> float:
    """Return the load [N] at the first motion; it starts at `first` [N], `rise` [N] a step."""
    actuator = Actuator(Parameters().replace(SEALS))
    for k in range(2 * round(abs((STATIC - abs(first)) / rise))):
        load = first + k * rise
        actuator.advance(actuator.step_time, load_force=load)
        if actuator.row[actuator.channels.VELOCITY] != 0.0:
            return load
    return math.nan


def reversals(trace: np.ndarray) -> int:
    """Count the changes of sign of a speed, standstill left out."""
    signs = np.sign(trace[trace != 0.0])
    return int(np.count_nonzero(signs[1:] != signs[:-1]))


def swung_by_a_load(periods: int, frequency: float = 5.0) -> np.ndarray:
    """Return the speed [m/s] at every step under a sine of load, 1.5 times the breakaway."""
    parameters = Parameters().replace({**SEALS, 'cylinder.static_friction': COULOMB})
    actuator = Actuator(parameters)
    steps = round(periods / frequency / actuator.step_time)
    times = np.linspace(0.0, periods / frequency, 200 * periods + 1)
    loads = np.zeros((len(times), LOAD_FORCE + 1))
    loads[:, LOAD_FORCE] = 1.5 * COULOMB * np.sin(2.0 * math.pi * frequency * times)
    trace = np.empty(steps)
    for k in range(steps):
        actuator.follow((times, loads, False), 1)
        trace[k] = actuator.row[actuator.channels.VELOCITY]
    return trace


def drawn_by_a_spring(cycles: int, step_time: float) -> tuple[np.ndarray, float]:
    """Return the starts and ends of slides [s] (cycles, 2), and the largest speed [m/s]."""
    drive = DRAWN['drive']
    chain = lone_piston(step_time, 0.3, mass=DRAWN['mass'], stiffness=DRAWN['stiffness'],
                        coulomb=COULOMB, breakaway=STATIC)
    edges, fastest, slides, time = [], 0.0, False, 0.0
    while len(edges) < 2 * cycles:
        time += step_time
        chain.step(0.0, -DRAWN['stiffness'] * drive * time)
        speed = float(chain.state.piston[0]['velocity'])
        if (speed != 0.0) != slides:
            edges.append(time)
            slides = not slides
        fastest = max(fastest, speed)
    return np.reshape(edges, (cycles, 2)), fastest


def seal_hold() -> list[Row]:
    """Hold just below the breakaway force, let go just above it, from either side."""
    name, (way, speed) = 'seal_hold', held_for_a_second()
    rows = [
        Row(name, 'creep in 1 s, at 99.9 % of the breakaway force', 'm', 0.0, way, 0.0, False,
            'friction is set-valued: rest is v = 0, not nearly'),
        Row(name, 'largest speed meanwhile', 'm/s', 0.0, speed, 0.0, False, 'as the creep')]
    rise = 0.01
    for sign, word in ((1.0, 'against'), (-1.0, 'along')):
        got = breakaway_load(sign * (STATIC - 0.505), sign * rise)
        rows.append(Row(
            name, f'load at the first motion, {word} the axis', 'N', sign * STATIC, got,
            2.0 * rise, False, 'two steps: the balance takes the mean of old and new load'))
    trace = swung_by_a_load(4)
    rows.append(Row(
        name, 'reversals in 4 periods of load', '-', 7.0, float(reversals(trace)), 0.0, False,
        'one at each turn of the load, and no chatter between'))
    return rows


def stick_slip() -> list[Row]:
    """Compare ten cycles with the exact one."""
    name, cycles = 'stick_slip', 10
    edges, fastest = drawn_by_a_spring(cycles, DRAWN_STEP)
    drive, stiffness = DRAWN['drive'], DRAWN['stiffness']
    omega = math.sqrt(stiffness / DRAWN['mass'])
    fall = STATIC - COULOMB
    slides = (2.0 * math.pi - 2.0 * math.atan(fall * omega / (stiffness * drive))) / omega
    rests = 2.0 * fall / (stiffness * drive)
    got_slides = float(np.mean(edges[:, 1] - edges[:, 0]))
    period = float(edges[-1, 0] - edges[0, 0]) / (cycles - 1)
    late = 3.0 * DRAWN_STEP
    reason = 'three steps: both ends of a slide are seen late, its force is the mean of two'
    return [
        Row(name, 'time of a slide', 's', slides, got_slides, late, False, reason),
        Row(name, 'time of a rest', 's', rests, period - got_slides, late, False, reason),
        Row(name, 'period', 's', slides + rests, period, late, False, reason),
        Row(name, 'largest speed', 'm/s', drive + math.hypot(drive, fall * omega / stiffness),
            fastest, 2e-4, True, 'a step late the spring pulls k V dt = 0.05 N of 300 N more'),
    ]


CASES = {
    'seal_hold': Case(seal_hold, 'seals hold and let go'),
    'stick_slip': Case(stick_slip, 'a mass drawn along by a spring sticks and slips'),
}
