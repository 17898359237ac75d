# SPDX-License-Identifier: Apache-2.0
"""The exact solutions of laminar waves against their tables, series and limits."""

import math

from hydra_actuator.core.friction import DECAY, WEIGHT
from hydra_actuator.verification import friction_laplace
from hydra_actuator.verification.friction_blocked import LENGTH, PEAKS, RADIUS, SPEED, VISCOSITY
from hydra_actuator.verification.friction_laplace import (
    blocked_response,
    propagation,
    stopped_flow,
)
from hydra_actuator.verification.friction_transient import DISSIPATION, EXACT
import numpy as np
import pytest

# one unit of the last tabled digit: 1.31018447 is tabled as 1.310185
DIGITS = 1e-6


def bessel(order: int, z: complex) -> complex:
    """Return the modified Bessel function I by its power series."""
    return sum((z / 2) ** (2 * k + order) / (math.factorial(k) * math.factorial(k + order))
               for k in range(60))


@pytest.mark.parametrize('z', [0.3 + 0.0j, 2.0 + 1.0j, 1.0 - 8.0j, 9.0 + 9.0j])
def test_propagation_is_the_ratio_of_bessel_functions(z):
    exact = np.sqrt(bessel(0, z) / bessel(2, z))
    assert propagation(z * z, 1.0) == pytest.approx(exact, rel=1e-10)


@pytest.mark.parametrize('column', range(len(DISSIPATION)))
def test_inversion_gives_the_tabled_transient_to_its_digits(column):
    dissipation = list(DISSIPATION)[column]
    got = [stopped_flow(time, dissipation) for time in EXACT]
    assert got == pytest.approx([values[column] for values in EXACT.values()], abs=DIGITS)


def test_inversion_has_converged(monkeypatch):
    before = [stopped_flow(time, 0.015) for time in (0.25, 2.25, 19.75)]
    monkeypatch.setattr(friction_laplace, 'CONTOUR_POINTS', 32)
    monkeypatch.setattr(friction_laplace, 'FRACTION_DEPTH', 600)
    after = [stopped_flow(time, 0.015) for time in (0.25, 2.25, 19.75)]
    assert after == pytest.approx(before, abs=1e-9)


def fitted_propagation(s, dissipation: float):
    """Return g [-] with the memory's six fitted terms, exact in time and space."""
    q = np.asarray(s, complex) / dissipation
    memory = sum(m * q / (q + n) for n, m in zip(DECAY, WEIGHT))
    left_out = (1.0 / 12.0 - sum(m / n for n, m in zip(DECAY, WEIGHT))) * q
    return np.sqrt(1.0 + (8.0 + 4.0 * memory + 4.0 * left_out) / q)


def test_the_fitted_terms_alone_leave_the_transient_within_0_0024(monkeypatch):
    monkeypatch.setattr(friction_laplace, 'propagation', fitted_propagation)
    worst = max(abs(stopped_flow(time, dissipation) - values[column])
                for time, values in EXACT.items()
                for column, dissipation in enumerate(DISSIPATION))
    assert worst == pytest.approx(0.0024, abs=5e-5)


def test_the_fitted_terms_alone_shift_peaks_by_0_02_and_heights_by_0_6_percent(monkeypatch):
    monkeypatch.setattr(friction_laplace, 'propagation', fitted_propagation)
    transit = LENGTH / SPEED
    shifts, losses = [], []
    for frequency, height in PEAKS:
        frequencies = np.arange(frequency - 2.0, frequency + 2.0, 0.001)
        response = blocked_response(frequencies * transit, VISCOSITY * transit / RADIUS ** 2)
        shifts.append(abs(frequencies[np.argmax(response)] / frequency - 1.0))
        losses.append(abs(response.max() / height - 1.0))
    assert max(shifts) == pytest.approx(2e-4, abs=1e-5)
    assert max(losses) == pytest.approx(0.0056, abs=1e-4)


def test_a_stop_without_viscosity_is_a_square_wave():
    got = [stopped_flow(time, 1e-9) for time in (1.0, 3.0, 5.0, 7.0)]
    assert got == pytest.approx([1.0, -1.0, 1.0, -1.0], abs=1e-3)


@pytest.mark.parametrize(('frequency', 'height'), PEAKS)
def test_blocked_line_peaks_as_tabled(frequency, height):
    transit = LENGTH / SPEED
    frequencies = np.arange(frequency - 2.0, frequency + 2.0, 0.001)
    response = blocked_response(frequencies * transit, VISCOSITY * transit / RADIUS ** 2)
    assert frequencies[np.argmax(response)] == pytest.approx(frequency, abs=0.0015)
    assert response.max() == pytest.approx(height, abs=0.00051)
