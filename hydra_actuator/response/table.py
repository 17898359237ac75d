# SPDX-License-Identifier: Apache-2.0
"""A study as lines of text, and as CSV."""

import csv
import math
from pathlib import Path

from hydra_actuator.errors import InputError
from hydra_actuator.response.distributed import Responses
from hydra_actuator.response.modes import Mode
from hydra_actuator.response.study import Study
import numpy as np

QUANTITIES = (
    ('velocity', '1/s'), ('pressure_1', 'Pa/m'), ('pressure_2', 'Pa/m'),
    ('load_pressure', 'Pa/m'), ('stiffness', 'N/m'))
NAMES = ('distributed', 'solver', 'lumped', "Merritt's formula")
MOST_MODES = 6


def table(study: Study) -> list[str]:
    """Return the lines that the command prints."""
    point, null, low = study.point, study.null, study.lumped_plant
    stroke = point.parameters['valve.stroke']
    lines = ['operating point']
    lines += _rows([
        ('spool', ', '.join(f'{x / stroke:g}' for x in _spools(study)), 'of its stroke'),
        ('load', f'{point.load:g}', 'N'), ('position', f'{round(point.position, 12):.6g}', 'm'),
        ('velocity', f'{point.velocity:.5g}', 'm/s'),
        ('pressure O, A, J', _megapascals(point.pump, point.at_a, point.at_j), 'MPa'),
        ('pressure B, E, F, I', _megapascals(
            point.network[5], point.face_1, point.face_2, point.network[6]), 'MPa'),
        ('flow drawn from the pump', f'{6e4 * (point.network[0] + point.network[1]):.5g}',
         'l/min')])
    lines += ['', 'gains at the operating point']
    lines += _rows([
        ('flow gain K_q', _number(low.load_flow_gain), 'm^2/s'),
        ('flow-pressure coefficient K_c', _number(low.flow_pressure), 'm^3/(s Pa)'),
        ('pressure gain K_p = K_q/K_c', _number(low.pressure_gain), 'Pa/m'),
        ('stiffness of the oil, sum A^2/C', _number(low.oil_stiffness), 'N/m')])
    lines += ['', 'valve about null, supply to tank at its ports']
    lines += _rows([
        ('flow gain K_q0', _number(null.flow_gain), 'm^2/s'),
        ('pressure gain K_p0', _number(null.pressure_gain), 'Pa/m'),
        ('flow-pressure coefficient K_c0', _number(null.flow_pressure), 'm^3/(s Pa)'),
        ('leakage at null', f'{6e4 * null.leakage:.5g}', 'l/min'),
        ('largest leakage', f'{6e4 * null.most_leakage:.5g}', 'l/min'),
        (f'{null.region} region' if null.region != 'none' else 'overlap region', _region(null),
         '% of stroke')])
    if point.parameters['valve.spools'] == 2:
        lines += _rows([
            (f'flow gain of spool {k + 1} alone, port {name}',
             _number(study.bench.port_gain(k)), 'm^2/s, half way between the pressures')
            for k, name in enumerate('AB')])
    return [*lines, '', *_comparison(study), *(f'note: {note}' for note in study.notes)]


def write_csv(study: Study, path: Path) -> None:
    """Write frequency and complex responses, distributed and lumped, then the solver's."""
    header = ['model', 'frequency [Hz]']
    for name, unit in QUANTITIES:
        header += [f'{name} real [{unit}]', f'{name} imaginary [{unit}]']
    header += ['spool over command real [-]', 'spool over command imaginary [-]']
    try:
        with open(path, 'w', newline='', encoding='utf-8') as file:
            writer = csv.writer(file)
            writer.writerow(header)
            for model, responses in (('distributed', study.distributed),
                                     ('lumped', study.lumped), ('solver', study.solver)):
                if responses is not None:
                    dynamics = np.interp(responses.frequency, study.distributed.frequency,
                                         study.dynamics)
                    writer.writerows(_csv_rows(model, responses, dynamics))
    except OSError as error:
        raise InputError(f'cannot write {path}: {error.strerror}') from error


