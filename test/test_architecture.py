# SPDX-License-Identifier: Apache-2.0
"""
Imports point one way, and every file is a room.

core <- actuator <- simulate, ros; recording and analysis know channels, not physics; only ros/
knows rclpy; the command line and the pytest plugin reach ROS only from within their functions.
"""

import ast
from pathlib import Path
import sys

import pytest

pytestmark = pytest.mark.once

ROOT = Path(__file__).parents[1]
PACKAGE = ROOT / 'hydra_actuator'
SOURCES = sorted(PACKAGE.rglob('*.py'))
LONGEST_FILE = 300
LONGEST_FUNCTION = 60
ROS = {'rclpy', 'rosgraph_msgs', 'std_msgs', 'sensor_msgs', 'diagnostic_msgs', 'lifecycle_msgs',
       'rcl_interfaces', 'std_srvs', 'builtin_interfaces', 'ament_index_python',
       'simulation_interfaces', 'launch', 'launch_ros'}

# What each room may import of the package itself, and from elsewhere beside the standard library.
# A room is a folder or a file of the package; `errors` and `channels` are open to all but core.
COMMON = {'errors', 'channels'}
ROOMS = {
    'core': ({'core'}, {'numpy', 'numba', 'llvmlite'}),
    'channels': (set(), {'numpy'}),
    'errors': (set(), set()),
    'parameters': ({'parameters'}, {'numpy', 'yaml'}),
    'recording': ({'recording', 'interruption', 'hydra_actuator'},
                  {'numpy', 'mcap', 'lz4', 'zstandard', 'yaml', 'xarray', 'pandas', 'pyarrow'}),
    'analysis': ({'analysis', 'recording', 'parameters', 'step_response'},
                 {'numpy', 'plotly', 'matplotlib', 'imageio_ffmpeg', 'PIL'}),
    'csv_files': (set(), set()),
    'faults': ({'faults', 'parameters', 'csv_files'}, set()),
    'step_response': (set(), {'numpy'}),
    'supply': (set(), set()),
    'instruments': ({'instruments'}, {'numpy'}),
    'realtime': ({'realtime', 'core', 'kernels', 'solver'}, {'numpy', 'numba', 'llvmlite'}),
    'interruption': (set(), set()),
    'verification': (
        {'verification', 'core', 'kernels', 'assembly', 'actuator', 'geometry', 'simulate',
         'parameters', 'analysis', 'response'},
        {'numpy', 'scipy', 'matplotlib'},
    ),
    'paper': (
        {'paper', 'verification', 'core', 'kernels', 'geometry', 'assembly', 'actuator',
         'simulate', 'signals', 'interruption', 'parameters', 'analysis'},
        {'numpy', 'scipy', 'matplotlib'},
    ),
    'response': (
        {'response', 'core', 'assembly', 'geometry', 'equilibrium', 'steady_flow', 'actuator',
         'parameters', 'analysis'},
        {'numpy', 'scipy', 'control', 'matplotlib'},
    ),
    'growth': (
        {'growth', 'actuator', 'simulate', 'signals', 'sweep', 'parameters', 'analysis'},
        {'numpy', 'matplotlib', 'distributed'},
    ),
    'peers': (
        {'peers', 'core', 'verification', 'hydra_actuator'},
        {'numpy', 'rthym_moc', 'tsnet', 'ptsnet', 'inp'},
    ),
    'sweep': (
        {'sweep', 'actuator', 'offline', 'one_compiler', 'signals', 'interruption', 'parameters',
         'response', 'analysis', 'hydra_actuator'},
        {'numpy', 'scipy', 'dask', 'distributed', 'pyarrow', 'xarray', 'SALib'},
    ),
    'testing': (
        {'testing', 'step_response', 'actuator', 'parameters', 'ros'}, {'numpy', 'pytest'}),
    'ros': None,
    'cli': None,
}
# Rooms below ROS: whatever else they import, never its packages, not even within a function.
WITHOUT_ROS = [path for path in SOURCES if path.relative_to(PACKAGE).parts[0] != 'ros']


def room(path):
    return path.relative_to(PACKAGE).parts[0].removesuffix('.py')


def top_level(tree):
    """Yield the nodes that run on import: all but the bodies of functions."""
    stack = [tree]
    while stack:
        node = stack.pop()
        yield node
        if not isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef, ast.Lambda)):
            stack.extend(ast.iter_child_nodes(node))


