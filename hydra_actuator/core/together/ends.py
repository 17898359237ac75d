# SPDX-License-Identifier: Apache-2.0
"""Ends without gas, one in each lane; see hydra_actuator.core.end."""

from hydra_actuator.core.compilation import formula
from hydra_actuator.core.end import End
from hydra_actuator.core.lanes import element


@formula
def end_in_lanes(now, end):
    """Return the End of a domain without gas, in every lane."""
    d = end // 2
    return End(
        element(now.end_wave, end), element(now.end_velocity, end), element(now.slowness, d),
        element(now.bulk_modulus, d), element(now.area, d), element(now.impedance, d),
        element(now.inverse_area, d), 0.0, 0.0, 0.0)
