# SPDX-License-Identifier: Apache-2.0
"""How cost grows: with cells, simulated time, actuators, threads, and the workers of a sweep."""
