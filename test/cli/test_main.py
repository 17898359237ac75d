# SPDX-License-Identifier: Apache-2.0
"""Verbs, exit codes, and one line on stderr."""

from importlib import import_module
from pathlib import Path
import subprocess
import sys
import types

import hydra_actuator
from hydra_actuator.cli import main as dispatcher
from hydra_actuator.cli.main import main, split_ros_arguments
from hydra_actuator.errors import Failure, InputError
import pytest

CLI = Path(dispatcher.__file__).parent
PRESENT = [name for name in dispatcher.VERBS if (CLI / f'{name}.py').exists()]


@pytest.fixture
def verb(monkeypatch):
    """Return a function that makes a verb `act` out of a function of its arguments."""
    def make(run, **more):
        module = types.ModuleType('hydra_actuator.cli.act')
        module.__dict__.update({
            'run': run, 'add_arguments': lambda parser: parser.add_argument('-x'), **more,
        })
        monkeypatch.setitem(sys.modules, module.__name__, module)
        monkeypatch.setitem(dispatcher.VERBS, 'act', 'acts')
    return make


def raising(error):
    def run(arguments):
        raise error
    return run


@pytest.mark.parametrize('error, code', [
    (InputError('speed = -1: below\nthe minimum'), 2), (Failure('the disk is full'), 1),
])
def test_foreseen_error_is_one_line_and_its_exit_code(verb, capsys, error, code):
    verb(raising(error))
    assert main(['act']) == code
    assert capsys.readouterr().err == f'hydra_actuator act: {" ".join(str(error).split())}\n'


def test_interrupt_ends_in_130_and_silence(verb, capsys):
    verb(raising(KeyboardInterrupt()))
    assert main(['act']) == 130
    assert capsys.readouterr().err == ''


def test_unforeseen_error_is_not_hidden(verb):
    verb(raising(ZeroDivisionError()))
    with pytest.raises(ZeroDivisionError):
        main(['act'])


def test_exit_code_of_the_verb_is_handed_on(verb):
    verb(lambda arguments: 3)
    assert main(['act']) == 3


@pytest.mark.parametrize('argv', [['act', '--nonsense'], ['act', '-x'], ['nonsense']])
def test_bad_usage_is_one_line_and_exit_code_2(verb, capsys, argv):
    verb(lambda arguments: 0)
    assert main(argv) == 2
    assert capsys.readouterr().err.count('\n') == 1


def test_preparation_comes_before_anything_is_parsed(verb):
    events = []
    verb(
        lambda arguments: events.append('run') or 0,
        prepare=lambda: events.append('prepare'),
        add_arguments=lambda parser: events.append('arguments'),
    )
    main(['act'])
    assert events == ['prepare', 'arguments', 'run']


def test_ros_arguments_are_handed_over_unparsed(verb):
    seen = []
    verb(lambda arguments: seen.append(arguments) or 0, ROS_ARGUMENTS=True)
    main(['act', '-x', '1', '--ros-args', '-r', '__ns:=/left'])
    assert seen[0].x == '1'
    assert seen[0].ros_arguments == ['--ros-args', '-r', '__ns:=/left']


def test_ros_arguments_end_at_a_double_dash():
    argv = ['a', '--ros-args', '-p', 'x:=1', '--', 'b', '--ros-args', '-r', 'c:=d']
    own, ros = split_ros_arguments(argv)
    assert own == ['a', 'b']
    assert ros == ['--ros-args', '-p', 'x:=1', '--', '--ros-args', '-r', 'c:=d']


@pytest.mark.parametrize('name', PRESENT)
def test_summary_in_the_list_is_the_verbs_own(name):
    assert import_module(f'hydra_actuator.cli.{name}').SUMMARY == dispatcher.VERBS[name]


def test_help_lists_every_verb(capsys):
    assert main(['--help']) == 0
    listed = capsys.readouterr().out
    assert all(f'  {name} ' in listed for name in dispatcher.VERBS)


def test_listing_the_verbs_loads_nothing_heavy():
    code = (
        'import sys; from hydra_actuator.cli.main import main; main(["--help"]); '
        'print(*{"numpy", "numba", "rclpy", "yaml", "argparse"} & set(sys.modules))'
    )
    run = subprocess.run([sys.executable, '-c', code], capture_output=True, text=True, check=True)
    assert run.stdout.splitlines()[-1] == ''


def test_module_runs_as_the_command_does():
    run = subprocess.run(
        [sys.executable, '-m', 'hydra_actuator', '--version'],
        capture_output=True, text=True, check=True,
    )
    assert run.stdout.strip() == hydra_actuator.__version__
