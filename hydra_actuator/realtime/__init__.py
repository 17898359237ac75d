# SPDX-License-Identifier: Apache-2.0
"""
Ticks on a grid of time in one compiled loop, which needs the interpreter for nothing.

What the loop shares with Python lies in arrays; a function here that both use is written once, as
Python, and compiled into the loop. Commands come through `held`, rows leave through `memory`.
"""
