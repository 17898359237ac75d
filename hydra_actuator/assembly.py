# SPDX-License-Identifier: Apache-2.0
"""
From parameters to the chain of the actuator: six domains, seven junctions, twelve stations.

    O ---- supply_line ---- A | B - line_1 - C | D - chamber_1 - E ]piston[ F - chamber_2 - G | ...

The second chamber is seen from G towards the piston, so its direction is -1.
"""

import math

from hydra_actuator.channels import STATIONS
from hydra_actuator.core.model import build_chain, Domain, Junction, Mesh, step_time_within
from hydra_actuator.core.observe import SECTION
from hydra_actuator.core.oil import Oil
from hydra_actuator.core.port import port_coefficient
from hydra_actuator.core.records import (
    Model,
    ORIFICE,
    PISTON,
    PISTON_PARAMETERS,
    PRESSURE,
    PUMP,
    SOURCE_PARAMETERS,
    State,
    VALVE,
    VALVE_PARAMETERS,
)
from hydra_actuator.parameters import ParameterError, Parameters
import numpy as np

DOMAINS = ('supply_line', 'line_1', 'chamber_1', 'chamber_2', 'line_2', 'return_line')
SPOOL_1, SPOOL_2, LOAD_FORCE, TANK_PRESSURE = range(4)
INPUTS = 4
LINES = ('line', 'line_1', 'line_2')
EDGES = ('pa', 'pb', 'at', 'bt')

# Ends of the chain in the order of the stations: F is the face, G the fixed end of chamber_2.
END_OF_STATION = dict(zip(STATIONS, (0, 1, 2, 3, 4, 5, 7, 6, 8, 9, 10, 11)))


def wave_speed(parameters: Parameters, domain: str = '') -> float:
    """
    Return the wave speed [m/s] at gauge zero in a domain, in the oil alone by default.

    c^2 = chi / rho0 / (1 + chi D / (E e)) with the elasticity of a thin wall (Korteweg); the
    walls of chambers are rigid.
    """
    p = parameters
    softness = 1.0
    if domain.endswith(LINES) and p[f'{domain}.youngs_modulus'] > 0.0:
        softness += (p['fluid.bulk_modulus'] * p[f'{domain}.diameter']
                     / (p[f'{domain}.youngs_modulus'] * p[f'{domain}.wall_thickness']))
    return math.sqrt(p['fluid.bulk_modulus'] / p['fluid.density'] / softness)


def oil(parameters: Parameters) -> Oil:
    """Return the oil of all domains, with gas only if cavitation is modelled."""
    p = parameters
    return Oil(p['fluid.density'], p['fluid.kinematic_viscosity'],
               p['fluid.air_fraction'] if p['fluid.cavitation'] else 0.0,
               p['ambient_pressure'] - p['fluid.vapour_pressure'])


def cylinder_length(parameters: Parameters) -> float:
    """Return the distance [m] between the fixed ends D and G."""
    return (parameters['cylinder.dead_length_1'] + parameters['cylinder.stroke']
            + parameters['cylinder.dead_length_2'])


def domain_lengths(parameters: Parameters) -> tuple[float, ...]:
    """Return the six lengths [m] at the initial position."""
    half = 0.5 * parameters['cylinder.stroke']
    position = parameters['initial.position']
    return (
        parameters['supply_line.length'], parameters['line_1.length'],
        parameters['cylinder.dead_length_1'] + half + position,
        parameters['cylinder.dead_length_2'] + half - position,
        parameters['line_2.length'], parameters['return_line.length'])


def origins(parameters: Parameters) -> tuple[float, ...]:
    """Return the streamline coordinate [m] of node 0 of the six domains; the pump is 0."""
    supply, line_1, _, _, line_2, _ = domain_lengths(parameters)
    port_d = supply + line_1
    port_g = port_d + cylinder_length(parameters)
    return 0.0, supply, port_d, port_g, port_g, port_g + line_2


def choose_mesh(parameters: Parameters) -> Mesh:
    """Return the mesh: the period is a whole number of steps."""
    mach = parameters['solver.max_mach']
    step_time = step_time_within(
        parameters['timing.period'], sum(domain_lengths(parameters)),
        parameters['solver.cells'], wave_speed(parameters), mach)
    return Mesh(step_time, mach, parameters['solver.iterations'],
                parameters['solver.interpolation'])


