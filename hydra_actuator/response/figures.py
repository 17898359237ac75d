# SPDX-License-Identifier: Apache-2.0
"""
The pictures of a study: Bode figures of velocity and pressure, stiffness, the valve about null.

Distributed plant in full lines, the lumped one dashed, the solver's sines as circles.
"""

from pathlib import Path

from hydra_actuator.analysis.palette import BLUE, GREEN, INK, ORANGE, PURPLE, VERMILION
from hydra_actuator.errors import InputError
from hydra_actuator.response.study import Study
from hydra_actuator.response.valve_curves import valve_curves
import numpy as np

DOTS_PER_INCH = 130
STYLE = {
    'font.family': 'sans-serif', 'font.size': 9, 'axes.spines.top': False,
    'axes.spines.right': False, 'axes.linewidth': 0.8, 'axes.edgecolor': '#59636e',
    'xtick.color': '#3b444c', 'ytick.color': '#3b444c', 'axes.labelcolor': '#1c2126',
    'axes.grid': True, 'grid.color': '#dde1e5', 'grid.linewidth': 0.6, 'lines.linewidth': 1.4,
    'legend.frameon': False, 'legend.fontsize': 8, 'figure.facecolor': 'white',
}
LUMPED = {'color': INK, 'linestyle': (0, (4, 3)), 'linewidth': 1.0}
CIRCLES = {'linestyle': 'none', 'marker': 'o', 'markersize': 4.5, 'markerfacecolor': 'none'}
# The null region shown beyond overlap and underlap, of the stroke.
AROUND_NULL, LEAST_REACH = 2.5, 0.05
LITRES_PER_MINUTE = 6e4
# Of a line that another may cover.
WIDE = 2.6


def write_figures(study: Study, directory: Path) -> list[Path]:
    """
    Write the figures into a directory, replacing earlier ones, and return their paths.

    A response that is zero has no Bode figure. Raises InputError where a file cannot be written.
    """
    from matplotlib import rc_context
    from matplotlib.figure import Figure

    figures = {'stiffness': draw_stiffness, 'valve_null': draw_valve}
    if np.abs(study.distributed.velocity).max() > 0.0:
        figures = {'bode_velocity': draw_velocity, 'bode_pressure': draw_pressure, **figures}
    paths = []
    with rc_context(STYLE):
        for name, draw in figures.items():
            figure = Figure(figsize=(8.0, 5.6), layout='constrained')
            draw(figure, study)
            paths.append(directory / f'{name}.png')
            try:
                figure.savefig(paths[-1], dpi=DOTS_PER_INCH)
            except OSError as error:
                raise InputError(f'cannot write {paths[-1]}: {error.strerror}') from error
    return paths


def draw_velocity(figure, study: Study) -> None:
    """Draw gain and phase from spool to piston velocity."""
    gain, phase = figure.subplots(2, 1, sharex=True)
    _curves(gain, phase, study, 'velocity', BLUE, 'distributed')
    if study.point.parameters['valve.natural_frequency'] > 0.0:
        f = study.distributed.frequency
        _line(gain, phase, f, study.distributed.velocity * study.dynamics,
              {'color': ORANGE, 'label': 'distributed, from the command'})
        _fit(phase)
    _mark_modes(gain, study)
    gain.set_ylabel('piston velocity over spool [1/s]')
    gain.set_title(_title('Spool to piston velocity', study), loc='left', fontsize=10)
    gain.legend(loc='lower left')


def draw_pressure(figure, study: Study) -> None:
    """Draw gain and phase from spool to the pressures at both faces and the load pressure."""
    gain, phase = figure.subplots(2, 1, sharex=True)
    for name, colour, label in (('pressure_1', BLUE, 'face 1 (E)'),
                                ('pressure_2', VERMILION, 'face 2 (F)'),
                                ('load_pressure', GREEN, 'load pressure')):
        _curves(gain, phase, study, name, colour, label, WIDE if name == 'pressure_1' else 1.4)
    gain.set_ylabel('pressure over spool [Pa/m]')
    gain.set_title(_title('Spool to pressure', study), loc='left', fontsize=10)
    gain.legend(loc='best', ncols=2)


def draw_stiffness(figure, study: Study) -> None:
    """Draw the dynamic stiffness: load force over the position it gives."""
    gain, phase = figure.subplots(2, 1, sharex=True)
    _curves(gain, phase, study, 'stiffness', PURPLE, 'distributed')
    stiffness = study.lumped_plant.oil_stiffness + study.lumped_plant.stiffness
    gain.axhline(stiffness, color=INK, linewidth=0.8, linestyle=':')
    gain.annotate(f'oil and spring at rest {stiffness:.4g} N/m', (0.01, stiffness),
                  xycoords=('axes fraction', 'data'), xytext=(0, 3), textcoords='offset points',
                  fontsize=8, color=INK)
    gain.set_ylabel('load force over position [N/m]')
    gain.set_title(_title('Dynamic stiffness', study), loc='left', fontsize=10)
    gain.legend(loc='upper left')


