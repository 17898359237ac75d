# SPDX-License-Identifier: Apache-2.0
"""
The characteristics of one domain: dx/dt = u + c and dx/dt = u - c, reflected at its ends.

They are integrated through given velocities, linear between nodes and frames; neglected: nothing
else. The ends may move.
"""

import numpy as np

SUBSTEPS = 32               # of the integration, from frame to frame


class Net:
    """The characteristics of one domain, both families."""

    def __init__(self, time: np.ndarray, x: np.ndarray, velocity: np.ndarray, speed: float,
                 substeps: int = SUBSTEPS) -> None:
        """Take frames: times [s], x [m] and velocity [m/s] (frames, nodes); wave speed [m/s]."""
        self.time = np.linspace(time[0], time[-1], substeps * (len(time) - 1) + 1)
        self._x, self._u = (
            np.stack([np.interp(self.time, time, node) for node in values.T], 1)
            for values in (x, velocity))
        self._speed = speed

    def lines(self, spacing: float) -> tuple[np.ndarray, np.ndarray]:
        """
        Return x [m] (instants, lines), and the direction of travel, +1 or -1.

        At the first instant lines of both families start a spacing [m] apart.
        """
        low, high = self._x[0, 0], self._x[0, -1]
        count = max(1, round((high - low) / spacing))
        start = low + (np.arange(count) + 0.5) * (high - low) / count
        x, way = np.concatenate((start, start)), np.repeat((1.0, -1.0), count)
        places, ways = [x], [way]
        for k in range(len(self.time) - 1):
            x, way = self._step(k, x, way)
            places.append(x)
            ways.append(way)
        return np.array(places), np.array(ways)

    def _step(self, k: int, x: np.ndarray, way: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return places and directions an instant later, by the mean of both slopes."""
        dt = self.time[k + 1] - self.time[k]
        here = np.interp(x, self._x[k], self._u[k])
        there = np.interp(x + (here + way * self._speed) * dt, self._x[k + 1], self._u[k + 1])
        after = x + (0.5 * (here + there) + way * self._speed) * dt
        low, high = self._x[k + 1, 0], self._x[k + 1, -1]
        beyond = (after < low) | (after > high)
        after = np.where(after < low, 2.0 * low - after, after)
        after = np.where(after > high, 2.0 * high - after, after)
        return after, np.where(beyond, -way, way)


def family(x: np.ndarray, way: np.ndarray, sign: float) -> np.ndarray:
    """Return the parts of (instants, lines) that travel one way, up to where they turn."""
    mine = way == sign
    # The turn itself lies between two instants: both families reach into it.
    mine[1:] |= way[:-1] == sign
    mine[:-1] |= way[1:] == sign
    return np.where(mine, x, np.nan)
