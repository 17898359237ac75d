# SPDX-License-Identifier: Apache-2.0
"""The whole actuator under a command and under its negative: each the other's mirror image."""

from hydra_actuator.actuator import Actuator
from hydra_actuator.parameters import Parameters
from hydra_actuator.verification.case import Case, Row
import numpy as np

FREQUENCY = 50.0
TICKS = 200


def run(parameters: Parameters, sign: float) -> tuple[np.ndarray, np.ndarray]:
    """Return positions [m] (T,) and pressures [Pa] (T, sections) under a full-stroke sine."""
    actuator = Actuator(parameters)
    rows = []
    for _ in range(TICKS):
        time = actuator.time + actuator.period
        command = sign * float(np.sin(2.0 * np.pi * FREQUENCY * time))
        actuator.tick_once(command, command, 0.0)
        rows.append(actuator.row.copy())
    rows, channels = np.array(rows), actuator.channels
    return rows[:, channels.POSITION], rows[:, channels.pressure]


def mirror() -> list[Row]:
    """Compare both, chambers at first midway between supply and tank."""
    parameters = Parameters()
    midway = 0.5 * (parameters['supply.pressure'] + parameters['tank.pressure'])
    parameters = parameters.replace({
        'initial.pressure_1': midway, 'initial.pressure_2': midway,
        'sections.names': tuple('ABCDEFGHIJ')})
    position, pressure = run(parameters, 1.0)
    mirrored, other = run(parameters, -1.0)
    # A and J stay, B..I change places with I..B
    image = other[:, [0, 8, 7, 6, 5, 4, 3, 2, 1, 9]]
    stroke = float(np.ptp(position))
    return [
        Row('mirror', 'position + mirrored position, worst', 'm', 0.0,
            float(np.abs(position + mirrored).max()), 1e-16, False,
            f'rounding at a stroke of {1e3 * stroke:.1f} mm'),
        Row('mirror', 'pressure - mirrored pressure, worst of A to J', 'Pa', 0.0,
            float(np.abs(pressure - image).max()), 1e-6, False, 'rounding of mu, 3e-9 Pa'),
    ]


CASES = {'mirror': Case(mirror, 'a command and its negative')}
