# SPDX-License-Identifier: Apache-2.0
"""CSV files that people write: read whole, refused with file, line and culprit."""

import csv
import math
from pathlib import Path

from hydra_actuator.errors import InputError

LONGEST_QUOTE = 40


def read_csv(path: Path, needs: str) -> list[tuple[int, list[str]]]:
    """
    Return (line, cells) of a file's lines that are not blank, the header first.

    needs: what an empty file lacks. Raises InputError.
    """
    try:
        with path.open(newline='', encoding='utf-8-sig') as file:
            rows = list(csv.reader(file))
    except OSError as error:
        raise InputError(f'{path} cannot be read: {error.strerror or error}') from None
    except (UnicodeDecodeError, csv.Error):
        raise InputError(f'{path} cannot be read: it is no CSV text') from None
    if not rows:
        raise InputError(f'{path} is empty; it needs the header {needs} and rows')
    return [(line, row) for line, row in enumerate(rows, 1)
            if line == 1 or any(cell.strip() for cell in row)]


def number(text: str, what: str) -> float:
    """Return a finite number; raises InputError that begins with `what`."""
    try:
        # float() takes 1_000, which in a file is more likely a slip.
        value = float(text.replace('_', '?'))
    except ValueError:
        raise InputError(f'{what} {short(text)} is not a number') from None
    if not math.isfinite(value):
        raise InputError(f'{what} {short(text)} is not finite')
    return value


def short(text: str) -> str:
    """Return a text in quotes, cut to what a message can hold."""
    return repr(text if len(text) <= LONGEST_QUOTE else f'{text[:LONGEST_QUOTE]}...')
