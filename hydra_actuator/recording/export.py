# SPDX-License-Identifier: Apache-2.0
"""
A recording as a file for other tools: CSV, Parquet or NetCDF, with units and station positions.

CSV and Parquet hold one table of the states: `time`, then a column per quantity, named as in
`channels` (`pressure.A`). Units and places stand in the metadata of each Parquet column, and for a
CSV in FILE-metadata.json, as the W3C's "CSV on the Web" has it. NetCDF holds the dataset of the
states, and that of the field in a group `field`.

Nothing is interpolated: a rate keeps the first recorded state at or after each of its instants.
"""

from collections.abc import Collection
import json
import os
from pathlib import Path
import tempfile
from typing import TYPE_CHECKING

from hydra_actuator.errors import Failure, InputError
from hydra_actuator.recording import labelled
from hydra_actuator.recording.reader import Recording
import numpy as np

if TYPE_CHECKING:
    import xarray

FORMATS = {'csv': '.csv', 'parquet': '.parquet', 'netcdf': '.nc'}

# What each topic of the state carries.
TOPICS = {
    'joint_states': ('position', 'velocity', 'effort', 'spool_position'),
    'applied': ('spool_command', 'load_force'),
    'pressure': ('pressure',),
    'sections': ('pressure', 'flow_velocity'),
    'cavities': ('cavity_volume', 'lowest_pressure', 'cavities_open', 'cavities_opened',
                 'cavities_collapsed', 'domain_cavity_volume'),
    'field': (),
}


def format_of(output: Path, name: str | None = None) -> str:
    """Return the format by its name or the file's suffix; InputError for an unknown one."""
    if name is not None:
        return name
    for known, suffix in FORMATS.items():
        if output.suffix.lower() == suffix:
            return known
    raise InputError(f'{output}: its suffix is none of {", ".join(FORMATS.values())}; '
                     'name a format')


def export(
    recording: Recording, output: str | Path, format_name: str | None = None,
    topics: Collection[str] = (), rate: float | None = None,
) -> list[Path]:
    """
    Write a recording to a file, and return the files written.

    `topics` are of TOPICS, none means all; `rate` [Hz] thins out what is faster. Raises InputError
    if the output exists or the topics do not suit, Failure if it cannot be written.
    """
    output = Path(output)
    kind = format_of(output, format_name)
    with_field = 'field' in topics or (not topics and kind == 'netcdf')
    if with_field and kind != 'netcdf':
        raise InputError(f'the field does not go into {kind}: choose netcdf')
    states = _thinned(_chosen(recording, topics), rate)
    paths = [output]
    if kind == 'csv':
        paths.append(output.with_name(f'{output.name}-metadata.json'))
    for path in paths:
        if os.path.lexists(path):
            raise InputError(f'{path} exists already, and nothing is overwritten')
    try:
        with tempfile.TemporaryDirectory(dir=output.parent, prefix='.export') as folder:
            new = Path(folder, output.name)
            if kind == 'netcdf':
                _write_netcdf(new, states, recording, rate if with_field else 0.0)
            elif kind == 'parquet':
                _write_parquet(new, states)
            else:
                _write_csv(new, states)
            for path in paths:
                Path(folder, path.name).rename(path)
    except OSError as error:
        raise Failure(f'{output} cannot be written: {error.strerror or error}') from None
    return paths


def columns(states: 'xarray.Dataset') -> dict[str, tuple[np.ndarray, dict[str, str]]]:
    """Return the columns of the table of states: name -> values and attributes."""
    found = {'time': (states.time.values, dict(states.time.attrs))}
    for name, array in states.data_vars.items():
        attributes = {key: str(value) for key, value in array.attrs.items()}
        if array.ndim == 1:
            found[name] = (array.values, attributes)
            continue
        label = array.dims[1]
        base = name.removeprefix('domain_')
        for k, place in enumerate(states[label].values.tolist()):
            own = dict(attributes)
            if label == 'station':
                own['x'] = str(float(states.x.values[k]))
            title = f'{base}_{place}' if label == 'spool' else f'{base}.{place}'
            found[title] = (array.values[:, k], own)
    return found


def _chosen(recording: Recording, topics: Collection[str]) -> 'xarray.Dataset':
    """Return the states that the topics carry, all if none are chosen."""
    for topic in topics:
        if topic not in TOPICS:
            raise InputError(f'no topic {topic!r} of the state; there are {", ".join(TOPICS)}')
    states = labelled.states(recording)
    if not topics:
        return states
    wanted = {name for topic in topics for name in TOPICS[topic]}
    return states[[name for name in states.data_vars if name in wanted]]


def _thinned(data: 'xarray.Dataset', rate: float | None) -> 'xarray.Dataset':
    """Keep the first state at or after each k/rate: what a slower output would have given."""
    if rate is None or not data.sizes.get('time'):
        return data
    time = data.time.values
    # Half a nanosecond, the stamps' resolution, lest rounding makes an instant just missed.
    instants = np.arange(int((time[-1] - time[0]) * rate + 1e-6) + 1) / rate + time[0] - 5e-10
    return data.isel(time=np.unique(np.searchsorted(time, instants)))


def _write_csv(path: Path, states: 'xarray.Dataset') -> None:
    """Write the table, and the W3C's description of it with units and places."""
    import pandas

    found = columns(states)
    table = pandas.DataFrame({name: values for name, (values, _) in found.items()})
    table.to_csv(path, index=False)
    told = {
        '@context': 'http://www.w3.org/ns/csvw',
        'url': path.name,
        **{f'hydra_actuator:{key}': value for key, value in states.attrs.items()},
        'tableSchema': {'columns': [
            {'name': name, 'titles': name, 'datatype': 'number',
             **{f'hydra_actuator:{key}': value for key, value in attributes.items()}}
            for name, (_, attributes) in found.items()
        ]},
    }
    path.with_name(f'{path.name}-metadata.json').write_text(json.dumps(told, indent=1), 'utf-8')


def _write_parquet(path: Path, states: 'xarray.Dataset') -> None:
    import pyarrow
    from pyarrow import parquet

    found = columns(states)
    schema = pyarrow.schema(
        [pyarrow.field(name, pyarrow.from_numpy_dtype(values.dtype), metadata=attributes)
         for name, (values, attributes) in found.items()],
        metadata={key: str(value) for key, value in states.attrs.items()},
    )
    table = pyarrow.table([values for values, _ in found.values()], schema=schema)
    parquet.write_table(table, path)


def _write_netcdf(
    path: Path, states: 'xarray.Dataset', recording: Recording, field_rate: float | None
) -> None:
    """Write the states and, unless its rate is 0, the field."""
    packed = {'zlib': True, 'complevel': 1}
    states = states.assign_attrs(Conventions='CF-1.8')
    states.to_netcdf(path, engine='netcdf4', encoding=dict.fromkeys(states.data_vars, packed))
    if field_rate != 0.0 and len(recording.field):
        field = _thinned(labelled.field(recording), field_rate)
        field.to_netcdf(path, 'a', group='field', engine='netcdf4',
                        encoding=dict.fromkeys(field.data_vars, packed))
