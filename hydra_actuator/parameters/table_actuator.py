# SPDX-License-Identifier: Apache-2.0
"""
Servo-valve, cylinder, the state at the start, and how finely all of it is solved.

The defaults are the paper's reference case with the dimensions chosen for it.
"""

from hydra_actuator.parameters.definition import boolean, double, group, integer, string

EDGES = ('pa', 'pb', 'at', 'bt')
EDGE_NAMES = {
    'pa': 'pressure to port A', 'pb': 'pressure to port B',
    'at': 'port A to tank', 'bt': 'port B to tank',
}

VALVE = group(
    'valve',
    integer('spools', 1, (1, 2), '1: one spool moves all edges; 2: independent metering'),
    double('discharge_coefficient', 0.62, '1', (0.01, 1.0), 'of every edge'),
    double('area_gradient', 0.03, 'm', (1e-6, 10.0), 'opened area per spool travel'),
    double('stroke', 5e-4, 'm', (1e-6, 0.5), 'largest spool displacement to either side'),
    *(
        double(f'overlap_{edge}', 0.0, 'm', (-0.5, 0.5),
               f'dead travel of the edge {EDGE_NAMES[edge]}; negative: underlap')
        for edge in EDGES
    ),
    *(
        double(f'gain_{edge}', 1.0, '1', (0.0, 100.0),
               f'factor on the area of the edge {EDGE_NAMES[edge]}; 0: blocked')
        for edge in EDGES
    ),
    double('leakage', 0.0, 'm^3/(s Pa)', (0.0, 1e-6), 'laminar conductance beside each edge'),
    double('natural_frequency', 0.0, 'Hz', (0.0, 1e5), 'of the spool; 0: ideal, no dynamics'),
    double('damping_ratio', 0.7, '1', (0.0, 100.0), 'of the spool'),
    double('slew_rate', 0.0, 'm/s', (0.0, 1e4), 'largest spool speed; 0: unlimited'),
)

CYLINDER = group(
    'cylinder',
    double('area_1', 1e-3, 'm^2', (1e-7, 100.0), 'piston area in chamber 1'),
    double('area_2', 1e-3, 'm^2', (1e-7, 100.0), 'piston area in chamber 2'),
    double('stroke', 0.2, 'm', (1e-4, 1e3), 'whole travel; position 0 is its middle'),
    double('dead_length_1', 0.1, 'm', (1e-4, 1e3), 'of chamber 1, the piston at its end'),
    double('dead_length_2', 0.1, 'm', (1e-4, 1e3), 'of chamber 2, the piston at its end'),
    double('port_loss_1', 0.75, '1', (0.0, 1e4), 'loss coefficient eta0 of port 1'),
    double('port_loss_2', 0.75, '1', (0.0, 1e4), 'loss coefficient eta0 of port 2'),
    double('mass', 10.0, 'kg', (0.0, 1e7), 'of piston and load; 0: none'),
    double('stiffness', 2e5, 'N/m', (0.0, 1e12), 'of the load spring, at rest at position 0'),
    double('viscous_friction', 500.0, 'N s/m', (0.0, 1e10), 'of piston and load'),
    double('coulomb_friction', 0.0, 'N', (0.0, 1e9), 'while sliding fast'),
    double('static_friction', 0.0, 'N', (0.0, 1e9), 'break-away force, not below Coulomb'),
    double('stribeck_velocity', 0.01, 'm/s', (1e-6, 100.0),
           'over which static falls to Coulomb friction'),
    double('leakage', 0.0, 'm^3/(s Pa)', (0.0, 1e-6), 'laminar conductance past the piston'),
    double('stop_restitution', 0.0, '1', (0.0, 1.0), 'rebound over impact speed at the stops'),
)

INITIAL = group(
    'initial',
    double('position', 0.0, 'm', (-500.0, 500.0), 'of the piston'),
    double('pressure_1', 1.05e7, 'Pa', (-1.2e8, 4e8), 'in chamber 1 and its line'),
    double('pressure_2', 1.05e7, 'Pa', (-1.2e8, 4e8), 'in chamber 2 and its line'),
    boolean('equilibrium', False, 'true: solved for; false: the three values as given'),
)

SOLVER = group(
    'solver',
    integer('cells', 200, (20, 20000), 'of the whole streamline, sets the step'),
    integer('iterations', 2, (1, 5), 'passes per step over slope and friction'),
    string('interpolation', 'cubic', 'between nodes; linear is for comparison only',
           ('cubic', 'linear')),
    double('max_mach', 0.025, '1', (1e-3, 0.5), 'largest |u|/c the step allows for'),
)

ACTUATOR = (*VALVE, *CYLINDER, *INITIAL, *SOLVER)