def assemble(parameters: Parameters) -> tuple[Model, State]:
    """
    Return model and initial state of the actuator.

    Raises ParameterError where a line is shorter than one cell.
    """
    p, mesh = parameters, choose_mesh(parameters)
    lengths, starts = domain_lengths(p), origins(p)
    areas = [_line_area(p, name) if name.endswith(LINES) else
             p[f'cylinder.area_{name[-1]}'] for name in DOMAINS]
    longest = p['cylinder.stroke'] + np.array(
        [p['cylinder.dead_length_1'], p['cylinder.dead_length_2']])
    pressures = (p['supply.pressure'], p['initial.pressure_1'], p['initial.pressure_1'],
                 p['initial.pressure_2'], p['initial.pressure_2'], p['tank.pressure'])
    domains = [
        Domain(name, lengths[d], areas[d], wave_speed(p, name), _loss(p, name), pressures[d],
               origin=starts[d], longest=longest[d - 2] if d in (2, 3) else 0.0,
               direction=-1.0 if d == 3 else 1.0, **_wall(p, name))
        for d, name in enumerate(DOMAINS)]
    try:
        model, state = build_chain(
            oil(p), domains, _junctions(p, areas), mesh,
            valve=_valve(p, mesh.step_time), piston=_piston(p), source=_source(p))
    except ValueError as error:
        raise ParameterError(f'{error}; lengthen it or raise solver.cells') from None
    _set_piston(p, state)
    return model, state


def sections(parameters: Parameters) -> np.ndarray:
    """
    Return the records of the chosen sections, in order.

    Raises ParameterError for a position off the streamline.
    """
    names = parameters['sections.names']
    records = np.zeros(len(names), SECTION)
    own = iter(parameters['sections.positions'])
    starts = origins(parameters)
    total = starts[5] + parameters['return_line.length']
    for record, name in zip(records, names):
        record['end'] = END_OF_STATION.get(name, -1)
        if record['end'] < 0:
            position = next(own)
            if not 0.0 <= position <= total:
                raise ParameterError(
                    f'sections.positions: {position:g} m of {name!r} is off the streamline, '
                    f'0 to {total:g} m')
            inside = starts[2] <= position <= starts[3]
            record['position'], record['cylinder'] = position, int(inside)
            lines = [d for d in (0, 1, 4, 5) if starts[d] <= position]
            record['domain'] = 2 if inside else lines[-1]
    return records


def section_positions(parameters: Parameters, records: np.ndarray) -> list[float]:
    """Return the streamline coordinate [m] of sections; the piston's faces at mid-stroke."""
    starts = origins(parameters)
    middle = starts[2] + (parameters['cylinder.dead_length_1']
                          + 0.5 * parameters['cylinder.stroke'])
    total = starts[5] + parameters['return_line.length']
    of_end = (starts[0], starts[1], starts[1], starts[2], starts[2], middle, starts[3], middle,
              starts[4], starts[5], starts[5], total)
    return [of_end[record['end']] if record['end'] >= 0 else float(record['position'])
            for record in records]


def _line_area(p: Parameters, name: str) -> float:
    return 0.25 * math.pi * p[f'{name}.diameter'] ** 2


def _loss(p: Parameters, name: str) -> float:
    if name.startswith('chamber') or p[f'{name}.friction'] == 'none':
        return 0.0
    return p[f'{name}.loss_coefficient']


def _wall(p: Parameters, name: str) -> dict:
    if name.startswith('chamber'):
        return {'friction': 'none'}
    return {'friction': p[f'{name}.friction'], 'roughness': p[f'{name}.roughness']}


def _orifice_gain(p: Parameters) -> float:
    return math.sqrt(2.0 / p['fluid.density'])


def _junctions(p: Parameters, areas: list[float]) -> list[Junction]:
    ports = [port_coefficient(p[f'cylinder.port_loss_{k}'], areas[line], areas[chamber])
             * _orifice_gain(p) for k, line, chamber in ((1, 1, 2), (2, 4, 3))]
    return [
        Junction(PUMP, (0,)),
        Junction(VALVE, (1, 2, 9, 10), SPOOL_1),
        Junction(ORIFICE, (3, 4), coefficient=ports[0]),
        Junction(PISTON, (5, 7), LOAD_FORCE),
        Junction(ORIFICE, (6, 8), coefficient=ports[1]),
        Junction(PRESSURE, (11,), TANK_PRESSURE)]


