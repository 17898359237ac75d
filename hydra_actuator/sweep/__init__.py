# SPDX-License-Identifier: Apache-2.0
"""Many simulations over parameters: what is varied, how it runs on Dask, what comes out."""