def draw_valve(figure, study: Study) -> None:
    """Draw flow gain, pressure gain and leakage about null, and flow over load pressure."""
    bench, null = study.bench, study.null
    reach = min(1.0, max(LEAST_REACH, AROUND_NULL * max(abs(null.low), abs(null.high))))
    curves = valve_curves(bench, reach)
    x = 100.0 * curves.spool
    (flow, pressure), (leakage, load) = figure.subplots(2, 2)
    flow.plot(x, LITRES_PER_MINUTE * curves.flow, color=BLUE)
    flow.set_ylabel('no-load flow [l/min]')
    flow.set_title(f'flow gain, K_q0 = {null.flow_gain:.4g} m²/s', loc='left', fontsize=9)
    for values, colour, label in ((curves.pressure_1, BLUE, 'port A'),
                                  (curves.pressure_2, VERMILION, 'port B'),
                                  (curves.load_pressure, GREEN, 'load (A - B)')):
        pressure.plot(x, values / 1e6, color=colour, label=label,
                      linewidth=WIDE if label == 'port A' else 1.4)
    pressure.set_ylabel('blocked ports [MPa]')
    pressure.set_title(_pressure_gain(null.pressure_gain), loc='left', fontsize=9)
    pressure.legend(loc='best')
    leakage.plot(x, LITRES_PER_MINUTE * curves.leakage, color=ORANGE)
    leakage.set_ylabel('leakage, ports blocked [l/min]')
    leakage.set_title(f'leakage, {LITRES_PER_MINUTE * null.leakage:.4g} l/min at null',
                      loc='left', fontsize=9)
    leakage.set_ylim(0.0, 1.1 * LITRES_PER_MINUTE * curves.leakage.max() or 1.0)
    for axes in (flow, pressure, leakage):
        axes.set_xlabel('spool [% of stroke]')
        if null.region != 'none':
            axes.axvspan(100 * null.low, 100 * null.high, color='#eef1f4', zorder=0)
    if null.region != 'none':
        flow.annotate(f'{null.region} {100 * null.low:+.3g} to {100 * null.high:+.3g} %',
                      (0.03, 0.9), xycoords='axes fraction', fontsize=8, color=INK)
    _draw_load_flow(load, study, reach)


def _pressure_gain(gain: float) -> str:
    value = 'infinite' if np.isinf(gain) else f'{gain:.4g} Pa/m'
    return f'pressure gain, K_p0 = {value}'


def _draw_load_flow(axes, study: Study, reach: float) -> None:
    """Draw the flow over load pressure at spools about null."""
    bench = study.bench
    load = np.linspace(-bench.span, bench.span, 401)
    for share, colour in zip((-1.0, -0.5, 0.0, 0.5, 1.0), (VERMILION, ORANGE, INK, GREEN, BLUE)):
        flow = bench.load_flow(np.full(load.shape, share * reach), load)
        axes.plot(load / 1e6, LITRES_PER_MINUTE * flow, color=colour,
                  label=f'{100 * share * reach:+.3g} %' if share else '0 %')
    axes.set_xlabel('load pressure [MPa]')
    axes.set_ylabel('load flow [l/min]')
    axes.set_title('flow over load pressure, spool as marked', loc='left', fontsize=9)
    axes.legend(loc='center left', bbox_to_anchor=(1.0, 0.5), handlelength=1.2)


def _curves(gain, phase, study: Study, name: str, colour: str, label: str,
            width: float = 1.4) -> None:
    """Draw one quantity of all three models."""
    exact = study.distributed
    first = 'lumped' not in gain.get_legend_handles_labels()[1]
    _line(gain, phase, exact.frequency, getattr(exact, name), {
        'color': colour, 'label': label, 'linewidth': width})
    lumped = getattr(study.lumped, name)
    if np.isfinite(lumped).all():
        _line(gain, phase, exact.frequency, lumped, {
            **LUMPED, 'color': INK if label == 'distributed' else colour,
            'label': 'lumped' if first else None})
    if study.solver is not None:
        _line(gain, phase, study.solver.frequency, getattr(study.solver, name), {
            **CIRCLES, 'color': colour, 'label': 'solver' if first else None},
            (exact.frequency, getattr(exact, name)))
    gain.set_xscale('log')
    gain.set_yscale('log')
    phase.set_xlabel('frequency [Hz]')
    phase.set_ylabel('phase [deg]')
    phase.set_yticks(np.arange(-720, 721, 90))
    _fit(phase)


def _fit(phase) -> None:
    """Let an axis of phases show all of its curves."""
    angles = np.concatenate([line.get_ydata() for line in phase.lines])
    phase.set_ylim(np.nanmin(angles) - 20.0, np.nanmax(angles) + 20.0)


def _line(gain, phase, frequency: np.ndarray, values: np.ndarray, look: dict,
          beside: tuple[np.ndarray, np.ndarray] | None = None) -> None:
    """
    Draw a complex response, its phase unwrapped.

    beside: frequencies and values of a dense response whose turn the phase takes instead.
    """
    size = np.abs(values)
    gain.plot(frequency, np.where(size > 0.0, size, np.nan), **look)
    angle = np.unwrap(np.angle(values))
    if beside is not None:
        turn = np.interp(frequency, beside[0], np.unwrap(np.angle(beside[1])))
        angle = np.angle(values)
        angle += 2.0 * np.pi * np.round((turn - angle) / (2.0 * np.pi))
    phase.plot(frequency, np.degrees(angle), **look)


def _mark_modes(axes, study: Study) -> None:
    if study.mode is not None:
        axes.axvline(study.mode.frequency, color=INK, linewidth=0.8, linestyle=':')
        axes.annotate(
            f'{study.mode.frequency:.4g} Hz, damping {study.mode.damping:.3g}',
            (study.mode.frequency, 0.98), xycoords=('data', 'axes fraction'), xytext=(4, 0),
            textcoords='offset points', fontsize=8, va='top', color=INK)


def _title(text: str, study: Study) -> str:
    p = study.point.parameters
    spools = ', '.join(f'{x / p["valve.stroke"]:g}'
                       for x in study.point.spools[:p['valve.spools']])
    return (f'{text} at spool {spools}, load {study.point.load:g} N, '
            f'position {study.point.position:.3g} m')
