# SPDX-License-Identifier: Apache-2.0
"""
Compiled kernels kept on disk, used only when they are exactly what a fresh compilation gives.

A cache directory's name is a hash of the kernels' sources (numba alone would notice a change of
the entry's own file only), of the versions and of the processor. It is filled in private,
gets a manifest of checksums, and is put in place whole by one rename; a directory whose files do
not match their manifest is thrown away. Without a writable place the kernels are compiled anew.
"""

from collections.abc import Callable, Iterator
from contextlib import contextmanager, ExitStack
import hashlib
import json
import os
from pathlib import Path
import shutil
import sys
import tempfile
import time

import hydra_actuator.core
from hydra_actuator.core.advance import advance
from hydra_actuator.core.observe import observe, read_field
from hydra_actuator.core.records import Model
from hydra_actuator.core.together.advance import advance_together
import llvmlite
import llvmlite.binding
import numba
from numba.core.caching import NullCache
import numpy as np

KERNELS = (advance, observe, read_field, advance_together)
MANIFEST = 'manifest.json'
MOST_KEPT = 24
UNFINISHED = 'new-'
LONGEST_COMPILATION = 3600.0

# What this process has in memory: the caches it once used or filled.
_at_hand: set[str] = set()


@contextmanager
def warm_kernels(passes: int, plain: bool = True) -> Iterator[None]:
    """
    Let the kernels called inside come from the disk, or be compiled and kept there.

    passes: solver iterations, for which `advance` is specialised; plain: whether the model has no
    extras, for which all are. The caller calls each kernel once inside the context, so that
    nothing compiles afterwards.
    """
    with ExitStack() as stack:
        for members, key in _groups(passes, plain):
            stack.enter_context(warm(members, key))
        yield


@contextmanager
def warm_together(passes: int) -> Iterator[None]:
    """Do as `warm_kernels` for `advance_together`, which the caller calls once inside."""
    with warm((advance_together,), cache_key('together', passes)):
        yield


def has_together(passes: int) -> bool:
    """Return whether `advance_together` would come from memory or disk."""
    key = cache_key('together', passes)
    return key in _at_hand or is_intact(cache_root() / key)


def specialised(kernel: Callable, arguments: tuple) -> Callable:
    """
    Return what a kernel that was called with such arguments compiled for their types.

    It asks no argument for its type, which for tuples of records takes as long as many steps;
    arguments of other types are not noticed.
    """
    return kernel.overloads[tuple(map(kernel.typeof_pyval, arguments))].entry_point


class ByModel:
    """A kernel for models of one type or another; all else keeps its type from call to call."""

    def __init__(self, kernel: Callable) -> None:
        """Take a kernel whose first argument is a model."""
        self._kernel, self._known = kernel, {}

    def __call__(self, model: Model, *others: object) -> object:
        """Call the kernel, without asking for types of which one is known."""
        known = self._known.get(model._numba_type_)
        if known is not None:
            return known(model, *others)
        result = self._kernel(model, *others)
        self._known[model._numba_type_] = specialised(self._kernel, (model, *others))
        return result


def cache_keys(passes: int, plain: bool = True) -> list[str]:
    """Return the names of the directories that `warm_kernels` uses."""
    return [key for _, key in _groups(passes, plain)]


def _groups(passes: int, plain: bool) -> tuple[tuple[tuple, str], ...]:
    """Return (kernels, name of their directory): what is specialised alike lies together."""
    return (
        ((advance,), cache_key('advance', passes, plain)),
        ((observe, read_field), cache_key('observe', plain)))


@contextmanager
def warm(members: tuple, key: str) -> Iterator[None]:
    """Let these kernels come from the directory of that name, or be compiled and kept there."""
    place = cache_root() / key
    if key in _at_hand:
        # Nothing will be compiled, so nothing could be kept.
        yield
        return
    if is_intact(place):
        _attach(members, place)
        try:
            yield
            _at_hand.add(key)
        finally:
            _detach(members)
        return
    workshop = _workshop(place)
    if workshop is None:
        yield
        return
    try:
        _attach(members, workshop)
        yield
        _publish(workshop, place)
        _at_hand.add(key)
    finally:
        _detach(members)
        shutil.rmtree(workshop, ignore_errors=True)


