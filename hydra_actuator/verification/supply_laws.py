# SPDX-License-Identifier: Apache-2.0
r"""
Pump, relief valve, accumulator and elastic wall, each beside its formula.

    pump ]---- line ----)( orifice, K'      q = K' sqrt(p), so p = (max_flow/K')^2 when that is
                                            below the relief pressure, else the relief pressure

Accumulator: gas at absolute p, p V^1.4 constant. As a spring on the oil of a line whose other
end is held, omega C Z tan(omega L/c) = 1 with C = V/(1.4 p) at the mean pressure; its oil is
counted at reference density, and so is Z = rho0 c/A.
Elastic wall (Korteweg): c^2 = chi/rho0/(1 + chi D/(E e)).
"""

import math

from hydra_actuator.actuator import Actuator
from hydra_actuator.core.model import Domain, Junction
from hydra_actuator.core.records import FLOW, ORIFICE, PRESSURE, PUMP, SOURCE_PARAMETERS
from hydra_actuator.parameters import Parameters
from hydra_actuator.verification.case import Case, Row
from hydra_actuator.verification.chains import (
    BULK_MODULUS,
    DENSITY,
    LoneChain,
    mesh_of,
    riemann_variable,
    WAVE_SPEED,
)
from hydra_actuator.verification.harmonics import fit_oscillation
from hydra_actuator.verification.spool_response import soft_step
import numpy as np

LENGTH, AREA, CELLS = 2.0, 1e-3, 100
AMBIENT = 101325.0
RELIEF, MOST_FLOW = 21e6, 1e-3
VOLUME, PRECHARGE = 5e-4, 8e6
EXPONENT = 1.4
SMALL = 10.0            # Pa


def source(**fields: float) -> np.ndarray:
    """Return the record of a pump; fields: of SOURCE_PARAMETERS."""
    record = np.zeros(1, SOURCE_PARAMETERS)
    record['pressure'], record['max_flow'], record['ambient'] = RELIEF, MOST_FLOW, AMBIENT
    record['mu'] = riemann_variable(RELIEF)
    record['relative_density'] = 1.0 + RELIEF / BULK_MODULUS
    for name, value in fields.items():
        record[name] = value
    return record


def fed_line(end: Junction, pressure: float, velocity: float = 0.0, loss: float = 0.0,
             **fields: float) -> LoneChain:
    """Return a line from a pump to some end; fields: of the pump."""
    return LoneChain(
        [Domain('line', LENGTH, AREA, WAVE_SPEED, loss, pressure, velocity)],
        [Junction(PUMP, (0,)), end], mesh_of(LENGTH, CELLS), source=source(**fields))


def flow_at(chain: LoneChain, end: int) -> float:
    """Return the flow [m^3/s] at reference density out of the line at an end."""
    ratio = 1.0 + chain.end_pressure(end) / BULK_MODULUS
    return ratio * AREA * chain.end_velocity(end)


def through_an_orifice(coefficient: float) -> tuple[float, float]:
    """Return (pressure [Pa], flow [m^3/s]) at a pump that feeds an orifice K' into a tank."""
    chain = LoneChain(
        # in lines of equal length a swing would ring on that the orifice never feels
        [Domain('line_1', LENGTH, AREA, WAVE_SPEED), Domain('line_2', 0.7, AREA, WAVE_SPEED)],
        [Junction(PUMP, (0,)), Junction(ORIFICE, (1, 2), coefficient=coefficient),
         Junction(PRESSURE, (3,), 0)], mesh_of(LENGTH, CELLS), source=source())
    chain.advance(400_000)
    return chain.end_pressure(0), -flow_at(chain, 0)


def pump() -> list[Row]:
    """Ask a pump for less and for more than it can give, and push oil back into it."""
    name, rows, reason = 'pump', [], 'steady flow is exact; waves have died in the orifice'
    for words, share in (('less', 0.5), ('more', 1.5)):
        coefficient = share * MOST_FLOW / math.sqrt(RELIEF)
        pressure, flow = through_an_orifice(coefficient)
        rows += [
            Row(name, f'flow, {words} asked than it can give', 'm^3/s',
                min(share, 1.0) * MOST_FLOW, flow, 1e-6, True, reason),
            Row(name, f'pressure, {words} asked than it can give', 'Pa',
                RELIEF / max(share, 1.0) ** 2, pressure, 1e-6, True, reason)]
    chain = fed_line(Junction(FLOW, (1,), 0), RELIEF, loss=50.0)
    chain.hold(-MOST_FLOW)
    chain.advance(60_000)
    return [
        *rows,
        Row(name, 'flow pushed back', 'm^3/s', -MOST_FLOW, -flow_at(chain, 0), 1e-6, True,
            'what the line does not store'),
        Row(name, 'pressure while the relief valve takes it', 'Pa', RELIEF, chain.end_pressure(0),
            1e-10, True, 'an ideal valve: what a boundary must hold to')]


def gas_volume(pressure: float) -> float:
    """Return the volume [m^3] of the accumulator's gas at a gauge pressure [Pa]."""
    return VOLUME * ((PRECHARGE + AMBIENT) / (pressure + AMBIENT)) ** (1.0 / EXPONENT)


def accumulator_chain(end: Junction, pressure: float, max_flow: float) -> LoneChain:
    """Return a line from an accumulator, all of it at a pressure [Pa], to some end."""
    chain = fed_line(end, pressure, max_flow=max_flow, accumulator_volume=VOLUME,
                     precharge=PRECHARGE)
    chain.state.oil_stored[:] = VOLUME - gas_volume(pressure)
    return chain


