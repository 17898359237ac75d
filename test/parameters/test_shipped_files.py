# SPDX-License-Identifier: Apache-2.0
"""config/ and README against the one table."""

from pathlib import Path

from hydra_actuator import load_parameters
from hydra_actuator.parameters import PARAMETERS, read_parameter_file
from hydra_actuator.parameters.markdown import with_table
from hydra_actuator.parameters.table_actuator import ACTUATOR
from hydra_actuator.parameters.table_hydraulics import HYDRAULICS
from hydra_actuator.parameters.table_running import RUNNING
import pytest

ROOT = Path(__file__).parents[2]
CONFIG = ROOT / 'config'
PHYSICS = {one.name for one in (*HYDRAULICS, *ACTUATOR)}
# Their defaults are empty, and ROS takes an empty list in a file for no value at all.
EMPTY_LISTS = {'sections.positions', 'timing.cpu_affinity'}


def test_actuator_file_holds_the_defaults_of_all_physics():
    assert load_parameters(CONFIG / 'actuator.yaml').changed() == {}
    assert set(read_parameter_file(CONFIG / 'actuator.yaml')) == PHYSICS


def test_paper_file_differs_from_the_defaults_only_in_its_tank():
    assert load_parameters(CONFIG / 'paper.yaml').changed() == {'tank.pressure': 0.0}
    assert set(read_parameter_file(CONFIG / 'paper.yaml')) == PHYSICS


def test_realtime_file_holds_the_defaults_of_running():
    assert load_parameters(CONFIG / 'realtime.yaml').changed() == {}
    names = {one.name for one in RUNNING}
    assert set(read_parameter_file(CONFIG / 'realtime.yaml')) == names - EMPTY_LISTS


def test_streamline_of_the_paper_gives_its_wave_time():
    paper = load_parameters(CONFIG / 'paper.yaml')
    lines = sum(paper[f'{line}.length'] for line in
                ('supply_line', 'line_1', 'line_2', 'return_line'))
    chambers = sum(paper[f'cylinder.{part}'] for part in
                   ('dead_length_1', 'stroke', 'dead_length_2'))
    wave_speed = (paper['fluid.bulk_modulus'] / paper['fluid.density']) ** 0.5
    assert (lines + chambers) / wave_speed == pytest.approx(1 / 650, rel=1e-9)


@pytest.mark.parametrize(
    'path', sorted(set(CONFIG.glob('*.yaml')) - {CONFIG / 'controllers.yaml'}),
    ids=lambda path: path.name)
def test_comment_of_every_value_is_the_meaning_in_the_table(path):
    text = path.read_text()
    for name in read_parameter_file(path):
        assert PARAMETERS[name].meaning in text, name


def test_readme_shows_the_table():
    text = (ROOT / 'README.md').read_text()
    assert with_table(text) == text, 'run python -m hydra_actuator.parameters.markdown README.md'
