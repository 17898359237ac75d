# SPDX-License-Identifier: Apache-2.0
"""How far a proportional position loop can be turned up: spool = gain x (wanted - position)."""

from hydra_actuator.response.distributed import Responses
import numpy as np


def largest_gain(responses: Responses, dynamics: np.ndarray) -> float:
    """
    Return the gain [m of spool per m] at which the loop is on the verge of instability.

    dynamics: response of the spool to its command; the frequencies must lie dense. Infinite where
    the phase never reaches -180 degrees below the last frequency.
    """
    import control

    s = 2j * np.pi * responses.frequency
    loop = responses.velocity * dynamics / s
    if not np.isfinite(loop).all() or not np.abs(loop).max() > 0.0:
        return float('nan')
    scale = np.abs(loop).max()
    margins, *_ = control.stability_margins(
        control.frd(loop / scale, s.imag, smooth=True), returnall=True)
    margins = np.atleast_1d(margins)
    return float(margins.min() / scale) if margins.size else float('inf')
