# SPDX-License-Identifier: Apache-2.0
"""Properties of compiled formulas: the first call compiles, and a test finds the same each day."""

from hypothesis import settings

settings.register_profile('compiled', deadline=None, derandomize=True)
settings.load_profile('compiled')
