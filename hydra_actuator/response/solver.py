# SPDX-License-Identifier: Apache-2.0
"""
The response of the nonlinear solver itself: small sines and a small knock about a piston at rest.

A sine fades in softly, then its first harmonic is fitted beside higher ones, mean, drift and bend.
Amplitudes are so small that second-order terms vanish; `linearity` measures what is left of them
by a run at four times the amplitude. Natural frequency and damping come from the ringing after a
knock of the load, by Juang and Pappa's eigensystem realisation (J. Guidance 8, 1985, 620-627).
"""

from collections.abc import Callable
import math

from hydra_actuator.actuator import Actuator, SolverError
from hydra_actuator.equilibrium import start_at
from hydra_actuator.errors import InputError
from hydra_actuator.response.distributed import Responses
from hydra_actuator.response.modes import Mode
from hydra_actuator.response.operating_point import OperatingPoint
import numpy as np

# Of the stroke, and of face area times pressure span.
AMPLITUDE = 1e-5
SHORTEST_FADE, SHORTEST_WINDOW = 0.3, 0.1
FADE_PERIODS, WINDOW_PERIODS, SAMPLES = 2.0, 2.0, 48
LARGER = 4.0
# Fitted beside the first: what a sine through the kink of an edge leaves besides.
HARMONICS = 6
# The knock: its length and the ringing after it in periods, samples per period, order.
KNOCK, RINGING, RATE, ORDER = 0.3, 16, 16, 8


class SolverAt(Actuator):
    """The actuator without seal friction, started at an operating point, its piston at rest."""

    def __init__(self, point: OperatingPoint) -> None:
        """Build it; raises InputError for a piston in motion."""
        if point.velocity != 0.0:
            raise InputError('the solver is driven about a piston at rest only')
        self.point = point
        super().__init__(point.parameters.replace({
            'sections.names': ('E', 'F'), 'sections.positions': (),
            'cylinder.coulomb_friction': 0.0, 'cylinder.static_friction': 0.0,
            'initial.equilibrium': False}))

    def reset(self) -> None:
        """Return to the operating point."""
        super().reset()
        self._model, self._state = start_at(self.parameters, self.point.equilibrium)
        self._state.spool[0], self._state.spool[2] = self.point.spools

    def drive(self, shape: Callable[[np.ndarray], np.ndarray], steps: int,
              amplitudes: tuple[float, float]) -> None:
        """
        Advance `steps` with spool and load off their steady values by amplitudes times shape(t).

        amplitudes: spool [of the stroke], load [N]. Raises SolverError where the method breaks.
        """
        first = round(self.time / self.step_time)
        times = np.arange(first + 1, first + steps + 1) * self.step_time
        wave, stroke = shape(times), self.parameters['valve.stroke']
        commands = np.empty((steps, 3))
        commands[:, 0] = self.point.spools[0] / stroke + amplitudes[0] * wave
        commands[:, 1] = self.point.spools[1] / stroke + amplitudes[0] * wave
        commands[:, 2] = self.point.load + amplitudes[1] * wave
        code = self.follow((times, commands, True), steps)
        if code:
            raise SolverError(self.status_message(code))


def load_amplitude(point: OperatingPoint) -> float:
    """Return the amplitude [N] of a small load."""
    p = point.parameters
    span = max(p['supply.pressure'] - p['tank.pressure'], 1e5)
    return AMPLITUDE * max(p['cylinder.area_1'], p['cylinder.area_2']) * span


def solver_responses(point: OperatingPoint, frequencies: np.ndarray,
                     progress: Callable[[float], None] = lambda share: None) -> Responses:
    """Return the solver's responses at frequencies [Hz]; see distributed.Responses."""
    actuator = SolverAt(point)
    rows = np.empty((len(frequencies), 4), complex)
    force = load_amplitude(point)
    for k, frequency in enumerate(frequencies):
        by_spool = _sine(actuator, frequency, (AMPLITUDE, 0.0))
        rows[k, :3] = by_spool[1:4] / by_spool[4]
        progress((2 * k + 1) / (2 * len(frequencies)))
        rows[k, 3] = _sine(actuator, frequency, (0.0, force))[0]
        progress((k + 1) / len(frequencies))
    v, p_1, p_2 = rows[:, :3].T
    ratio = point.parameters['cylinder.area_2'] / point.parameters['cylinder.area_1']
    return Responses(np.asarray(frequencies, float), v, p_1, p_2, p_1 - ratio * p_2,
                     -force / rows[:, 3])


