# SPDX-License-Identifier: Apache-2.0
"""
Faults of the instruments and of the plant; with every one at 0, false or empty there is none.

Each section has its own pressure faults, so their table depends on the names of the sections.
"""

from hydra_actuator.parameters.definition import (
    boolean,
    double,
    group,
    Parameter,
    string,
)

QUANTITIES = {'position': 'm', 'velocity': 'm/s', 'effort': 'N', 'spool': 'm'}

PLANT_FAULTS = group(
    'fault',
    boolean('enabled', False, 'let faults act at all'),
    string('script', '', 'CSV file time,parameter,value, in simulated time; empty: none'),
    boolean('valve_stuck', False, 'the spool stays where it is'),
    double('null_shift', 0.0, '1', (-1.0, 1.0), 'added to the command, as part of the stroke'),
    boolean('command_lost', False, 'no command reaches the valve: it centres'),
    double('supply_loss', 0.0, '1', (0.0, 1.0),
           'part of the supply pressure above the tank that is lost, over 50 ms'),
    double('air_fraction', 0.0, '1', (0.0, 0.2), 'free gas added to the oil, by volume'),
    double('leakage', 0.0, 'm^3/(s Pa)', (0.0, 1e-6), 'added past the piston'),
    live=True,
)


def signal_faults(quantity: str, unit: str) -> tuple[Parameter, ...]:
    """Define the faults of one instrument, e.g. `fault.pressure.A.offset`."""
    return group(
        f'fault.{quantity}',
        boolean('off', False, 'reads NaN'),
        boolean('stuck', False, 'keeps its last reading'),
        double('offset', 0.0, unit, (-1e9, 1e9), 'added to the reading'),
        double('noise', 0.0, unit, (0.0, 1e9), 'standard deviation added'),
        double('delay', 0.0, 's', (0.0, 10.0), 'added to the reading'),
        double('time_constant', 0.0, 's', (0.0, 100.0), 'of a first-order lag'),
        double('dropout', 0.0, '1', (0.0, 1.0), 'probability that a reading is missing: NaN'),
        live=True,
    )


def pressure_faults(section_names: tuple[str, ...]) -> tuple[Parameter, ...]:
    """Define the pressure faults of all sections."""
    return tuple(
        fault for name in section_names for fault in signal_faults(f'pressure.{name}', 'Pa')
    )


FAULTS = PLANT_FAULTS + tuple(
    fault for quantity, unit in QUANTITIES.items() for fault in signal_faults(quantity, unit)
)
