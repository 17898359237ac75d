# SPDX-License-Identifier: Apache-2.0
"""The report of a sweep: one self-contained page, in the style of a recording's."""

from collections import Counter
from pathlib import Path

from hydra_actuator.analysis.page import page
from hydra_actuator.analysis.report import check_output, write_page
from hydra_actuator.parameters import PARAMETERS
from hydra_actuator.sweep import figures
from hydra_actuator.sweep.results import load_results, Results
import numpy as np

REASONS_SHOWN = 20


def write_report(directory: str | Path, output: str | Path) -> Path:
    """
    Write the page about a sweep's directory and return its path.

    An earlier report at `output` is replaced; any other file there is refused by InputError, and
    so is a directory without results.
    """
    output = Path(output)
    check_output(output)
    return write_page(output, report_page(load_results(directory)))


def report_page(results: Results) -> str:
    """Return the page."""
    drawn = [figures.parallel(results), figures.correlations(results),
             figures.sobol_indices(results), figures.scatters(results),
             figures.failed_runs(results)]
    left = results.asked - len(results.runs) - len(results.failed)
    warnings = [f'{left} of {results.asked} runs are not done yet'] if left else []
    subtitle = (f'{len(results.runs)} runs done, {len(results.failed)} failed; '
                f'{results.told["method"]}; {results.told["drive"]}, '
                f'{results.told["duration"]:g} s')
    return page(f'Sweep {results.name}', subtitle, drawn, _tables(results), warnings)


def _tables(results: Results) -> list[tuple]:
    told = results.told
    facts = [('factors', '; '.join(told['factors'])), ('method', told['method']),
             ('seed', str(told['seed'])), ('drive', told['drive']),
             ('duration', f'{told["duration"]:g} s'),
             ('figures count from', f'{told["from"]:g} s'), ('looked at', f'{told["rate"]:g} Hz')]
    fixed = [(name, f'{value} {_unit(name)}'.strip())
             for name, value in told['parameters'].items()]
    tables = [('Figures, lowest / median / highest', '', _spans(results)),
              ('The sweep', '', facts),
              ('Parameters of all runs that differ from the defaults',
               '' if fixed else 'None.', fixed)]
    if results.failed:
        counts = Counter(one.status for one in results.failed)
        note = ', '.join(f'{count} {kind}' for kind, count in counts.items())
        tables.append(('Runs that failed', note, [
            (f'run {one.run}: {one.status}', one.reason)
            for one in results.failed[:REASONS_SHOWN]]))
    return tables


def _spans(results: Results) -> list[tuple[str, str]]:
    rows = []
    for column in results.figures:
        finite = column.values[np.isfinite(column.values)]
        if len(finite):
            parts = ' / '.join(f'{part:.4g}' for part in np.quantile(finite, (0.0, 0.5, 1.0)))
            rows.append((column.name, f'{parts} {column.unit}'.strip()))
    return rows


def _unit(name: str) -> str:
    unit = PARAMETERS[name].unit if name in PARAMETERS else ''
    return '' if unit == '1' else unit
