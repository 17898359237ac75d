# SPDX-License-Identifier: Apache-2.0
"""
What a recording shows: series, numbers, figures, and the page that holds them.

Reads recordings only: no solver, no ROS. The figures are functions of plain arrays (`Series`).
"""
