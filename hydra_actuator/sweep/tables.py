# SPDX-License-Identifier: Apache-2.0
"""
The results of a sweep as files: Parquet, NetCDF, and a CSV of what failed.

results.parquet: a row per run that is done, columns `run`, each parameter varied, each figure of
merit, unit and meaning in the column's metadata, parameters and drive in the table's. results.nc:
the same along dimension `run`; for a grid its dimensions are the factors. failed.csv: run,
parameters, status, reason.
"""

import csv
import json
import os
from pathlib import Path
from typing import TYPE_CHECKING

from hydra_actuator.errors import Failure, InputError
from hydra_actuator.sweep.journal import read_journal
from hydra_actuator.sweep.merit import MERITS
from hydra_actuator.sweep.plan import Plan
from hydra_actuator.sweep.run import DONE, Outcome
import numpy as np

if TYPE_CHECKING:
    import xarray

PARQUET, NETCDF, FAILED = 'results.parquet', 'results.nc', 'failed.csv'


def columns(plan: Plan, outcomes: dict[int, Outcome]) -> dict[str, tuple[np.ndarray, dict]]:
    """Return the table of runs that are done: name -> values and attributes."""
    runs = sorted(run for run, one in outcomes.items() if one.status == DONE)
    table = plan.base.table
    found = {'run': (np.array(runs, np.int64), {'meaning': 'number of the run'})}
    for k, factor in enumerate(plan.factors):
        values = [plan.samples[run][k] for run in runs]
        for name in factor.names:
            found[name] = (_array(values, table[name].type), {
                'unit': table[name].unit, 'meaning': table[name].meaning, 'role': 'parameter'})
    for merit in MERITS:
        values = [outcomes[run].figures[merit.name] for run in runs]
        found[merit.name] = (np.array(values, float), {
            'unit': merit.unit, 'meaning': merit.meaning, 'role': 'figure'})
    return found


def about(plan: Plan) -> dict[str, str]:
    """Return what holds for all runs, as text."""
    told = plan.told()
    return {'generator': 'hydra_actuator sweep', 'factors': json.dumps(told['factors']),
            'parameters': plan.base.as_yaml(),
            **{name: str(told[name]) for name in
               ('method', 'samples', 'seed', 'drive', 'duration', 'from', 'rate')}}


def dataset(plan: Plan, outcomes: dict[int, Outcome]) -> 'xarray.Dataset':
    """Return the results as labelled arrays; NaN where a point of a grid has none."""
    import xarray

    found = columns(plan, outcomes)
    parameters = {name for name, (_, told) in found.items() if told.get('role') == 'parameter'}
    data = xarray.Dataset(
        {name: ('run', values, told) for name, (values, told) in found.items()
         if name not in parameters and name != 'run'},
        {name: ('run', values, told) for name, (values, told) in found.items()
         if name in parameters or name == 'run'}, about(plan))
    if plan.method != 'grid' or not data.sizes['run']:
        return data
    names = [factor.name for factor in plan.factors]
    told = {name: found[name][1] for name in names}
    tied = [name for name in parameters if name not in names]
    data = data.drop_vars(['run', *tied]).set_index(run=names)
    if len(names) > 1:
        data = data.unstack('run')
    else:
        data = data.rename(run=names[0])
    data = data.reindex({name: list(dict.fromkeys(sample[k] for sample in plan.samples))
                         for k, name in enumerate(names)})
    for name in names:
        data[name].attrs.update(told[name])
    return data


def write_tables(directory: Path, plan: Plan, outcomes: dict[int, Outcome]) -> None:
    """Write all tables of a sweep, each replaced whole."""
    import pyarrow
    from pyarrow import parquet

    found = columns(plan, outcomes)
    schema = pyarrow.schema(
        [pyarrow.field(name, pyarrow.array(values).type, metadata=told)
         for name, (values, told) in found.items()], metadata=about(plan))
    table = pyarrow.table([pyarrow.array(values) for values, _ in found.values()], schema=schema)
    data = dataset(plan, outcomes)
    try:
        with _Replaced(directory / PARQUET) as draft:
            parquet.write_table(table, draft)
        with _Replaced(directory / NETCDF) as draft:
            data.to_netcdf(draft, engine='netcdf4')
        with _Replaced(directory / FAILED) as draft:
            _write_failed(draft, plan, outcomes)
    except OSError as error:
        raise Failure(f'{directory} cannot be written: {error.strerror or error}') from error


def load_table(directory: Path) -> tuple[dict[str, tuple[np.ndarray, dict]], dict[str, str]]:
    """Return columns (values, attributes) and what holds for all runs, of `results.parquet`."""
    from pyarrow import parquet

    try:
        table = parquet.read_table(directory / PARQUET)
    except (OSError, ValueError) as error:
        raise InputError(f'{directory / PARQUET} cannot be read: {error}') from error
    def text(metadata):
        return {key.decode(): value.decode() for key, value in (metadata or {}).items()}
    found = {field.name: (table[field.name].to_numpy(zero_copy_only=False), text(field.metadata))
             for field in table.schema}
    return found, text(table.schema.metadata)


def failures(directory: Path) -> list[Outcome]:
    """Return the runs that failed, in order."""
    outcomes = read_journal(directory)
    return [outcomes[run] for run in sorted(outcomes) if outcomes[run].status != DONE]


def _write_failed(path: Path, plan: Plan, outcomes: dict[int, Outcome]) -> None:
    names = [name for factor in plan.factors for name in factor.names]
    with open(path, 'w', newline='', encoding='utf-8') as file:
        rows = csv.writer(file)
        rows.writerow(['run', *names, 'status', 'reason'])
        for run in sorted(outcomes):
            one = outcomes[run]
            if one.status != DONE:
                rows.writerow([run, *plan.changes(run).values(), one.status, one.reason])


def _array(values: list, kind: str) -> np.ndarray:
    kinds = {'double': float, 'integer': np.int64, 'bool': bool}
    return np.array(values, kinds.get(kind, object))


class _Replaced:
    """A draft beside a file, which takes its place when the block ends well."""

    def __init__(self, path: Path) -> None:
        self._path, self._draft = path, path.with_name(f'.{path.name}.{os.getpid()}')

    def __enter__(self) -> Path:
        return self._draft

    def __exit__(self, kind, *_) -> None:
        if kind is None:
            os.replace(self._draft, self._path)
        else:
            self._draft.unlink(missing_ok=True)
