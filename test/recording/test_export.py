# SPDX-License-Identifier: Apache-2.0
"""What is exported comes back bit for bit, with units and places, through the tools it is for."""

import json
import math

from hydra_actuator import load_recording
from hydra_actuator.cli.main import main
import numpy as np
import pandas
from pyarrow import parquet
import pytest
import xarray


def exported(made, output, *arguments):
    assert main(['export', str(made.directory), '-o', str(output), *arguments]) == 0
    return output


def assert_table_is_that_recorded(table, made) -> None:
    channels = made.channels
    for name, column in [('time', channels.TIME), ('position', channels.POSITION),
                         ('effort', channels.EFFORT), ('spool_position_1', channels.SPOOL_1),
                         ('pressure.A', channels.pressure.start + 1),
                         ('flow_velocity.K', channels.flow_velocity.start + 2),
                         ('cavity_volume', channels.cavity_volume),
                         ('cavity_volume.line_1', channels.domain_cavities.start + 1)]:
        assert np.array_equal(table[name], made.rows[:, column]), name


def test_csv_comes_back_with_units_and_places_beside_it(make_recording, tmp_path, capsys):
    made = make_recording()
    output = exported(made, tmp_path / 'out.csv')
    assert_table_is_that_recorded(pandas.read_csv(output, float_precision='round_trip'), made)
    told = json.loads((tmp_path / 'out.csv-metadata.json').read_text())
    columns = {column['name']: column for column in told['tableSchema']['columns']}
    assert list(columns) == pandas.read_csv(output, nrows=0).columns.tolist()
    assert columns['pressure.K']['hydra_actuator:units'] == 'Pa'
    assert columns['pressure.K']['hydra_actuator:x'] == '2.0'
    assert told['url'] == 'out.csv'
    assert 'supply' in told['hydra_actuator:parameters']
    assert capsys.readouterr().out.count('\n') == 2


def test_parquet_comes_back_with_units_and_places_in_it(make_recording, tmp_path):
    made = make_recording(spools=2)
    output = exported(made, tmp_path / 'out.parquet')
    assert_table_is_that_recorded(pandas.read_parquet(output), made)
    schema = parquet.read_schema(output)
    assert schema.field('pressure.O').metadata[b'units'] == b'Pa'
    assert schema.field('pressure.A').metadata[b'x'] == b'0.6'
    assert schema.metadata[b'source'] == b'simulate'
    assert {'spool_position_2', 'spool_command_2'} <= set(schema.names)


def test_netcdf_comes_back_with_the_field(make_recording, tmp_path):
    made = make_recording()
    output = exported(made, tmp_path / 'out.nc')
    recording = load_recording(made.directory)
    for group, expected in [(None, recording.dataset), ('field', recording.field_dataset)]:
        with xarray.open_dataset(output, group=group) as found:
            for name, array in {**expected.data_vars, **expected.coords}.items():
                assert found[name].dtype == array.dtype or array.dtype.kind == 'U'
                xarray.testing.assert_equal(found[name], array)
                assert array.attrs.items() <= found[name].attrs.items()
            assert found.attrs['source'] == 'simulate'


def test_a_rate_keeps_the_first_state_after_each_instant(make_recording, tmp_path):
    made = make_recording()
    output = exported(made, tmp_path / 'out.nc', '--rate', '300')
    with xarray.open_dataset(output) as found:
        ticks = [math.ceil(1000 * k / 300 - 1e-6) for k in range(15)]
        assert np.array_equal(found.time, made.rows[ticks, made.channels.TIME])
        assert np.array_equal(found.position, made.rows[ticks, made.channels.POSITION])
    with xarray.open_dataset(output, group='field') as found:
        assert found.sizes['time'] == 10
    slow = exported(made, tmp_path / 'slow.nc', '--rate', '100')
    with xarray.open_dataset(slow, group='field') as found:
        assert np.array_equal(found.time, made.rows[::10, made.channels.TIME])


def test_chosen_topics_are_all_that_is_exported(make_recording, tmp_path):
    made = make_recording()
    output = exported(made, tmp_path / 'out.csv', '--topics', 'pressure', 'applied')
    assert pandas.read_csv(output, nrows=0).columns.tolist() == [
        'time', 'load_force', 'spool_command_1', 'pressure.O', 'pressure.A', 'pressure.K']
    output = exported(made, tmp_path / 'field', '--format', 'netcdf', '--topics', 'field')
    with xarray.open_dataset(output) as found:
        assert list(found.data_vars) == []
    with xarray.open_dataset(output, group='field') as found:
        assert found.pressure.shape == (10, 7)


@pytest.mark.parametrize('arguments, culprit', [
    (['-o', 'out.xls'], 'out.xls'), (['-o', 'there.csv'], 'exists already'),
    (['-o', 'out.csv', '--topics', 'field'], 'field'), (['-o', 'out.csv', '--rate', '0'], 'rate'),
    (['-o', 'out.csv', '--topics', 'nonsense'], 'nonsense'), ([], '-o'),
])
def test_bad_input_is_refused_in_one_line(
    make_recording, tmp_path, monkeypatch, capsys, arguments, culprit,
):
    made = make_recording()
    monkeypatch.chdir(tmp_path)
    (tmp_path / 'there.csv').write_text('mine')
    assert main(['export', str(made.directory), *arguments]) == 2
    error = capsys.readouterr().err
    assert error.count('\n') == 1
    assert culprit in error
    assert sorted(path.name for path in tmp_path.iterdir()) == ['run', 'there.csv']
    assert (tmp_path / 'there.csv').read_text() == 'mine'


def test_a_folder_that_is_not_there_fails_in_one_line(make_recording, tmp_path, capsys):
    made = make_recording()
    output = tmp_path / 'nowhere' / 'out.nc'
    assert main(['export', str(made.directory), '-o', str(output)]) == 1
    assert capsys.readouterr().err.count('\n') == 1


def test_what_is_not_installed_is_named_in_one_line(make_recording, tmp_path, capsys, monkeypatch):
    monkeypatch.setattr('hydra_actuator.cli.export.find_spec', lambda name: None)
    made = make_recording()
    assert main(['export', str(made.directory), '-o', str(tmp_path / 'out.nc')]) == 2
    error = capsys.readouterr().err
    assert error.count('\n') == 1
    assert "pip install 'hydra_actuator[export]'" in error
