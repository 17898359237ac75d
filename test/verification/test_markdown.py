# SPDX-License-Identifier: Apache-2.0
"""The README and docs/verify.md tell the cases there are, their tolerances, and what came out."""

from dataclasses import replace
import math
from pathlib import Path

from hydra_actuator.errors import Failure
from hydra_actuator.verification.case import Case, Row
from hydra_actuator.verification.markdown import (
    BEGIN,
    complete,
    END,
    Outcome,
    outcome,
    summary,
    tolerance,
    with_summary,
)
from hydra_actuator.verification.registry import CASES
import pytest

ROOT = Path(__file__).parents[2]
STALE = 'run make tables'
ROW = Row('made_up', 'rise', 'Pa', 200.0, 201.0, 0.01, True, 'made up')
SPEEDS = [pytest.param(name, marks=[pytest.mark.soak] if case.speed == 'slow' else [])
          for name, case in CASES.items()]


def cells(line):
    """Return the cells of a row of a Markdown table."""
    bare = line.replace('\\|', '\0').strip().strip('|')
    return [cell.strip().replace('\0', '|') for cell in bare.split('|')]


def readme_rows():
    """Return the rows of the README's table, without its head."""
    text = (ROOT / 'README.md').read_text(encoding='utf-8')
    return [cells(line) for line in text.split(BEGIN)[1].split(END)[0].strip().splitlines()[2:]]


def page_rows():
    """Return from docs/verify.md: by case (title, rows without their head)."""
    parts = (ROOT / 'docs' / 'verify.md').read_text(encoding='utf-8').split('\n## `')[1:]
    found = {}
    for part in parts:
        head, *lines = part.strip().splitlines()
        name, title = head.split('`: ', 1)
        found[name] = title, [cells(line) for line in lines[3:]]
    return found


def number(text):
    return float(text.split()[0])


def test_readme_lists_the_cases_there_are():
    listed = [(row[0].strip('`'), row[1]) for row in readme_rows()]
    assert listed == [(name, case.title) for name, case in CASES.items()], STALE


def test_page_lists_the_cases_there_are():
    listed = [(name, title) for name, (title, _) in page_rows().items()]
    assert listed == [(name, case.title) for name, case in CASES.items()], STALE


def test_what_the_readme_shows_of_a_case_is_on_the_page():
    page = page_rows()
    for name, _, count, quantity, expected, got, bar, verdict in readme_rows():
        rows = page[name.strip('`')][1]
        (row,) = (row for row in rows if row[0] == quantity)
        assert int(count) == len(rows)
        assert (expected, bar) == (row[1], row[4])
        assert number(got) == pytest.approx(number(row[2]), rel=1e-5)
        assert verdict == 'ok'


def test_all_that_is_listed_is_within_tolerance():
    for name, (_, rows) in page_rows().items():
        assert rows, name
        for row in rows:
            assert row[-1] == 'ok', (name, row)
            assert number(row[3]) <= 1.05 * number(row[4])


@pytest.mark.parametrize('name', SPEEDS)
def test_page_shows_quantities_and_tolerances_as_computed(name):
    rows, listed = CASES[name].rows(), page_rows()[name][1]
    assert [row.quantity for row in rows] == [line[0] for line in listed], STALE
    for row, line in zip(rows, listed):
        assert (tolerance(row), row.reason) == (line[4], line[5]), STALE
        assert replace(row, got=number(line[1])).passed or row.expected == pytest.approx(
            number(line[1]), rel=1e-7), STALE
        # half of the last digit that is printed may be beyond
        rounding = 1e-7 * abs(row.got) / (abs(row.expected) if row.relative else 1.0)
        assert replace(row, got=number(line[2]), tolerance=row.tolerance + rounding).passed, STALE


def test_summary_shows_the_quantity_nearest_to_its_tolerance():
    near = replace(ROW, quantity='fall', got=201.9)
    line = summary({'made_up': Outcome('a case', (ROW, near))}).splitlines()[2]
    assert cells(line) == ['`made_up`', 'a case', '2', 'fall', '200 Pa', '201.9',
                           '0.01 relative', 'ok']


@pytest.mark.parametrize('got', [300.0, math.nan])
def test_a_missed_quantity_fails_its_case(got):
    line = summary({'made_up': Outcome('a case', (ROW, replace(ROW, got=got)))}).splitlines()[2]
    assert cells(line)[-1] == 'FAILED'


def test_a_case_that_breaks_off_is_told():
    def rows():
        raise Failure('NaN in line')

    found = {'made_up': outcome(Case(rows, 'a case'))}
    assert 'NaN in line' in summary(found)
    assert 'FAILED: NaN in line' in complete(found)


def test_bars_in_a_quantity_do_not_break_the_table():
    line = summary({'made_up': Outcome('a case', (replace(ROW, quantity='q|q|'),))})
    assert cells(line.splitlines()[2])[3] == 'q|q|'


def test_a_text_without_marks_is_refused():
    with pytest.raises(ValueError, match='no marks'):
        with_summary('nothing', {})
