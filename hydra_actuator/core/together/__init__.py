# SPDX-License-Identifier: Apache-2.0
"""Four actuators to a step, one in each lane of a vector."""
