# SPDX-License-Identifier: Apache-2.0
"""The kernel cache: warm starts compile nothing, and nothing stale or broken is ever used."""

import os
from pathlib import Path
import shutil
import subprocess
import sys

from hydra_actuator import kernels
from hydra_actuator.actuator import Actuator
import hydra_actuator.core
from hydra_actuator.parameters import Parameters
import pytest

REPOSITORY = Path(__file__).parents[1]
PASSES = 2
START = """
import sys
from hydra_actuator.actuator import Actuator
from hydra_actuator.kernels import compilations
actuator = Actuator()
ready = compilations()
state = actuator.advance(0.005, spool=0.5)
print(ready, compilations(), state.position.hex())
"""


@pytest.fixture(scope='module')
def compiled(tmp_path_factory) -> Path:
    """Return a cache directory with the kernels of this version in it."""
    Actuator()
    root = tmp_path_factory.mktemp('kernels')
    for key in kernels.cache_keys(PASSES):
        shutil.copytree(kernels.cache_root() / key, root / key)
    return root


@pytest.fixture
def cache(compiled, tmp_path) -> Path:
    """Return a copy of that cache to spoil."""
    return Path(shutil.copytree(compiled, tmp_path / 'cache'))


def start(cache: Path) -> subprocess.Popen:
    """Start a process that uses an actuator with its kernels in `cache`."""
    environment = os.environ | {'HYDRA_ACTUATOR_CACHE': str(cache)}
    return subprocess.Popen([sys.executable, '-c', START], cwd=REPOSITORY, env=environment,
                            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def finish(process: subprocess.Popen) -> tuple[int, int, str]:
    """Return (kernels compiled at the start, until the end, position) of a started process."""
    out, error = process.communicate(timeout=300)
    assert process.returncode == 0, error
    ready, total, position = out.split()
    return int(ready), int(total), position


def kernel_files(cache: Path) -> list[Path]:
    return sorted(file for file in cache.rglob('*') if file.suffix in ('.nbc', '.nbi'))


def position_here() -> str:
    return Actuator().advance(0.005, spool=0.5).position.hex()


def test_second_process_compiles_nothing_and_finds_the_same_bits(cache):
    assert finish(start(cache)) == (0, 0, position_here())


def truncate(file: Path) -> None:
    file.write_bytes(file.read_bytes()[:len(file.read_bytes()) // 2])


def flip_a_bit(file: Path) -> None:
    content = bytearray(file.read_bytes())
    content[len(content) // 2] ^= 1
    file.write_bytes(content)


def empty(file: Path) -> None:
    file.write_bytes(b'')


@pytest.mark.parametrize('spoil', [truncate, flip_a_bit, empty, Path.unlink])
def test_a_spoiled_file_makes_the_whole_directory_unfit(cache, spoil):
    for key in kernels.cache_keys(PASSES):
        spoil_each_file_of(cache / key, spoil)


def spoil_each_file_of(place: Path, spoil) -> None:
    assert kernels.is_intact(place)
    for file in kernel_files(place):
        content = file.read_bytes()
        spoil(file)
        assert not kernels.is_intact(place), file.name
        file.write_bytes(content)
    assert kernels.is_intact(place)


@pytest.mark.parametrize('manifest', ['', '{}', '[]', 'null', '{"a": "b"}', '{'])
def test_a_spoiled_manifest_makes_the_directory_unfit(cache, manifest):
    place = cache / kernels.cache_keys(PASSES)[0]
    (place / kernels.MANIFEST).write_text(manifest)
    assert not kernels.is_intact(place)


def test_a_file_too_many_makes_the_directory_unfit(cache):
    place = cache / kernels.cache_keys(PASSES)[0]
    (place / 'more').write_text('of it')
    assert not kernels.is_intact(place)


@pytest.mark.soak
def test_two_processes_at_once_replace_a_broken_cache(cache):
    for key in kernels.cache_keys(PASSES):
        flip_a_bit(kernel_files(cache / key)[-1])
    both = [start(cache), start(cache)]
    for process in both:
        ready, total, position = finish(process)
        assert ready == total == len(kernels.KERNELS)
        assert position == position_here()
    assert all(kernels.is_intact(cache / key) for key in kernels.cache_keys(PASSES))
    assert not list(cache.glob(f'{kernels.UNFINISHED}*'))
    assert finish(start(cache)) == (0, 0, position_here())


BOTH = """
from hydra_actuator.actuator import Actuator
from hydra_actuator.kernels import compilations
from hydra_actuator.parameters import Parameters
for iterations in {iterations}:
    Actuator(Parameters().replace({{'solver.iterations': iterations}})).advance(0.001)
print(compilations())
"""


def compiled_in_a_process(cache: Path, iterations: tuple[int, ...]) -> int:
    """Return how many kernels a process compiles that makes actuators of these iterations."""
    out = subprocess.run(
        [sys.executable, '-c', BOTH.format(iterations=iterations)], cwd=REPOSITORY, check=True,
        env=os.environ | {'HYDRA_ACTUATOR_CACHE': str(cache)}, capture_output=True, text=True)
    return int(out.stdout)


@pytest.mark.soak
def test_kernels_of_another_number_of_passes_are_kept_whole(cache):
    assert compiled_in_a_process(cache, (PASSES, PASSES - 1)) == 1
    assert compiled_in_a_process(cache, (PASSES - 1,)) == 0
    assert compiled_in_a_process(cache, (PASSES - 1, PASSES)) == 0


def test_without_a_writable_place_the_actuator_still_works(tmp_path, monkeypatch):
    expected = position_here()
    blocked = tmp_path / 'file'
    blocked.write_text('not a directory')
    monkeypatch.setenv('HYDRA_ACTUATOR_CACHE', str(blocked))
    assert position_here() == expected
    assert blocked.read_text() == 'not a directory'


@pytest.fixture
def core_elsewhere(tmp_path) -> Path:
    """Return a copy of the kernels' sources."""
    return Path(shutil.copytree(Path(hydra_actuator.core.__file__).parent, tmp_path / 'core'))


def test_any_changed_or_added_source_changes_what_the_key_is_made_of(core_elsewhere):
    digests = [kernels.digest_of_sources(core_elsewhere)]
    assert kernels.digest_of_sources(core_elsewhere) == digests[0]
    for source in sorted(core_elsewhere.rglob('*.py')):
        source.write_text(source.read_text() + '\n')
        digests.append(kernels.digest_of_sources(core_elsewhere))
    (core_elsewhere / 'new.py').write_text('')
    digests.append(kernels.digest_of_sources(core_elsewhere))
    assert len(set(digests)) == len(digests) > 10


def test_a_specialised_kernel_does_what_the_kernel_does():
    actuator, other = Actuator(), Actuator()

    def arguments(one):
        model, state, passes, schedule, inputs, steps = one.solver[:6]
        return model, state, passes, schedule, inputs, 20, steps
    direct = kernels.specialised(kernels.advance, arguments(actuator))
    assert direct(*arguments(actuator)) == kernels.advance(*arguments(other))
    assert actuator.time == other.time == 20 * actuator.step_time
    with pytest.raises(KeyError):
        kernels.specialised(kernels.advance, (1, 2, 3))


def test_a_kernel_by_model_compiles_once_for_each_kind_of_model():
    plain, boiling = Actuator(), Actuator(Parameters({'fluid.cavitation': True}))
    by_model = kernels.ByModel(kernels.advance)
    for actuator in (plain, boiling, plain, boiling):
        model, state, passes, schedule, inputs, steps = actuator.solver[:6]
        assert by_model(model, state, passes, schedule, inputs, 3, steps) == 0
    assert plain.time == 6 * plain.step_time and boiling.time == 6 * boiling.step_time
    assert len(by_model._known) == 2


def test_sources_and_passes_are_in_the_key(monkeypatch):
    before = kernels.cache_keys(PASSES)
    assert kernels.cache_keys(PASSES + 1)[0] not in before
    assert not set(kernels.cache_keys(PASSES, False)) & set(before)
    monkeypatch.setattr(kernels, 'SOURCES', 'other')
    assert not set(kernels.cache_keys(PASSES)) & set(before)


def test_the_key_is_that_of_the_sources_this_process_runs(core_elsewhere, monkeypatch):
    before = kernels.cache_keys(PASSES)
    monkeypatch.setattr(hydra_actuator.core, '__file__', str(core_elsewhere / '__init__.py'))
    assert kernels.cache_keys(PASSES) == before


def test_cache_lies_where_the_environment_says(monkeypatch, tmp_path):
    monkeypatch.setenv('HYDRA_ACTUATOR_CACHE', str(tmp_path / 'own'))
    assert kernels.cache_root() == tmp_path / 'own'
    monkeypatch.delenv('HYDRA_ACTUATOR_CACHE')
    monkeypatch.setenv('XDG_CACHE_HOME', str(tmp_path))
    assert kernels.cache_root() == tmp_path / 'hydra_actuator'
    monkeypatch.delenv('XDG_CACHE_HOME')
    monkeypatch.setenv('HOME', str(tmp_path))
    assert kernels.cache_root() == tmp_path / '.cache' / 'hydra_actuator'
