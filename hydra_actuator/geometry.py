# SPDX-License-Identifier: Apache-2.0
"""
The actuator's geometry: lengths along the streamline, wave speeds, where a section lies.

    O ---- supply_line ---- A | B - line_1 - C | D - chamber_1 - E ]piston[ F - chamber_2 - G | ...

Coordinates run from the pump (0) to the tank. The second chamber is seen from G towards the
piston.
"""

from hydra_actuator.channels import STATIONS
from hydra_actuator.core.observe import SECTION
from hydra_actuator.parameters import ParameterError, Parameters, streamline
from hydra_actuator.parameters.streamline import domain_lengths
import numpy as np

LINES = ('line', 'line_1', 'line_2')

# Ends of the chain in the order of the stations: F is the face, G the fixed end of chamber_2.
END_OF_STATION = dict(zip(STATIONS, (0, 1, 2, 3, 4, 5, 7, 6, 8, 9, 10, 11)))


def wave_speed(parameters: Parameters, domain: str = '') -> float:
    """
    Return the wave speed [m/s] at gauge zero in a domain, in the oil alone by default.

    The walls of lines may be elastic, those of chambers are rigid.
    """
    return streamline.wave_speed(parameters, domain if domain.endswith(LINES) else '')


def cylinder_length(parameters: Parameters) -> float:
    """Return the distance [m] between the fixed ends D and G."""
    return (parameters['cylinder.dead_length_1'] + parameters['cylinder.stroke']
            + parameters['cylinder.dead_length_2'])


def origins(parameters: Parameters) -> tuple[float, ...]:
    """Return the streamline coordinate [m] of node 0 of the six domains; the pump is 0."""
    supply, line_1, _, _, line_2, _ = domain_lengths(parameters)
    port_d = supply + line_1
    port_g = port_d + cylinder_length(parameters)
    return 0.0, supply, port_d, port_g, port_g, port_g + line_2


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
