# SPDX-License-Identifier: Apache-2.0
"""The paper's case: its runs, its figures, and its statements judged by numbers."""
