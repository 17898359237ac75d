# SPDX-License-Identifier: Apache-2.0
"""Sweeps on a real Dask cluster: nothing twice, nothing lost, failures apart."""

import csv
import os
import signal

from hydra_actuator.errors import InputError
from hydra_actuator.sweep import execution
from hydra_actuator.sweep.execution import sweep
from hydra_actuator.sweep.journal import FILE as JOURNAL
from hydra_actuator.sweep.run import DONE, LOST, run_one
from hydra_actuator.sweep.tables import FAILED, load_table, NETCDF
import pytest
import xarray

MASS = 'cylinder.mass=1:20'


def lines(directory):
    return (directory / JOURNAL).read_text().splitlines()


def test_a_run_on_a_worker_is_bit_identical_to_one_here(make_plan, where, tmp_path):
    plan = make_plan(MASS, count=2)
    outcomes = sweep(plan, tmp_path, where)
    for run, outcome in outcomes.items():
        here = run_one(run, plan.base.changed(), plan.changes(run), plan.drive)
        assert {**outcome.figures, 'run_time': 0} == {**here.figures, 'run_time': 0}


def test_results_hold_parameters_figures_and_units(make_plan, where, tmp_path):
    plan = make_plan('line_1.length+line_2.length=0.1:0.3', 'cylinder.mass=5,10', count=4)
    sweep(plan, tmp_path, where)
    found, about = load_table(tmp_path)
    assert (found['line_1.length'][0] == found['line_2.length'][0]).all()
    assert found['line_1.length'][0].tolist() == [one[0] for one in plan.samples]
    assert found['peak_pressure'][1]['unit'] == 'Pa'
    assert found['cylinder.mass'][1]['role'] == 'parameter'
    assert 'cells: 40' in about['parameters']
    with xarray.open_dataset(tmp_path / NETCDF) as data:
        assert data.sizes == {'run': 4}
        assert data.travel.attrs['unit'] == 'm'
        assert data['cylinder.mass'].values.tolist() == found['cylinder.mass'][0].tolist()


def test_a_grid_has_its_factors_as_dimensions(make_plan, where, tmp_path):
    plan = make_plan(MASS, 'line_1.friction=none,constant', method='grid', count=3)
    sweep(plan, tmp_path, where)
    with xarray.open_dataset(tmp_path / NETCDF) as data:
        assert dict(data.sizes) == {'cylinder.mass': 3, 'line_1.friction': 2}
        found = data.travel.sel({'cylinder.mass': 10.5, 'line_1.friction': 'none'})
        here = run_one(0, plan.base.changed(), {
            'cylinder.mass': 10.5, 'line_1.friction': 'none'}, plan.drive)
        assert float(found) == here.figures['travel']


def test_failed_runs_are_kept_apart_and_the_sweep_goes_on(make_plan, where, tmp_path):
    plan = make_plan('solver.max_mach=0.001,0.02', 'initial.position=0,0.5', method='grid')
    outcomes = sweep(plan, tmp_path, where)
    assert [outcomes[run].status for run in range(4)] == ['stopped', 'refused', 'done', 'refused']
    with open(tmp_path / FAILED, newline='') as file:
        rows = list(csv.DictReader(file))
    assert [row['status'] for row in rows] == ['stopped', 'refused', 'refused']
    assert 'exceeds solver.max_mach' in rows[0]['reason']
    assert 'initial.position = 0.5' in rows[1]['reason']
    assert load_table(tmp_path)[0]['run'][0].tolist() == [2]


def test_an_interrupted_sweep_goes_on_without_repeating(make_plan, where, tmp_path, monkeypatch):
    plan = make_plan(MASS, count=12)

    def press_ctrl_c(share):
        if share > 0.3:
            os.kill(os.getpid(), signal.SIGINT)
    with pytest.raises(KeyboardInterrupt):
        sweep(plan, tmp_path, where, progress=press_ctrl_c)
    before = lines(tmp_path)
    assert 4 <= len(before) < 12
    assert len(load_table(tmp_path)[0]['run'][0]) == len(before)
    outcomes = sweep(plan, tmp_path, where)
    assert lines(tmp_path)[:len(before)] == before
    assert len(lines(tmp_path)) == len(outcomes) == 12
    assert all(one.status == DONE for one in outcomes.values())
    again = lines(tmp_path)
    monkeypatch.setattr(execution, 'connected', None)
    assert len(sweep(plan, tmp_path, where)) == 12
    assert lines(tmp_path) == again


def test_a_killed_worker_costs_no_run(make_plan, cluster, where, tmp_path):
    plan, killed = make_plan(MASS, count=24, duration=0.02), []

    def kill_one(share):
        if not killed and share > 0.2:
            killed.append(next(iter(cluster.workers.values())).pid)
            os.kill(killed[0], signal.SIGKILL)
    outcomes = sweep(plan, tmp_path, where, progress=kill_one)
    assert killed
    assert sorted(outcomes) == list(range(24))
    assert all(one.status == DONE for one in outcomes.values())
    assert len(lines(tmp_path)) == 24


@pytest.mark.soak
def test_a_run_that_kills_every_worker_is_told_and_the_others_are_done(
        make_plan, where, tmp_path, monkeypatch):
    plan, run_chunk, deadly = make_plan(MASS, count=24, duration=0.02), execution.run_chunk, 5

    def die_of_one(asked, base, drive):
        if deadly in [run for run, _ in asked]:
            os._exit(1)
        return run_chunk(asked, base, drive)
    monkeypatch.setattr(execution, 'run_chunk', die_of_one)
    outcomes = sweep(plan, tmp_path, where)
    lost = outcomes.pop(deadly)
    assert (lost.status, lost.reason) == (LOST, 'its workers died with it')
    assert sorted(outcomes) == [run for run in range(24) if run != deadly]
    assert {one.status for one in outcomes.values()} == {DONE}


def test_failed_runs_are_done_again_only_if_asked(make_plan, where, tmp_path):
    plan = make_plan('initial.position=0,0.5', method='grid')
    for again, count in ((False, 2), (False, 2), (True, 3)):
        sweep(plan, tmp_path, where, again)
        assert len(lines(tmp_path)) == count


def test_another_plan_is_refused_by_what_differs(make_plan, where, tmp_path):
    sweep(make_plan(MASS, count=2), tmp_path, where)
    with pytest.raises(InputError, match='another sweep: its samples is 2, not 4'):
        sweep(make_plan(MASS, count=4), tmp_path, where)
    with pytest.raises(InputError, match='its parameters differ in solver'):
        sweep(make_plan(MASS, count=2, base=make_plan(MASS).base.replace({'solver.cells': 50})),
              tmp_path, where)


def test_workers_of_another_version_are_refused(make_plan, where, tmp_path, monkeypatch):
    import hydra_actuator
    monkeypatch.setattr(hydra_actuator, '__version__', '99')
    with pytest.raises(InputError, match=r'worker tcp://\S+ has hydra_actuator \S+, not 99'):
        sweep(make_plan(MASS, count=2), tmp_path, where)
    assert lines(tmp_path) == []


def test_a_directory_of_something_else_is_left_alone(make_plan, where, tmp_path):
    (tmp_path / 'thesis.txt').write_text('years of work')
    with pytest.raises(InputError, match='is not empty and holds no sweep'):
        sweep(make_plan(MASS, count=2), tmp_path, where)
    assert [path.name for path in tmp_path.iterdir()] == ['thesis.txt']
