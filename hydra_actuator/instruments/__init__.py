# SPDX-License-Identifier: Apache-2.0
"""Between the truth of the solver and what is published: sensors, and what can ail them."""

from hydra_actuator.instruments.instruments import Instruments

__all__ = ['Instruments']
