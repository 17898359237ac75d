# SPDX-License-Identifier: Apache-2.0
"""The options of the physics beyond the paper: what each adds to a model, alone and together."""

from hydra_actuator.parameters.table_hydraulics import LINES

OPTIONS = {
    'steady friction': {f'{line}.friction': 'steady' for line in LINES},
    'unsteady friction': {f'{line}.friction': 'unsteady' for line in LINES},
    'cavitation': {'fluid.cavitation': True},
    'elastic walls': {f'{line}.youngs_modulus': 2.1e11 for line in LINES},
    'accumulator': {'supply.accumulator_volume': 1e-3},
    'four edges (underlap, leakage)': {
        **{f'valve.overlap_{edge}': -1e-5 for edge in ('pa', 'pb', 'at', 'bt')},
        'valve.leakage': 1e-13},
    'spool dynamics': {'valve.natural_frequency': 200.0, 'valve.slew_rate': 0.5},
    'piston friction': {'cylinder.coulomb_friction': 100.0, 'cylinder.static_friction': 200.0},
    'piston leakage': {'cylinder.leakage': 1e-13},
}
EVERYTHING = {name: value for option in ('unsteady friction', *OPTIONS)
              if option != 'steady friction' for name, value in OPTIONS[option].items()}
