# SPDX-License-Identifier: Apache-2.0
"""The compiled loop, kept on disk beside the solver's kernels."""

from contextlib import AbstractContextManager
from pathlib import Path

from hydra_actuator.kernels import cache_key, digest_of_sources, warm
from hydra_actuator.realtime.loop import tick_on_grid

SOURCES = digest_of_sources(Path(__file__).parent)


def warm_loop(passes: int, plain: bool) -> AbstractContextManager[None]:
    """Let the loop come from the disk, or be kept there; as kernels.warm_kernels for its own."""
    return warm((tick_on_grid,), cache_key('loop', SOURCES, passes, plain))
