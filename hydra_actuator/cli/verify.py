# SPDX-License-Identifier: Apache-2.0
"""`hydra_actuator verify [NAME ...]`: cases with known answers, expected against got."""

from argparse import ArgumentParser, Namespace
from pathlib import Path
import shutil
import sys
import textwrap
import time

from hydra_actuator.cli.output import refuse_output
from hydra_actuator.cli.progress import ProgressBar
from hydra_actuator.errors import Failure, InputError

SUMMARY = 'the solver against exact solutions and conservation laws'
GAP, NARROWEST = 2, 24      # between columns; of the quantities' column, in characters


def add_arguments(parser: ArgumentParser) -> None:
    """Declare the command line."""
    parser.add_argument('cases', nargs='*', metavar='NAME',
                        help='cases to compute; default: all; an unknown name lists them')
    parser.add_argument('--plots', metavar='DIR',
                        help='new or empty directory for a figure of each case, NAME.png')


def run(arguments: Namespace) -> int:
    """Compute the cases, print and draw them; Failure where a quantity misses its tolerance."""
    if arguments.plots is not None:
        refuse_output(arguments.plots, may_be_empty=True)
    from hydra_actuator.verification.registry import CASES

    names = list(dict.fromkeys(arguments.cases)) or list(CASES)
    for name in names:
        if name not in CASES:
            raise InputError(f'no case {name!r}; there are {", ".join(CASES)}')
    draw = _figures_into(arguments.plots) if arguments.plots is not None else None
    passed, count, broken = 0, 0, []
    for index, name in enumerate(names):
        try:
            rows = compute(name, CASES[name], index / len(names), draw)
        except Failure as failure:
            print(f'{name}: {CASES[name].title}\n  FAILED: {failure}', flush=True)
            broken.append(name)
            continue
        passed += sum(row.passed for row in rows)
        count += len(rows)
    print(f'{passed} of {count} quantities within tolerance')
    if draw:
        print(f'{len(names) - len(broken)} figures in {Path(arguments.plots).resolve()}')
    if broken:
        raise Failure(f'{", ".join(broken)}: not computed to the end')
    if passed < count:
        raise Failure(f'{count - passed} of {count} quantities miss their tolerance')
    return 0


def _figures_into(output: str):
    """Make the directory; return the function that draws a case there."""
    from hydra_actuator.verification.plots import require_matplotlib, write_figure

    require_matplotlib()
    directory = Path(output)
    try:
        directory.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(f'{directory} cannot be made: {error.strerror}') from error
    return lambda name, case, rows: write_figure(name, case, rows, directory)


def compute(name: str, case, share: float, draw=None) -> list:
    """Return the rows of a case, drawn and printed; share: of the cases that are done."""
    start = time.perf_counter()
    with ProgressBar(f'verify, at {name}') as progress:
        progress(share)
        rows = case.rows()
        duration = time.perf_counter() - start
        if draw:
            draw(name, case, rows)
    print(f'{name}: {case.title} ({duration:.1f} s)')
    width = shutil.get_terminal_size().columns if sys.stdout.isatty() else 0
    print('\n'.join(table(rows, width)), flush=True)
    return rows


def table(rows, width: int = 0) -> list[str]:
    """
    Return the lines of a table of Rows; a failed one tells the reason of its tolerance.

    width: of the terminal; long quantities are broken to fit. 0: none.
    """
    cells = [('', 'expected', 'got', 'error', 'tolerance', '')]
    for row in rows:
        measure = ' relative' if row.relative else f' {row.unit}'.removesuffix(' -')
        cells.append((
            f'{row.quantity} [{row.unit}]', f'{row.expected:.8g}', f'{row.got:.8g}',
            f'{row.error:.2g}', f'{row.tolerance:.2g}{measure}',
            'ok' if row.passed else f'FAILED ({row.reason})'))
    widths = [max(map(len, column)) for column in zip(*cells)]
    if width:
        others = sum(widths[1:5]) + GAP * 6 + len('FAILED')
        widths[0] = min(widths[0], max(NARROWEST, width - others))
    lines = []
    for name, *numbers, tolerance, verdict in cells:
        *above, name = textwrap.wrap(name, widths[0], subsequent_indent='  ') or ['']
        lines += [f'  {part}' for part in above]
        lines.append(f'  {name:<{widths[0]}}' + ''.join(
            f'  {cell:>{place}}' for cell, place in zip(numbers, widths[1:4]))
            + f'  {tolerance:<{widths[4]}}  {verdict}'.rstrip())
    return lines
