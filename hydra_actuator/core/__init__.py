# SPDX-License-Identifier: Apache-2.0
"""Physics of the hydraulic actuator: numpy, numba and math only."""
