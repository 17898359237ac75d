# SPDX-License-Identifier: Apache-2.0
"""Frequencies and amplitudes of sampled oscillations, by least squares."""

import numpy as np

ROUNDS = 6


def fit_oscillation(times: np.ndarray, values: np.ndarray,
                    guess: float) -> tuple[float, float]:
    """
    Return (angular frequency [rad/s], decay [1/s]) of one damped oscillation about a mean.

    guess: within a fraction of a period over the whole record. Gauss-Newton's method.
    """
    omega, cosine, sine = guess, 0.0, 0.0
    decay = 0.0
    for _ in range(ROUNDS):
        envelope = np.exp(-decay * times)
        wave_c, wave_s = envelope * np.cos(omega * times), envelope * np.sin(omega * times)
        to_frequency = times * (sine * wave_c - cosine * wave_s)
        to_decay = -times * (cosine * wave_c + sine * wave_s)
        columns = [wave_c, wave_s, np.ones_like(times)]
        if cosine or sine:
            columns += [to_frequency, to_decay]
        found = np.linalg.lstsq(np.column_stack(columns), values, rcond=None)[0]
        cosine, sine = found[0], found[1]
        if len(found) > 3:
            omega, decay = omega + found[3], decay + found[4]
    return float(omega), float(decay)


def first_harmonic(times: np.ndarray, values: np.ndarray, omega: float) -> complex:
    """Return the complex amplitude of Im(a exp(i omega t)) in values with mean and drift."""
    columns = np.column_stack([
        np.sin(omega * times), np.cos(omega * times), np.ones_like(times), times])
    sine, cosine = np.linalg.lstsq(columns, values, rcond=None)[0][:2]
    return complex(sine, cosine)
