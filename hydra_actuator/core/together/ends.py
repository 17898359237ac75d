# SPDX-License-Identifier: Apache-2.0
"""Ends without gas, one in each lane; see hydra_actuator.core.end."""

from hydra_actuator.core.choices import at_least, where_at_most
from hydra_actuator.core.compilation import formula
from hydra_actuator.core.end import End, relation_of, SERIES_REACH, steering_series
from hydra_actuator.core.fluid import compression_series, SERIES_LIMIT
from hydra_actuator.core.lanes import element
from hydra_actuator.core.orifice import NO_STEP, STEP_TOLERANCE


@formula
def end_in_lanes(now, end):
    """Return the End of a domain without gas, in every lane."""
    d = end // 2
    return End(
        element(now.end_wave, end), element(now.end_velocity, end), element(now.slowness, d),
        element(now.bulk_modulus, d), element(now.area, d), element(now.impedance, d),
        element(now.inverse_area, d), 0.0, 0.0, 0.0)


@formula
def relation_in_lanes(end, velocity):
    """Return `end_relation` without gas, and how far it is into the reach of its series."""
    z = (end.wave - velocity) * end.slowness
    compression = compression_series(z)
    mach = velocity * end.slowness
    growth, lightness = steering_series(mach, compression)
    relation = relation_of(end, velocity, compression, (growth, lightness, 1.0))
    return relation, at_least(abs(z) * (1.0 / SERIES_LIMIT), abs(mach) * (1.0 / SERIES_REACH))


@formula
def still_moves(velocity, change, unsettled):
    """Return 0 in the lanes where a Newton step was the last needed, else `unsettled`."""
    return where_at_most(
        abs(change), STEP_TOLERANCE * abs(velocity) + NO_STEP, 0.0 * unsettled, unsettled)
