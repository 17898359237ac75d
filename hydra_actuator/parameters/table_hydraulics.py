# SPDX-License-Identifier: Apache-2.0
"""
The oil, its source, its tank and its lines.

Pressures are gauge [Pa] unless their meaning says absolute. The defaults are the paper's
reference case with the dimensions chosen for it, tank at 2.5 MPa. Ranges are wide enough for any
hydraulic plant and narrow enough to catch a wrong unit (a bulk modulus in MPa, a length in mm).
"""

from hydra_actuator.parameters.definition import boolean, double, group, string

FRICTION_LAWS = ('none', 'constant', 'steady', 'unsteady')
LINES = ('supply_line', 'line_1', 'line_2', 'return_line')

FLUID = group(
    'fluid',
    double('density', 860.0, 'kg/m^3', (100.0, 20000.0), 'density at gauge pressure 0'),
    double('bulk_modulus', 1.4534e9, 'Pa', (1e6, 1e11), 'isothermal, at gauge pressure 0'),
    double('kinematic_viscosity', 4.6e-5, 'm^2/s', (1e-8, 0.1),
           'of the oil; used by steady and unsteady friction'),
    boolean('cavitation', False, 'model free gas and vapour at every node and end'),
    double('vapour_pressure', 10.0, 'Pa', (0.0, 1e7), 'absolute'),
    double('air_fraction', 1e-4, '1', (1e-7, 0.2),
           'free gas by volume at ambient pressure, with cavitation'),
)

AMBIENT = (
    double('ambient_pressure', 101325.0, 'Pa', (0.0, 1.2e8),
           'absolute; added to every gauge pressure that is published'),
)

SUPPLY = group(
    'supply',
    double('max_flow', 2e-3, 'm^3/s', (0.0, 10.0),
           'largest flow of the pump, at reference density; 0: unlimited'),
    double('accumulator_volume', 0.0, 'm^3', (0.0, 100.0), 'of the gas, precharged; 0: none'),
    double('accumulator_precharge', 1.4e7, 'Pa', (0.0, 4e8), 'gas pressure without oil'),
)

SUPPLY_PRESSURE = group(
    'supply',
    double('pressure', 2.1e7, 'Pa', (0.0, 4e8), 'at the pump, held by the relief valve'),
    live=True,
)

TANK = group(
    'tank',
    double('pressure', 2.5e6, 'Pa', (0.0, 1e8), 'at the end of the return line'),
)


def _line(name: str, length: float, place: str) -> tuple:
    """Define one line: a straight round tube of constant section."""
    return group(
        name,
        double('length', length, 'm', (1e-3, 1e4), f'of the line {place}'),
        double('diameter', 0.016, 'm', (1e-4, 10.0), 'inner'),
        string('friction', 'constant', 'law of wall friction', FRICTION_LAWS),
        double('loss_coefficient', 1.9, '1/m', (0.0, 1e5),
               'Darcy factor over diameter, with constant friction'),
        double('roughness', 1.5e-6, 'm', (0.0, 0.1), 'of the wall, with steady friction'),
        double('wall_thickness', 0.002, 'm', (1e-6, 1.0), 'with an elastic wall'),
        double('youngs_modulus', 0.0, 'Pa', (0.0, 1e13), 'of the wall; 0: rigid'),
    )


LINE_DEFINITIONS = (
    *_line('supply_line', 0.6, 'from pump to valve, O to A'),
    *_line('line_1', 0.2, 'from valve to chamber 1, B to C'),
    *_line('line_2', 0.2, 'from chamber 2 to valve, H to I'),
    *_line('return_line', 0.6, 'from valve to tank, J to K'),
)

HYDRAULICS = (*FLUID, *AMBIENT, *SUPPLY_PRESSURE, *SUPPLY, *TANK, *LINE_DEFINITIONS)
