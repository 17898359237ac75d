# SPDX-License-Identifier: Apache-2.0
"""
The paper's one-sided actuator: supply side with its waves, return side without.

    O ---- A | B ---- C | D ---- E ]piston        p = 0 behind it

The return side is taken as quasi-static flow at zero pressure (Jankovic et al., section 5), so
nothing pushes back and nothing is lost there. Here it is the same solver with a second piston
area of a ten-thousandth of the first: what it carries and what it pushes is of that size. Only
the direct edge A to B opens; for the reverse half of a stroke such a model has no equations. It
starts in balance: chamber and spring at zero.
"""

from hydra_actuator.parameters import Parameters

VANISHING = 1e-4        # of the first piston area


def one_sided(parameters: Parameters) -> Parameters:
    """Return the parameters of the one-sided actuator made of a whole one."""
    return parameters.replace({
        'cylinder.area_2': VANISHING * parameters['cylinder.area_1'],
        'cylinder.port_loss_2': 0.0, 'valve.gain_pb': 0.0, 'valve.gain_at': 0.0,
        'line_2.friction': 'none', 'return_line.friction': 'none', 'tank.pressure': 0.0,
        'initial.position': 0.0, 'initial.pressure_1': 0.0, 'initial.pressure_2': 0.0})
