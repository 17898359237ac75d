# SPDX-License-Identifier: Apache-2.0
"""
Lone lines and chambers for verification: build a chain, move it, read it in plain numbers.

The readings use the equation of state directly, not the solver's own observation, so that an
error there cannot hide one here.
"""

from functools import cache

from hydra_actuator.core.advance import advance
from hydra_actuator.core.model import build_chain, Domain, Junction, Mesh, node_positions
from hydra_actuator.core.observe import NOT_A_NUMBER, observe, read_field, SECTION, TOO_FAST
from hydra_actuator.core.oil import Oil
from hydra_actuator.core.records import CLOSED
from hydra_actuator.errors import Failure
from hydra_actuator.kernels import warm_kernels
import numpy as np

# Mineral oil of the reference: rho0 [kg/m^3], c [m/s], chi = rho0 c^2 [Pa].
DENSITY = 860.0
WAVE_SPEED = 1300.0
BULK_MODULUS = DENSITY * WAVE_SPEED ** 2
INPUTS = 4
OIL = Oil(DENSITY)
GASSY = Oil(DENSITY, air_fraction=1e-4, floor=1e5)


class LoneChain:
    """A chain of domains and junctions with its state; inputs are held until changed."""

    def __init__(self, domains: list[Domain], junctions: list[Junction], mesh: Mesh,
                 oil: Oil = OIL, **records: np.ndarray) -> None:
        """Build the chain at rest; records: valve, piston, source as build_chain takes them."""
        self.names = [domain.name for domain in domains]
        self.model, self.state = build_chain(oil, domains, junctions, mesh, **records)
        make_kernels_ready(mesh.iterations, not self.model.extras)
        self.inputs = np.zeros(INPUTS)
        self._table = np.zeros((1, INPUTS))
        self._held = (np.zeros(1), self._table, True)
        self._passes = (0,) * mesh.iterations

    @property
    def time(self) -> float:
        """Simulated time [s]."""
        return int(self.state.step[0]) * self.model.step_time

    def hold(self, *inputs: float) -> None:
        """Hold these inputs from the next step on; those not given are zero."""
        self._table[0] = 0.0
        self._table[0, :len(inputs)] = inputs

    def advance(self, steps: int = 1) -> None:
        """Advance under the held inputs; raises Failure where the method breaks."""
        self._run(self._held, steps)

    def step(self, *inputs: float) -> None:
        """Advance one step, at whose end the inputs have these values."""
        self.hold(*inputs)
        self._run(self._held, 1)

    def follow(self, times: np.ndarray, table: np.ndarray, steps: int) -> None:
        """Advance under inputs linear between the rows of a table (T, up to 4) at times [s]."""
        full = np.zeros((len(times), INPUTS))
        full[:, :table.shape[1]] = table
        self._run((np.ascontiguousarray(times, float), full, False), steps)

    def _run(self, schedule: tuple, steps: int) -> None:
        code = advance(self.model, self.state, self._passes, schedule, self.inputs, steps, 1000)
        if code:
            _, d, value = self.state.fault
            what = {NOT_A_NUMBER: 'NaN', TOO_FAST: 'too fast'}.get(code, 'too short')
            raise Failure(f'{what} in {self.names[int(d)]} at {self.time:.6f} s: {value:g}')

    def waves(self, d: int) -> tuple[np.ndarray, np.ndarray]:
        """Return (P, Q) [m/s] at the whole nodes of a domain, then at its face if it moves."""
        first = self.model.start[d]
        nodes = slice(first, first + self.state.last[d] + 1)
        p, q = self.state.wave_p[nodes], self.state.wave_q[nodes]
        if self.model.moving[d]:
            p = np.append(p, self.state.face_p[d])
            q = np.append(q, self.state.face_q[d, 0])
        return p, q

    def positions(self, d: int) -> np.ndarray:
        """Return the distances [m] from node 0 of the values that `waves` returns."""
        x = node_positions(self.model, self.state, d)
        return np.append(x, self.state.length[d]) if self.model.moving[d] else x

    def pressure(self, d: int) -> np.ndarray:
        """
        Return gauge pressures [Pa] along a domain.

        With gas they are read from it, p = p* - floor: (P + Q)/2 of an inner node is not mu while
        its gas grows.
        """
        model, state = self.model, self.state
        if model.end_strength[d] > 0.0:
            star = state.star[model.start[d]:model.start[d] + state.last[d] + 1]
            face = [state.end_star[2 * d + 1]] if model.moving[d] else []
            return np.append(star, face) - model.floor
        p, q = self.waves(d)
        return self._pressure(0.5 * (p + q), d)

    def velocity(self, d: int) -> np.ndarray:
        """Return velocities [m/s] away from node 0 along a domain."""
        p, q = self.waves(d)
        return 0.5 * (p - q)

    def end_pressure(self, end: int) -> float:
        """Return the gauge pressure [Pa] at an end: 2 d at node 0, 2 d + 1 at the far end."""
        p, q = self._end_waves(end)
        return float(self._pressure(0.5 * (p + q), end // 2))

    def end_velocity(self, end: int) -> float:
        """Return the velocity [m/s] out of the domain at an end."""
        p, q = self._end_waves(end)
        return 0.5 * (p - q) if end % 2 else 0.5 * (q - p)

    def _end_waves(self, end: int) -> tuple[float, float]:
        d, state = end // 2, self.state
        if end % 2 and self.model.moving[d]:
            return float(state.face_p[d]), float(state.face_q[d, 0])
        node = self.model.start[d] + (state.last[d] if end % 2 else 0)
        return float(state.wave_p[node]), float(state.wave_q[node])

    def _pressure(self, mu, d: int):
        return self.model.bulk_modulus[d] * np.expm1(mu / self.model.wave_speed[d])


@cache
def make_kernels_ready(iterations: int, plain: bool = True) -> None:
    """Load or compile the kernels for a number of iterations, once in a process."""
    mesh = Mesh(1e-5, iterations=iterations)
    model, state = build_chain(
        OIL if plain else GASSY, [Domain('line', 0.1, 1e-4, WAVE_SPEED)],
        [Junction(CLOSED, (0,)), Junction(CLOSED, (1,))], mesh)
    inputs = np.zeros(INPUTS)
    schedule = (np.zeros(1), np.zeros((1, INPUTS)), True)
    with warm_kernels(iterations, plain):
        advance(model, state, (0,) * iterations, schedule, inputs, 0, 1)
        observe(model, state, np.zeros(1, SECTION), 0.0, inputs, np.zeros(16))
        read_field(model, state, 0.0, np.zeros((model.capacity[0] + 1, 2), np.float32))


def mesh_of(length: float, cells: int, courant: float = 1.0 / 1.025,
            wave_speed: float = WAVE_SPEED, **choices) -> Mesh:
    """
    Return the mesh of exactly `cells` cells in a line of `length` [m] at a Courant number.

    choices: iterations, interpolation of Mesh.
    """
    step_time = courant * length / (cells * wave_speed)
    return Mesh(step_time, max_mach=1.0 / courant - 1.0, **choices)


def riemann_variable(pressure, wave_speed: float = WAVE_SPEED,
                     bulk_modulus: float = BULK_MODULUS):
    """Return mu [m/s] at a gauge pressure [Pa]."""
    return wave_speed * np.log1p(np.asarray(pressure) / bulk_modulus)


def pressure_of(mu, wave_speed: float = WAVE_SPEED, bulk_modulus: float = BULK_MODULUS):
    """Return the gauge pressure [Pa] at mu [m/s]."""
    return bulk_modulus * np.expm1(np.asarray(mu) / wave_speed)
