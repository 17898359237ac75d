# SPDX-License-Identifier: Apache-2.0
"""The one table of what a run of a sweep yields: name, unit, meaning."""

from typing import NamedTuple


class Merit(NamedTuple):
    """A figure of merit."""

    name: str
    unit: str
    meaning: str


MERITS = (
    Merit('bandwidth', 'Hz', 'up to which small commands at null become piston velocity within '
                             '-3 dB of the plateau and 90 degrees; NaN if nothing answers'),
    Merit('resonance', 'Hz', 'of the largest small-signal gain from command to velocity'),
    Merit('resonance_gain', '1', 'largest gain over the plateau'),
    Merit('velocity_gain', 'm/s', 'plateau: speed per full command by the gain at null'),
    Merit('peak_pressure', 'Pa', 'highest absolute pressure anywhere'),
    Merit('lowest_pressure', 'Pa', 'lowest absolute pressure anywhere; below 0 the model lacks '
                                   'cavitation'),
    Merit('cavity_volume', 'm^3', 'largest volume of all cavities at once'),
    Merit('travel', 'm', 'highest less lowest position'),
    Merit('rms_position', 'm', 'root of the mean square about the mean'),
    Merit('final_position', 'm', 'at the end'),
    Merit('peak_velocity', 'm/s', 'largest speed of the piston'),
    Merit('rms_velocity', 'm/s', 'root of the mean square'),
    Merit('peak_effort', 'N', 'largest hydraulic force'),
    Merit('peak_supply_flow', 'm^3/s', 'largest flow out of the pump'),
    Merit('supply_power', 'W', 'mean of gauge pressure times flow out of the pump'),
    Merit('largest_mach', '1', 'largest |u|/c'),
    Merit('stop_hits', '1', 'how often the piston ran into a stop'),
    Merit('run_time', 's', 'computing time of the run, of its thread'),
)
NAMES = tuple(merit.name for merit in MERITS)
