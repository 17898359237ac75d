# SPDX-License-Identifier: Apache-2.0
"""
From parameters to the chain of the actuator: six domains, seven junctions, twelve stations.

    O ---- supply_line ---- A | B - line_1 - C | D - chamber_1 - E ]piston[ F - chamber_2 - G | ...

The second chamber is seen from G towards the piston, so its direction is -1.
"""

import math

from hydra_actuator.channels import DOMAINS
from hydra_actuator.core.model import build_chain, Domain, Junction, Mesh
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
from hydra_actuator.core.source import stored_oil
from hydra_actuator.core.valve import spool_transition
from hydra_actuator.geometry import domain_lengths, LINES, origins, wave_speed
from hydra_actuator.parameters import ParameterError, Parameters
from hydra_actuator.parameters.streamline import step_time
import numpy as np

SPOOL_1, SPOOL_2, LOAD_FORCE, TANK_PRESSURE = range(4)
INPUTS = 4
EDGES = ('pa', 'pb', 'at', 'bt')


def oil(parameters: Parameters) -> Oil:
    """Return the oil of all domains, with gas only if cavitation is modelled."""
    p = parameters
    return Oil(p['fluid.density'], p['fluid.kinematic_viscosity'],
               p['fluid.air_fraction'] if p['fluid.cavitation'] else 0.0,
               p['ambient_pressure'] - p['fluid.vapour_pressure'])


def choose_mesh(parameters: Parameters) -> Mesh:
    """Return the mesh: the period is a whole number of steps."""
    return Mesh(step_time(parameters), parameters['solver.max_mach'],
                parameters['solver.iterations'], parameters['solver.interpolation'])


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
    _set_state(p, model.source, state)
    return model, state


def all_inputs(schedule: tuple[np.ndarray, np.ndarray, bool], time: float,
               tank_pressure: float) -> tuple[np.ndarray, np.ndarray, bool]:
    """Return a schedule of commands (T, 3) with the tank's pressure [Pa], from a time [s] on."""
    times, commands, hold = schedule
    first = 0
    if len(times) and times[0] <= time:
        first = int(np.searchsorted(times, time, side='right')) - 1
    table = np.empty((len(times) - first, INPUTS))
    table[:, :TANK_PRESSURE] = commands[first:]
    table[:, TANK_PRESSURE] = tank_pressure
    return np.ascontiguousarray(times[first:], float), table, bool(hold)


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


def _set_state(p: Parameters, source: np.ndarray, state: State) -> None:
    piston = state.piston[0]
    piston['position'] = piston['new_position'] = p['initial.position']
    piston['force'] = (
        p['cylinder.area_1'] * p['initial.pressure_1']
        - p['cylinder.area_2'] * p['initial.pressure_2']
        - p['cylinder.stiffness'] * p['initial.position'])
    state.oil_stored[:] = stored_oil.py_func(
        p['supply.pressure'], source.view(np.recarray)[0])
