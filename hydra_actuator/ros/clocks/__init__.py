# SPDX-License-Identifier: Apache-2.0
"""What decides that the plant ticks: a steady clock, commands, /clock, or nothing at all."""
