# SPDX-License-Identifier: Apache-2.0
"""Files of pictures: refused before any work, written whole or not at all."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
import os
from pathlib import Path

from hydra_actuator.errors import InputError


def check_picture(output: str | Path, suffixes: Sequence[str]) -> Path:
    """Return the path of a picture that can be written; raises InputError."""
    path = Path(output)
    if path.suffix not in suffixes:
        raise InputError(f'{path} ends in none of {", ".join(suffixes)}')
    if path.is_dir():
        raise InputError(f'{path} is a directory, not a file for the picture')
    if not path.parent.is_dir():
        raise InputError(f'no directory {path.parent} for the picture')
    return path


@contextmanager
def write_whole(path: Path) -> Iterator[Path]:
    """
    Give the path of a draft beside a file, and put it in the file's place at the end.

    Whatever is raised meanwhile, Ctrl-C included, the draft goes and an earlier file stays.
    Raises InputError where nothing can be written.
    """
    draft = path.with_name(f'.{path.stem}.{os.getpid()}{path.suffix}')
    try:
        yield draft
        os.replace(draft, path)
    except OSError as error:
        raise InputError(f'cannot write {path}: {error.strerror}') from error
    finally:
        draft.unlink(missing_ok=True)