def compilations() -> int:
    """Return how many kernels this process compiled rather than loaded."""
    return sum(sum(kernel.stats.cache_misses.values()) for kernel in KERNELS)


def cache_root() -> Path:
    """Return where kernels are kept: $HYDRA_ACTUATOR_CACHE, else the user's cache directory."""
    own = os.environ.get('HYDRA_ACTUATOR_CACHE')
    if own:
        return Path(own)
    base = os.environ.get('XDG_CACHE_HOME') or Path.home() / '.cache'
    return Path(base) / 'hydra_actuator'


def digest_of_sources(folder: Path) -> str:
    """Return a hash of the sources in a folder and below: their places, times and contents."""
    digest = hashlib.sha256()
    for source in sorted(folder.rglob('*.py')):
        digest.update(f'{source} {source.stat().st_mtime_ns}\n'.encode())
        digest.update(source.read_bytes())
    return digest.hexdigest()


# Of what this process runs: sources that change under it are another's.
SOURCES = digest_of_sources(Path(hydra_actuator.core.__file__).parent)


def cache_key(*specialised: object) -> str:
    """Return the name of the directory that fits sources, versions, processor and all given."""
    about = (SOURCES, sys.version, numba.__version__, llvmlite.__version__, np.__version__,
             llvmlite.binding.get_host_cpu_name(),
             llvmlite.binding.get_host_cpu_features().flatten(), *specialised)
    return hashlib.sha256(repr(about).encode()).hexdigest()[:32]


def is_intact(place: Path) -> bool:
    """Return whether all files of a cache directory are those its manifest names."""
    try:
        manifest = json.loads((place / MANIFEST).read_text())
        return bool(manifest) and manifest == _checksums(place)
    except (OSError, ValueError):
        return False


def _checksums(place: Path) -> dict[str, str]:
    return {
        str(file.relative_to(place)): hashlib.sha256(file.read_bytes()).hexdigest()
        for file in sorted(place.rglob('*'))
        if file.is_file() and file.name != MANIFEST}


def _workshop(place: Path) -> Path | None:
    try:
        place.parent.mkdir(parents=True, exist_ok=True)
        return Path(tempfile.mkdtemp(prefix=UNFINISHED, dir=place.parent))
    except OSError:
        return None


def _publish(workshop: Path, place: Path) -> None:
    try:
        (workshop / MANIFEST).write_text(json.dumps(_checksums(workshop)))
        shutil.rmtree(place, ignore_errors=True)
        workshop.rename(place)
        _prune(place.parent)
    except OSError:
        # another process was first, or the disk is full: the kernels in memory are good
        return


def _prune(root: Path) -> None:
    """Remove all but the newest directories, and what killed compilations left behind."""
    for entry in root.glob(f'{UNFINISHED}*'):
        if time.time() - entry.stat().st_mtime > LONGEST_COMPILATION:
            shutil.rmtree(entry, ignore_errors=True)
    kept = sorted((entry for entry in root.iterdir() if (entry / MANIFEST).exists()),
                  key=lambda entry: entry.stat().st_mtime, reverse=True)
    for entry in kept[MOST_KEPT:]:
        shutil.rmtree(entry, ignore_errors=True)


def _attach(members: tuple, place: Path) -> None:
    before = numba.config.CACHE_DIR
    numba.config.CACHE_DIR = str(place)
    try:
        for kernel in members:
            kernel.enable_caching()
    finally:
        numba.config.CACHE_DIR = before


def _detach(members: tuple) -> None:
    for kernel in members:
        kernel._cache = NullCache()
