# SPDX-License-Identifier: Apache-2.0
"""
The spectrum at a face that moves steadily through its mesh, under a tone from the other end.

    source ==[resistor rho c/A]== chamber ----]--> v      the resistor swallows what comes back

The partial cell's length repeats with v/dx. An error that depends on it would show as a line
there, and, as it modulates the tone, at the sum and the difference of both.
"""

from functools import cache

from hydra_actuator.core.model import Domain, Junction
from hydra_actuator.core.records import ORIFICE, PRESSURE, WALL
from hydra_actuator.verification.case import Case, Row
from hydra_actuator.verification.chains import (
    BULK_MODULUS,
    DENSITY,
    LoneChain,
    mesh_of,
    WAVE_SPEED,
)
from hydra_actuator.verification.drawing import bar, ORANGE, SOLVER
import numpy as np

LENGTH = 1.0
AREA = 1e-3
REST = 10e6
SPEED = 5.0
CELLS = 100
TONE, AMPLITUDE = 317.0, 1e6
RISE, DURATION = 0.02, 0.19
FACE = 3
BAR = 1e-8


@cache
def face_pressure(interpolation: str) -> tuple[np.ndarray, float, float]:
    """Return (gauge pressure [Pa] at the face, step time [s], crossing frequency [Hz])."""
    mesh = mesh_of(LENGTH, CELLS, interpolation=interpolation)
    conductance = AREA / (DENSITY * WAVE_SPEED)
    source = REST + SPEED * AREA * (1.0 + REST / BULK_MODULUS) / conductance
    chain = LoneChain(
        [Domain('inlet', 0.05, AREA, WAVE_SPEED, pressure=source, velocity=SPEED),
         Domain('chamber', LENGTH, AREA, WAVE_SPEED, pressure=REST, velocity=SPEED,
                longest=2.0 * LENGTH)],
        [Junction(PRESSURE, (0,), 0), Junction(ORIFICE, (1, 2), leakage=conductance),
         Junction(WALL, (FACE,), 1)], mesh)
    trace = []
    for k in range(1, round(DURATION / mesh.step_time) + 1):
        time = k * mesh.step_time
        swell = np.sin(0.5 * np.pi * min(1.0, time / RISE)) ** 4
        chain.step(source + swell * AMPLITUDE * np.sin(2.0 * np.pi * TONE * time), SPEED)
        trace.append(chain.end_pressure(FACE))
    return np.array(trace), mesh.step_time, SPEED / float(chain.model.spacing[1])


def spectrum(trace: np.ndarray, step_time: float) -> tuple[np.ndarray, np.ndarray]:
    """Return (frequencies [Hz], amplitudes), through a window whose skirts are below 1e-9."""
    settled = trace[round(1.2 * RISE / step_time):]
    window = np.kaiser(len(settled), 20.0)
    tapered = (settled - settled.mean()) * window / window.sum()
    return np.fft.rfftfreq(len(settled), step_time), 2.0 * np.abs(np.fft.rfft(tapered))


def lines(interpolation: str) -> dict[str, tuple[float, float]]:
    """Return (height in parts of the tone, height over the neighbourhood's median) by line."""
    trace, step_time, crossing = face_pressure(interpolation)
    frequency, amplitude = spectrum(trace, step_time)
    found = {}
    for name, place in (('v/dx', crossing), ('v/dx - tone', crossing - TONE),
                        ('v/dx + tone', crossing + TONE)):
        distance = np.abs(frequency - place)
        height = float(amplitude[distance < 10.0].max())
        around = float(np.median(amplitude[(distance > 40.0) & (distance < 80.0)]))
        found[name] = height / float(amplitude.max()), height / around
    return found


def cell_crossing() -> list[Row]:
    """Look for lines where the mesh would put them."""
    rows = []
    for name, (height, excess) in lines('cubic').items():
        rows.append(Row('cell_crossing', f'line at {name}', 'of the tone', 0.0, height, BAR,
                        False, 'skirts of the window are below 1e-9'))
        if name == 'v/dx':
            rows.append(Row(
                'cell_crossing', f'line at {name} over its neighbourhood', '-', 1.0, excess, 2.0,
                False, 'scatter of the neighbourhood about its median'))
    return rows


def draw_cell_crossing(figure) -> None:
    """Draw the spectrum, with first-order interpolation as what the lines would look like."""
    axes = figure.subplots()
    for interpolation, style in (
            ('linear', {'color': ORANGE, 'linewidth': 1.0, 'alpha': 0.8,
                        'label': 'first-order interpolation, for comparison'}),
            ('cubic', {**SOLVER, 'label': 'solver (cubic interpolation)'})):
        trace, step_time, crossing = face_pressure(interpolation)
        frequency, amplitude = spectrum(trace, step_time)
        axes.plot(frequency, amplitude / amplitude.max(), **style)
    for name, place in (('tone', TONE), ('2 tone', 2.0 * TONE), ('3 tone', 3.0 * TONE),
                        ('v/dx', crossing), ('v/dx\n- tone', crossing - TONE),
                        ('v/dx\n+ tone', crossing + TONE)):
        axes.axvline(place, color='#c3c9cf', linewidth=0.8, zorder=0)
        axes.annotate(name, (place, 1.0), xycoords=('data', 'axes fraction'), ha='center',
                      va='bottom', fontsize=8)
    bar(axes, BAR, label='tolerance of a line')
    axes.set_yscale('log')
    axes.set_xlim(0.0, 1200.0)
    axes.set_ylim(1e-12, 3.0)
    axes.set_xlabel('frequency [Hz]')
    axes.set_ylabel('pressure at the face, over the tone')
    axes.grid(True)
    axes.legend(loc='upper right')


CASES = {
    'cell_crossing': Case(cell_crossing, 'no line where a face crosses cells',
                          figure=draw_cell_crossing),
}
