# SPDX-License-Identifier: Apache-2.0
"""
The plant, linear about an operating point: exact with its waves, by the solver, and lumped.

Needs the extra `response` (scipy, control, matplotlib).
"""
