# SPDX-License-Identifier: Apache-2.0
"""`hydra_actuator verify [NAME ...]`: cases with known answers, expected against got."""

from argparse import ArgumentParser, Namespace
import time

from hydra_actuator.errors import Failure, InputError

SUMMARY = 'the solver against exact solutions and conservation laws'


def add_arguments(parser: ArgumentParser) -> None:
    """Declare the command line."""
    parser.add_argument('cases', nargs='*', metavar='NAME', help='cases to compute; default: all')


def run(arguments: Namespace) -> int:
    """Compute the cases and print them; Failure where a quantity misses its tolerance."""
    from hydra_actuator.verification.registry import CASES

    for name in arguments.cases:
        if name not in CASES:
            raise InputError(f'no case {name!r}; there are {", ".join(CASES)}')
    passed, count = 0, 0
    for name in arguments.cases or CASES:
        case = CASES[name]
        start = time.perf_counter()
        rows = case.rows()
        print(f'{name}: {case.title} ({time.perf_counter() - start:.1f} s)')
        print('\n'.join(table(rows)), flush=True)
        passed += sum(row.passed for row in rows)
        count += len(rows)
    print(f'{passed} of {count} quantities within tolerance')
    if passed < count:
        raise Failure(f'{count - passed} of {count} quantities miss their tolerance')
    return 0


def table(rows) -> list[str]:
    """Return the lines of a table of Rows; a failed one tells the reason of its tolerance."""
    cells = [('', 'expected', 'got', 'error', 'tolerance', '')]
    for row in rows:
        measure = ' relative' if row.relative else f' {row.unit}'.removesuffix(' -')
        cells.append((
            f'{row.quantity} [{row.unit}]', f'{row.expected:.8g}', f'{row.got:.8g}',
            f'{row.error:.2g}', f'{row.tolerance:.2g}{measure}',
            'ok' if row.passed else f'FAILED ({row.reason})'))
    widths = [max(map(len, column)) for column in zip(*cells)]
    return [
        f'  {name:<{widths[0]}}' + ''.join(
            f'  {cell:>{width}}' for cell, width in zip(numbers, widths[1:4]))
        + f'  {tolerance:<{widths[4]}}  {verdict}'.rstrip()
        for name, *numbers, tolerance, verdict in cells]
