# SPDX-License-Identifier: Apache-2.0
"""Other solvers of water hammer on the work they can do: one line, a valve that closes at once."""