def linearity(point: OperatingPoint, frequency: float) -> float:
    """Return how far [relative] the response at a frequency [Hz] is from that to a larger sine."""
    actuator, force = SolverAt(point), load_amplitude(point)
    small = _sine(actuator, frequency, (0.0, force))[0]
    large = _sine(actuator, frequency, (0.0, LARGER * force))[0]
    return float(abs(large / (LARGER * small) - 1.0))


def _sine(actuator: SolverAt, frequency: float, amplitudes: tuple[float, float]) -> np.ndarray:
    """Return complex amplitudes of position, velocity, pressures at E and F, and spool."""
    actuator.reset()
    omega, dt = 2.0 * math.pi * frequency, actuator.step_time
    fade = max(SHORTEST_FADE, FADE_PERIODS / frequency)
    window = max(SHORTEST_WINDOW, WINDOW_PERIODS / frequency)

    def shape(times: np.ndarray) -> np.ndarray:
        return soft_step(times / fade) * np.sin(omega * times)

    actuator.drive(shape, round(fade / dt), amplitudes)
    every = max(1, round(1.0 / (frequency * SAMPLES * dt)))
    trace = np.empty((max(SAMPLES, round(window / dt) // every), 6))
    channels = actuator.channels
    for row in trace:
        actuator.drive(shape, every, amplitudes)
        row[0] = actuator.time
        row[1:3] = actuator.row[channels.POSITION:channels.VELOCITY + 1]
        row[3:5] = actuator.row[channels.pressure]
        row[5] = actuator.row[channels.SPOOL_1]
    return fit_sine(trace[:, 0], trace[:, 1:], omega)


def fit_sine(times: np.ndarray, values: np.ndarray, omega: float) -> np.ndarray:
    """Return the complex a (M,) of Im(a exp(i omega t)) in values (N, M), with mean and drift."""
    z = (times - times.mean()) / np.ptp(times)
    waves = [wave(k * omega * times) for k in range(1, HARMONICS + 1) for wave in (np.sin, np.cos)]
    columns = np.column_stack([*waves, np.ones_like(z), z, z ** 2])
    sine, cosine = np.linalg.lstsq(columns, values - values.mean(axis=0), rcond=None)[0][:2]
    return sine + 1j * cosine


def soft_step(phase: np.ndarray) -> np.ndarray:
    """Return a step from 0 to 1 over the phase 0 to 1, with three continuous derivatives."""
    z = np.clip(phase, 0.0, 1.0)
    return z ** 4 * (35.0 - 84.0 * z + 70.0 * z ** 2 - 20.0 * z ** 3)


def solver_mode(point: OperatingPoint, near: float) -> Mode | None:
    """
    Return the mode of the solver's ringing that is nearest to a frequency [Hz], None if none is.

    near: where it is looked for; a third to three times of it.
    """
    import control

    actuator = SolverAt(point)
    length = KNOCK / near
    every = max(1, round(1.0 / (near * RATE * actuator.step_time)))

    def knock(times: np.ndarray) -> np.ndarray:
        return np.where(times < length, np.sin(math.pi * times / length) ** 2, 0.0)

    amplitudes = (0.0, load_amplitude(point))
    actuator.drive(knock, math.ceil(length / actuator.step_time), amplitudes)
    ringing = np.empty(RINGING * RATE)
    for k in range(len(ringing)):
        actuator.drive(knock, every, amplitudes)
        ringing[k] = actuator.row[actuator.channels.VELOCITY]
    largest = np.abs(ringing).max()
    if not largest > 0.0:
        return None
    ringing /= largest
    half = len(ringing) // 2 - 1
    found, _ = control.eigensys_realization(
        ringing, ORDER, m=half, n=half, dt=every * actuator.step_time)
    poles = np.log(found.poles().astype(complex)) / found.dt
    modes = [Mode(abs(s) / (2.0 * math.pi), float(-s.real / abs(s)))
             for s in poles if s.imag > 1e-3 * abs(s)]
    modes = [mode for mode in modes if near / 3.0 < mode.frequency < 3.0 * near]
    return min(modes, key=lambda m: abs(math.log(m.frequency / near)), default=None)
