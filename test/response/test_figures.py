# SPDX-License-Identifier: Apache-2.0
"""A study's figures, table and CSV hold all models with their units."""

import csv

from hydra_actuator.response.figures import write_figures
from hydra_actuator.response.study import frequency_grid, study
from hydra_actuator.response.table import table, write_csv
import numpy as np
import pytest

ALL = {'bode_velocity.png', 'bode_pressure.png', 'stiffness.png', 'valve_null.png'}


@pytest.fixture(scope='module')
def result(plant_of):
    """Return a study without the solver, of a spool with dynamics."""
    point = plant_of({'valve.natural_frequency': 150.0}).point
    return study(point, frequency_grid(1.0, 800.0, 200), solver=False)


def test_every_figure_is_a_png(result, tmp_path):
    paths = write_figures(result, tmp_path)
    assert {path.name for path in paths} == ALL
    assert all(path.read_bytes().startswith(b'\x89PNG') for path in paths)


def test_csv_holds_complex_responses_with_units(result, tmp_path):
    write_csv(result, tmp_path / 'response.csv')
    with open(tmp_path / 'response.csv', newline='') as file:
        rows = list(csv.DictReader(file))
    mine = [row for row in rows if row['model'] == 'distributed']
    velocity = [complex(float(row['velocity real [1/s]']), float(row['velocity imaginary [1/s]']))
                for row in mine]
    assert np.array_equal(velocity, result.distributed.velocity)
    assert {row['model'] for row in rows} == {'distributed', 'lumped'}


def test_table_compares_the_models(result):
    text = '\n'.join(table(result))
    (line,) = [x for x in table(result) if x.startswith('  natural frequency')]
    assert line.split()[-4:] == ['175.79', '-', '177.14', '175.71']
    assert 'K_q0' in text


def test_a_spool_within_its_overlap_has_no_bode_figure_and_a_note(plant_of, tmp_path):
    point = plant_of({f'valve.overlap_{edge}': 1e-5 for edge in ('pa', 'pb', 'at', 'bt')}).point
    idle = study(point, frequency_grid(1.0, 800.0, 50), solver=False)
    names = {path.name for path in write_figures(idle, tmp_path)}
    assert names == {'stiffness.png', 'valve_null.png'}
    assert any('within the overlap' in line for line in table(idle))