def _valve(p: Parameters, step_time: float) -> np.ndarray:
    valve = np.zeros(1, VALVE_PARAMETERS)
    full = p['valve.discharge_coefficient'] * p['valve.area_gradient'] * _orifice_gain(p)
    valve['flow_gain'] = [[p[f'valve.gain_{edge}'] * full for edge in EDGES]]
    valve['overlap'] = [[p[f'valve.overlap_{edge}'] for edge in EDGES]]
    valve['leakage'], valve['stroke'] = p['valve.leakage'], p['valve.stroke']
    valve['slew_rate'], valve['step_time'] = p['valve.slew_rate'], step_time
    valve['natural_frequency'] = p['valve.natural_frequency']
    valve['transition'] = [spool_transition(
        p['valve.natural_frequency'], p['valve.damping_ratio'], step_time).ravel()]
    return valve


def spool_transition(natural_frequency: float, damping_ratio: float,
                     step_time: float) -> np.ndarray:
    """
    Return the 2 x 2 transition matrix of (deviation, velocity) over one step.

    x'' + 2 zeta omega x' + omega^2 x = 0, omega = 2 pi f [Hz]; scaling and squaring of the series.
    """
    omega = 2.0 * math.pi * natural_frequency
    generator = step_time * np.array(
        [[0.0, 1.0], [-omega ** 2, -2.0 * damping_ratio * omega]])
    scale = np.diag([1.0, max(omega, 1e-300)])
    generator = np.linalg.solve(scale, generator @ scale) if omega > 0.0 else generator
    halvings = max(0, math.ceil(math.log2(max(np.abs(generator).sum(), 1e-12))) + 1)
    small = generator / 2 ** halvings
    result, term = np.eye(2), np.eye(2)
    for k in range(1, 20):
        term = term @ small / k
        result = result + term
    for _ in range(halvings):
        result = result @ result
    return scale @ result @ np.linalg.inv(scale) if omega > 0.0 else result


def _piston(p: Parameters) -> np.ndarray:
    piston = np.zeros(1, PISTON_PARAMETERS)
    half = 0.5 * p['cylinder.stroke']
    for field, name in (
            ('mass', 'mass'), ('stiffness', 'stiffness'), ('viscous', 'viscous_friction'),
            ('coulomb', 'coulomb_friction'), ('breakaway', 'static_friction'),
            ('stribeck_velocity', 'stribeck_velocity'), ('leakage', 'leakage'),
            ('restitution', 'stop_restitution')):
        piston[field] = p[f'cylinder.{name}']
    piston['limit'] = half
    piston['length_1'] = p['cylinder.dead_length_1'] + half
    piston['length_2'] = p['cylinder.dead_length_2'] + half
    return piston


def _source(p: Parameters) -> np.ndarray:
    source = np.zeros(1, SOURCE_PARAMETERS)
    source['max_flow'] = p['supply.max_flow']
    source['accumulator_volume'] = p['supply.accumulator_volume']
    source['precharge'] = p['supply.accumulator_precharge']
    source['ambient'] = p['ambient_pressure']
    speed = wave_speed(p, 'supply_line')
    set_supply_pressure(source, p['supply.pressure'], speed, p['fluid.density'] * speed ** 2)
    return source


def set_supply_pressure(source: np.ndarray, pressure: float, speed: float,
                        bulk_modulus: float) -> None:
    """Set the relief pressure [Pa, gauge]; speed [m/s], bulk modulus [Pa] of the pump's line."""
    source['pressure'] = pressure
    source['relative_density'] = 1.0 + pressure / bulk_modulus
    source['mu'] = speed * math.log1p(pressure / bulk_modulus)


def _set_piston(p: Parameters, state: State) -> None:
    piston = state.piston[0]
    piston['position'] = piston['new_position'] = p['initial.position']
    piston['force'] = (
        p['cylinder.area_1'] * p['initial.pressure_1']
        - p['cylinder.area_2'] * p['initial.pressure_2']
        - p['cylinder.stiffness'] * p['initial.position'])
    source_ratio = ((p['supply.accumulator_precharge'] + p['ambient_pressure'])
                    / (p['supply.pressure'] + p['ambient_pressure']))
    state.oil_stored[:] = p['supply.accumulator_volume'] * max(
        0.0, 1.0 - source_ratio ** (1.0 / 1.4))