def _csv_rows(model: str, responses: Responses, dynamics: np.ndarray):
    values = np.array([getattr(responses, name) for name, _ in QUANTITIES] + [dynamics]).T
    for frequency, row in zip(responses.frequency, values):
        pairs = [repr(float(part)) for value in row for part in (value.real, value.imag)]
        yield [model, repr(float(frequency)), *pairs]


def _comparison(study: Study) -> list[str]:
    """Return the modes and gains side by side."""
    modes = (study.mode, study.solver_mode, study.lumped_mode, study.textbook)
    at = _at_mode(study)
    cells = [('', *NAMES),
             ('natural frequency [Hz]', *(_of(mode, 'frequency', '.5g') for mode in modes)),
             ('damping ratio', *(_of(mode, 'damping', '.4g') for mode in modes)),
             (f'velocity gain at {study.distributed.frequency[0]:g} Hz [1/s]',
              _number(abs(study.distributed.velocity[0])), '-',
              _number(abs(study.lumped.velocity[0])), '-'),
             (f'velocity gain at {study.distributed.frequency[-1]:g} Hz [1/s]',
              _number(abs(study.distributed.velocity[-1])), at,
              _number(abs(study.lumped.velocity[-1])), '-'),
             ('largest gain of a position loop [m/m]', _number(study.gains[0]), '-',
              _number(study.gains[1]), '-')]
    widths = [max(len(row[k]) for row in cells) for k in range(5)]
    lines = [f'  {name:<{widths[0]}}' + ''.join(
        f'  {cell:>{width}}' for cell, width in zip(rest, widths[1:])) for name, *rest in cells]
    others = [m for m in study.modes if m != study.mode][:MOST_MODES]
    if others:
        lines.append('  further modes up to '
                     f'{study.distributed.frequency[-1]:g} Hz, waves in lines and chambers: '
                     + ', '.join(
                         f'{m.frequency:.4g} Hz ({max(0.0, m.damping):.2g})' for m in others))
    if study.solver is not None:
        lines.append(f'  solver from the distributed plant at most {_worst(study):.2g} '
                     f'in velocity and stiffness, {study.solver.frequency[0]:.4g} to '
                     f'{study.solver.frequency[-1]:.4g} Hz; with the amplitude it changes by '
                     f'{study.linearity:.1g}')
    return ['frequency response (spool to piston velocity), natural frequency and damping', *lines]


def _worst(study: Study) -> float:
    """Return the largest relative distance of the solver from the distributed plant."""
    from hydra_actuator.response.distributed import respond

    exact, worst = respond(study.plant, study.solver.frequency), 0.0
    for name in ('velocity', 'stiffness'):
        wanted, got = getattr(exact, name), getattr(study.solver, name)
        if np.abs(wanted).min() > 0.0:
            worst = max(worst, float(np.abs(got / wanted - 1.0).max()))
    return worst


def _at_mode(study: Study) -> str:
    if study.solver is None or not np.abs(study.distributed.velocity).max() > 0.0:
        return '-'
    return _number(abs(study.solver.velocity[-1]))


def _spools(study: Study) -> tuple[float, ...]:
    return study.point.spools[:study.point.parameters['valve.spools']]


def _rows(rows: list[tuple[str, str, str]]) -> list[str]:
    return [f'  {name:<34}  {value:>26}  {unit}' for name, value, unit in rows]


def _megapascals(*pressures: float) -> str:
    return ', '.join(f'{p / 1e6:.5g}' for p in pressures)


def _region(null) -> str:
    if null.region == 'none':
        return '0'
    return f'{100 * null.low:+.4g} to {100 * null.high:+.4g}'


def _number(value: float) -> str:
    if math.isnan(value):
        return '-'
    return 'infinite' if math.isinf(value) else f'{value:.5g}'


def _of(mode: Mode | None, field: str, digits: str) -> str:
    value = math.nan if mode is None else float(getattr(mode, field))
    if math.isnan(value):
        return '-'
    return 'infinite' if math.isinf(value) else f'{value:{digits}}'
