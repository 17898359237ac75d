# SPDX-License-Identifier: Apache-2.0
"""The fixtures without middleware, and what the plugin costs those who do not use it."""

import itertools
from pathlib import Path
import subprocess
import sys
import textwrap

from hydra_actuator.parameters import ParameterError
import pytest

DOCUMENT = Path(__file__).parents[2] / 'docs/testing.md'
HEAVY = {'numpy', 'numba', 'yaml', 'rclpy'}


def documented(title):
    """Return the first block of code below a title of docs/testing.md."""
    lines = DOCUMENT.read_text().partition(f'## {title}\n\n')[2].splitlines()
    code = itertools.takewhile(lambda line: not line or line.startswith('    '), lines)
    return textwrap.dedent('\n'.join(code))


def pytest_in(folder, arguments, modules):
    """Run pytest in a process of its own; return which of the modules it then had loaded."""
    script = (
        'import sys, pytest; code = pytest.main(sys.argv[1:]); '
        f'print("LOADED", *sorted({modules!r} & set(sys.modules))); sys.exit(code)')
    done = subprocess.run(
        [sys.executable, '-c', script, *arguments], cwd=folder, capture_output=True, text=True,
        check=False, timeout=120)
    return done, set(done.stdout.rpartition('LOADED')[2].split())


def test_collecting_in_an_empty_folder_loads_the_plugin_and_nothing_heavy(tmp_path):
    done, loaded = pytest_in(
        tmp_path, ['--co', '-q'], HEAVY | {'hydra_actuator.testing.plugin'})
    assert done.returncode == pytest.ExitCode.NO_TESTS_COLLECTED, done.stdout + done.stderr
    assert loaded == {'hydra_actuator.testing.plugin'}


def test_a_test_elsewhere_finds_the_fixtures_and_loads_no_ros(tmp_path):
    # The example of the documentation, copied and pasted.
    (tmp_path / 'position_controller.py').write_text(documented('A controller to test'))
    (tmp_path / 'test_mine.py').write_text(documented('Without middleware'))
    done, loaded = pytest_in(tmp_path, ['-q', '--strict-markers'], HEAVY)
    assert done.returncode == 0, done.stdout + done.stderr
    assert '1 passed' in done.stdout
    assert loaded == HEAVY - {'rclpy'}


def test_the_actuator_is_at_rest_with_default_parameters(actuator):
    assert actuator.time == 0.0
    assert actuator.state.position == 0.0
    assert not actuator.parameters.changed()


def test_files_and_overrides_make_an_actuator(make_actuator, tmp_path):
    path = tmp_path / 'mine.yaml'
    path.write_text('/**:\n  ros__parameters:\n    solver: {cells: 60}\n'
                    '    cylinder: {mass: 20.0}\n')
    made = make_actuator({'cylinder.mass': 30.0}, files=[path])
    assert made.parameters.changed() == {'solver.cells': 60, 'cylinder.mass': 30.0}
    assert make_actuator({'solver.cells': 60}) is not make_actuator({'solver.cells': 60})
    with pytest.raises(ParameterError, match=r'cylinder\.mas\b'):
        make_actuator({'cylinder.mas': 1.0})
