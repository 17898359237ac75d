# SPDX-License-Identifier: Apache-2.0
"""Surfaces over streamline and time, as matplotlib draws them: walls at jumps, shaded slopes."""

import numpy as np

WALL_CELLS = 12         # of the surface where the pressure jumps between two domains


def with_walls(x: np.ndarray, values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return frames (frames, nodes) in which a jump between two domains is a wall of cells."""
    jumps = np.flatnonzero(np.all(np.diff(x, axis=1) < 1e-9, axis=0))
    parts = np.linspace(0, 1, WALL_CELLS + 1)[1:-1]
    places = np.repeat(jumps + 1, len(parts))
    inner = [(1 - w) * values[:, k] + w * values[:, k + 1] for k in jumps for w in parts]
    if not inner:
        return x, values
    return (np.insert(x, places, x[:, places], axis=1),
            np.insert(values, places, np.stack(inner, axis=1), axis=1))


def shaded(values: np.ndarray, colours, limits: tuple[float, float],
           exaggeration: float = 0.6) -> np.ndarray:
    """
    Return the colours of a surface, shaded by its slope so that waves show on a plateau.

    colours: a matplotlib colour map or its name; exaggeration: of heights, in the light's eyes.
    """
    from matplotlib import colormaps
    from matplotlib.colors import LightSource, Normalize

    source = LightSource(azdeg=250, altdeg=50)
    return source.shade(
        values, colormaps.get_cmap(colours), norm=Normalize(*limits), vert_exag=exaggeration,
        blend_mode='soft', fraction=0.7,
    )