def gas_law() -> list[Row]:
    """Empty an accumulator by a flow that the pump cannot give, then let the pump fill it."""
    name, chain = 'accumulator', accumulator_chain(Junction(FLOW, (1,), 0), RELIEF, MOST_FLOW)
    gas = first = gas_volume(RELIEF)
    constant = (RELIEF + AMBIENT) * gas ** EXPONENT
    flow, worst, least = 0.0, 0.0, RELIEF
    phases = ((0.05, 3.0 * MOST_FLOW), (0.04, 0.0))
    largest = first
    for duration, demand in phases:
        chain.hold(demand)
        for _ in range(round(duration / chain.model.step_time)):
            chain.advance()
            before, flow = flow, -flow_at(chain, 0)
            # the relief valve takes what would press the gas together beyond its start
            gas = max(first, gas + chain.model.step_time * (0.5 * (before + flow) - MOST_FLOW))
            pressure = chain.end_pressure(0)
            largest, least = max(largest, gas), min(least, pressure)
            worst = max(worst, abs((pressure + AMBIENT) * gas ** EXPONENT / constant - 1.0))
    return [
        Row(name, 'p V^1.4 over its start less 1, worst step', '-', 0.0, worst, 6e-4, False,
            'half a step of a jump of 3e-3 m^3/s is 1.3e-4 of it, of first order; three jumps'),
        Row(name, 'lowest pressure', 'Pa',
            (RELIEF + AMBIENT) * (first / largest) ** EXPONENT - AMBIENT, least, 2e-4, True,
            'as the law'),
    ]


def gas_spring() -> list[Row]:
    """Let the gas swing on the oil of the line, a little, about 12 MPa."""
    name, mean = 'accumulator', 12e6
    chain = accumulator_chain(Junction(PRESSURE, (1,), 0), mean, 1e-12)
    product = gas_volume(mean) / (EXPONENT * (mean + AMBIENT)) * DENSITY * WAVE_SPEED / AREA
    low, high = 0.0, 0.5 * math.pi * WAVE_SPEED / LENGTH
    for _ in range(200):
        omega = 0.5 * (low + high)
        if omega * product * math.tan(omega * LENGTH / WAVE_SPEED) < 1.0:
            low = omega
        else:
            high = omega
    step_time = chain.model.step_time
    rise = round(math.pi / omega / step_time)
    times = np.linspace(0.0, rise * step_time, 201)
    chain.follow(times, (mean + SMALL * soft_step(times / times[-1]))[:, None], rise)
    chain.hold(mean + SMALL)
    trace = np.empty((400, 2))
    for row in trace:
        chain.advance(round(0.05 * math.pi / omega / step_time))
        row[:] = chain.time, chain.end_pressure(0) - mean
    got, _ = fit_oscillation(trace[:, 0] - trace[0, 0], trace[:, 1], omega)
    return [
        Row(name, 'frequency on the oil of a line', 'rad/s', omega, got, 1e-5, True,
            'an implicit step damps by omega dt/2 = 1e-3 and shifts by the square of it'),
    ]


def accumulator() -> list[Row]:
    """Hold the gas against its law, large and small."""
    return [*gas_law(), *gas_spring()]


def elastic_wall() -> list[Row]:
    """Time a front between two sections of an elastic supply line, and weigh it."""
    name, places = 'elastic_wall', (3.0, 7.0)
    parameters = Parameters().replace({
        'supply_line.length': 10.0, 'supply_line.youngs_modulus': 2e9,
        'supply_line.wall_thickness': 1e-3, 'supply_line.friction': 'none',
        'supply.max_flow': 0.0, 'sections.names': ('far', 'near'), 'sections.positions': places})
    chi, rho = parameters['fluid.bulk_modulus'], parameters['fluid.density']
    softness = 1.0 + chi * parameters['supply_line.diameter'] / (2e9 * 1e-3)
    speed = math.sqrt(chi / rho / softness)
    actuator = Actuator(parameters)
    rest = actuator.row[actuator.channels.pressure].copy()
    rows = []
    while actuator.time < 9.0 / speed:
        actuator.advance(actuator.step_time, spool=0.05)
        rows.append((actuator.time, *(rest - actuator.row[actuator.channels.pressure]),
                     actuator.row[actuator.channels.flow_velocity][1]))
    time, far, near, velocity = np.array(rows).T
    passed = int(np.searchsorted(time, 6.0 / speed))
    drop = near[passed]
    arrivals = [float(np.interp(0.5 * drop, trace, time)) for trace in (far, near)]
    ratio = 1.0 + parameters['supply.pressure'] / (chi / softness)
    return [
        Row(name, 'speed of a front over 4 m', 'm/s', speed,
            (places[1] - places[0]) / (arrivals[0] - arrivals[1]), 2e-3, True,
            'the oil behind it moves at 1e-3 of it'),
        Row(name, 'its fall of pressure', 'Pa', rho * ratio * speed * float(velocity[passed]),
            float(drop), 2e-3, True, 'linear: half of u/c'),
    ]


CASES = {
    'pump': Case(pump, 'pump at its limit and relief valve'),
    'accumulator': Case(accumulator, 'an accumulator empties, fills and swings'),
    'elastic_wall': Case(elastic_wall, 'a front in an elastic line'),
}
