# SPDX-License-Identifier: Apache-2.0
"""Cases with known answers: the solver against exact solutions, conservation laws and itself."""