def imported(path, everywhere=True):
    """Return the dotted names a file imports, relative ones resolved."""
    tree = ast.parse(path.read_text(encoding='utf-8'))
    package = ('hydra_actuator', *path.relative_to(PACKAGE).parts[:-1])
    names = set()
    for node in ast.walk(tree) if everywhere else top_level(tree):
        if isinstance(node, ast.Import):
            names.update(alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            home = '.'.join(package[:len(package) - node.level + 1]) if node.level else ''
            base = '.'.join(filter(None, (home, node.module)))
            names.update(f'{base}.{alias.name}' for alias in node.names)
    return names


def own_rooms(names):
    """Return the rooms of the package among the names; the package itself stands for itself."""
    parts = [name.split('.') for name in names]
    known = {room(path) for path in SOURCES}
    return {
        part[1] if len(part) > 1 and part[1] in known else 'hydra_actuator'
        for part in parts if part[0] == 'hydra_actuator'
    }


def foreign(names):
    """Return the third-party packages among the names."""
    return {name.split('.')[0] for name in names} - sys.stdlib_module_names - {'hydra_actuator'}


def label(path):
    return str(path.relative_to(PACKAGE))


@pytest.mark.parametrize('path', SOURCES, ids=label)
def test_arrows_point_one_way(path):
    allowed = ROOMS.get(room(path))
    if allowed is None:
        return
    rooms, packages = allowed
    names = imported(path)
    common = set() if room(path) == 'core' else COMMON
    assert own_rooms(names) <= rooms | common
    assert foreign(names) <= packages


@pytest.mark.parametrize('path', sorted((PACKAGE / 'core').rglob('*.py')), ids=label)
def test_core_imports_only_numpy_numba_math_and_core(path):
    roots = {name.split('.')[0] for name in imported(path)}
    assert roots <= {'numpy', 'numba', 'llvmlite', 'math', 'collections', 'dataclasses',
                     'functools', 'hashlib', 'operator', 'typing', 'hydra_actuator'}


@pytest.mark.parametrize('path', WITHOUT_ROS, ids=label)
def test_only_the_ros_room_knows_rclpy(path):
    assert not foreign(imported(path)) & ROS


@pytest.mark.parametrize('path', WITHOUT_ROS, ids=label)
def test_nothing_outside_the_ros_room_imports_it_on_import(path):
    assert 'ros' not in own_rooms(imported(path, everywhere=False))


@pytest.mark.parametrize('path', WITHOUT_ROS, ids=label)
def test_only_the_command_line_and_the_pytest_plugin_reach_ros_at_all(path):
    if room(path) != 'cli' and label(path) != 'testing/plugin.py':
        assert 'ros' not in own_rooms(imported(path))


@pytest.mark.parametrize('path', sorted((PACKAGE / 'cli').glob('*.py')), ids=label)
def test_command_line_loads_nothing_heavy_on_import(path):
    names = imported(path, everywhere=False)
    assert not foreign(names)
    assert own_rooms(names) <= {'cli', 'errors', 'hydra_actuator'}


@pytest.mark.parametrize('path', SOURCES, ids=label)
def test_solver_reaches_neither_output_nor_analysis(path):
    if room(path) in ('actuator', 'assembly', 'kernels'):
        assert not own_rooms(imported(path)) & {'recording', 'analysis', 'ros', 'cli', 'realtime'}


@pytest.mark.parametrize('path', sorted((PACKAGE / 'verification').glob('*.py')), ids=label)
def test_verification_takes_only_colours_from_analysis(path):
    names = {name for name in imported(path) if name.startswith('hydra_actuator.analysis')}
    assert all(name.startswith('hydra_actuator.analysis.palette') for name in names)
    assert 'matplotlib' not in foreign(imported(path, everywhere=False))


@pytest.mark.parametrize('path', SOURCES, ids=label)
def test_file_is_a_room_with_a_sign_at_its_door(path):
    text = path.read_text(encoding='utf-8')
    assert text.startswith('# SPDX-License-Identifier: Apache-2.0\n')
    assert text.count('\n') <= LONGEST_FILE
    assert ast.get_docstring(ast.parse(text)), 'no docstring'


@pytest.mark.parametrize('path', SOURCES, ids=label)
def test_function_fits_on_a_screen(path):
    tree = ast.parse(path.read_text(encoding='utf-8'))
    for node in ast.walk(tree):
        if isinstance(node, ast.FunctionDef):
            assert node.end_lineno - node.lineno < LONGEST_FUNCTION, node.name


def test_every_folder_of_the_package_is_a_package():
    folders = {path.parent for path in SOURCES}
    assert all((folder / '__init__.py').exists() for folder in folders)
