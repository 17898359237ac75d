# SPDX-License-Identifier: Apache-2.0
"""Directories that are to be made: refused before long work for them begins."""

import os
from pathlib import Path

from hydra_actuator.errors import InputError


def refuse_output(output: str, may_be_empty: bool = False) -> None:
    """
    Raise InputError for what cannot become a directory.

    may_be_empty: accept a directory that is there already, writable and with nothing in it.
    """
    path = Path(os.path.abspath(output))
    if may_be_empty and path.is_dir():
        _refuse_unless_empty(path)
        return
    if os.path.lexists(path):
        raise InputError(f'{path} exists already, and nothing is overwritten')
    parent = next(parent for parent in path.parents if os.path.lexists(parent))
    if not os.path.isdir(parent):
        raise InputError(f'{path} cannot be made: {parent} is not a directory')
    if not os.access(parent, os.W_OK | os.X_OK):
        raise InputError(f'{path} cannot be made: {parent} is not writable')


def _refuse_unless_empty(path: Path) -> None:
    if not os.access(path, os.R_OK | os.W_OK | os.X_OK):
        raise InputError(f'{path} is not writable')
    if any(path.iterdir()):
        raise InputError(f'{path} is not empty, and nothing is overwritten')
