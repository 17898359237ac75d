# SPDX-License-Identifier: Apache-2.0
"""
The tables of all cases: one row a case for the README, one row a quantity for docs/verify.md.

`python -m hydra_actuator.verification.markdown README.md docs/verify.md` computes all cases,
writes the one table between its two marks and the other file anew.
"""

from dataclasses import dataclass
from pathlib import Path
import sys

from hydra_actuator.errors import Failure
from hydra_actuator.verification.case import Case, Row, worst

BEGIN, END = '<!-- verify -->', '<!-- /verify -->'

_SUMMARY_HEAD = ('case', 'what', 'quantities', 'nearest to its tolerance', 'expected', 'got',
                 'tolerance', '')
_HEAD = ('quantity', 'expected', 'got', 'error', 'tolerance', 'why this tolerance', '')
_TITLE = '# Cases with known answers'
_INTRODUCTION = """\
Written by `make tables` from what `hydra_actuator verify` computes; `hydra_actuator verify
--plots DIR` draws each case. The last digits differ from machine to machine."""


@dataclass(frozen=True)
class Outcome:
    """What a case gave: its title and rows, or how it broke off."""

    title: str
    rows: tuple[Row, ...]
    broken: str = ''


def outcome(case: Case) -> Outcome:
    """Compute a case; a solver that breaks off is an outcome too."""
    try:
        return Outcome(case.title, tuple(case.rows()))
    except Failure as failure:
        return Outcome(case.title, (), str(failure))


def summary(outcomes: dict[str, Outcome]) -> str:
    """Return one Markdown table, one row a case: the quantity nearest to its tolerance."""
    lines = []
    for name, found in outcomes.items():
        cells = [f'`{name}`', found.title, str(len(found.rows))]
        if not found.rows:
            lines.append([*cells, found.broken or 'no quantity', '', '', '', 'FAILED'])
            continue
        row = worst(found.rows)
        passed = all(row.passed for row in found.rows)
        lines.append([*cells, row.quantity, with_unit(row, row.expected), f'{row.got:.6g}',
                      tolerance(row), 'ok' if passed else 'FAILED'])
    return _table(_SUMMARY_HEAD, lines)


def complete(outcomes: dict[str, Outcome]) -> str:
    """Return a Markdown page with a table of each case, one row a quantity."""
    parts = [_TITLE, _INTRODUCTION]
    for name, found in outcomes.items():
        parts.append(f'## `{name}`: {found.title}')
        parts.append(_table(_HEAD, [
            (row.quantity, with_unit(row, row.expected), f'{row.got:.8g}', f'{row.error:.2g}',
             tolerance(row), row.reason, 'ok' if row.passed else 'FAILED')
            for row in found.rows]) if found.rows else f'FAILED: {found.broken or "no quantity"}')
    return '\n\n'.join(parts) + '\n'


def with_summary(text: str, outcomes: dict[str, Outcome]) -> str:
    """Return the text with the table between its marks; raises ValueError without marks."""
    before, begin, rest = text.partition(BEGIN)
    _, end, after = rest.partition(END)
    if not (begin and end):
        raise ValueError(f'no marks {BEGIN} and {END}')
    return f'{before}{BEGIN}\n{summary(outcomes)}\n{END}{after}'


def tolerance(row: Row) -> str:
    """Return the tolerance with its measure."""
    if not row.relative:
        return f'{row.tolerance:.2g} {row.unit}'.removesuffix(' -')
    return f'{row.tolerance:.2g} relative'


def with_unit(row: Row, value: float) -> str:
    """Return a value with the row's unit."""
    return f'{value:.8g} {row.unit}'.removesuffix(' -')


def _table(head: tuple[str, ...], lines) -> str:
    rows = [head, ['---'] * len(head), *lines]
    return '\n'.join(
        '| ' + ' | '.join(cell.replace('|', '\\|') for cell in row) + ' |' for row in rows)


def main() -> None:
    """Compute all cases; write the README and the page named on the command line."""
    from hydra_actuator.verification.registry import CASES

    readme, page = map(Path, sys.argv[1:3])
    outcomes = {}
    for name, case in CASES.items():
        print(name, file=sys.stderr, flush=True)
        outcomes[name] = outcome(case)
    readme.write_text(with_summary(readme.read_text(encoding='utf-8'), outcomes),
                      encoding='utf-8')
    page.write_text(complete(outcomes), encoding='utf-8')


if __name__ == '__main__':
    main()
