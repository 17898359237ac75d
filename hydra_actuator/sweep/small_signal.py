# SPDX-License-Identifier: Apache-2.0
"""
How fast an actuator answers small commands, by the exact linear plant with its waves.

G(f) is the response from command to piston velocity about null, the spool's dynamics in it. Its
plateau is |G| at a low frequency with the load spring left out, which matters only below.
Bandwidth, as in data sheets of servo-valves: where G has fallen 3 dB below the plateau or lags by
90 degrees, whichever comes first.
"""

import math

from hydra_actuator.errors import Failure, InputError
from hydra_actuator.parameters import Parameters
import numpy as np

LOWEST, HIGHEST, POINTS = 1.0, 3000.0, 300
HALF_POWER = 1.0 / math.sqrt(2.0)
RIGHT_ANGLE = 0.5 * math.pi


def small_signal(parameters: Parameters) -> dict[str, float]:
    """
    Return bandwidth, resonance [Hz], resonance_gain and velocity_gain [m/s].

    NaN where nothing answers at null, or there is no operating point there.
    """
    from hydra_actuator.response.distributed import linear_plant, respond, spool_dynamics
    from hydra_actuator.response.operating_point import find_operating_point

    nothing = dict.fromkeys(
        ('bandwidth', 'resonance', 'resonance_gain', 'velocity_gain'), math.nan)
    try:
        point = find_operating_point(parameters)
        plant = linear_plant(point)
        free = plant._replace(point=point._replace(
            parameters=point.parameters.replace({'cylinder.stiffness': 0.0})))
        frequency = np.geomspace(LOWEST, HIGHEST, POINTS)
        response = respond(plant, frequency).velocity * spool_dynamics(plant, frequency)
        plateau = abs(respond(free, frequency[:1]).velocity[0])
    except (Failure, InputError, np.linalg.LinAlgError):
        return nothing
    if not plateau > 0.0 or not np.isfinite(response).all():
        return nothing
    gain = np.abs(response) / plateau
    top = int(np.argmax(gain))
    return {
        'bandwidth': bandwidth(frequency, response / plateau),
        'resonance': float(frequency[top]), 'resonance_gain': float(gain[top]),
        'velocity_gain': float(plateau * parameters['valve.stroke'])}


def bandwidth(frequency: np.ndarray, response: np.ndarray) -> float:
    """
    Return where a response (complex, plateau 1) is first 3 dB below or lags 90 degrees [Hz].

    A gain that only rises to the plateau, as with a load spring, counts from there. NaN if neither
    comes about at the frequencies given.
    """
    gain, lag = np.abs(response), -np.unwrap(np.angle(response))
    risen = np.maximum.accumulate(gain >= HALF_POWER)
    found = [_crossing(frequency, -gain, -HALF_POWER, risen),
             _crossing(frequency, lag, RIGHT_ANGLE, np.ones(len(gain), bool))]
    return float(np.nanmin(found)) if np.isfinite(found).any() else math.nan


def _crossing(frequency: np.ndarray, values: np.ndarray, level: float,
              counts: np.ndarray) -> float:
    """Return where values first rise to a level, in the logarithm of frequency [Hz]."""
    above = np.flatnonzero((values >= level) & counts)
    if not len(above):
        return math.nan
    k = int(above[0])
    if k == 0:
        return float(frequency[0])
    part = (level - values[k - 1]) / (values[k] - values[k - 1])
    return float(frequency[k - 1] * (frequency[k] / frequency[k - 1]) ** part)
