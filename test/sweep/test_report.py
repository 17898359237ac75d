# SPDX-License-Identifier: Apache-2.0
"""The report of a sweep: one page that fetches nothing, with the sweep's own numbers."""

import json
import re

from hydra_actuator.cli.main import main
from hydra_actuator.errors import InputError
from hydra_actuator.parameters import Parameters
from hydra_actuator.sweep import figures
from hydra_actuator.sweep.journal import Journal
from hydra_actuator.sweep.plan import settle
from hydra_actuator.sweep.report import report_page, write_report
from hydra_actuator.sweep.results import load_results
from hydra_actuator.sweep.run import Outcome, REFUSED, run_one
from hydra_actuator.sweep.tables import write_tables
import numpy as np
import pytest

COARSE = Parameters({'solver.cells': 40})


@pytest.fixture(scope='module')
def directory(make_plan, tmp_path_factory):
    """Give a sweep of 64 runs, the last refused and one not done, run in this process."""
    directory = tmp_path_factory.mktemp('reported')
    plan = settle(make_plan(
        'cylinder.area_1+cylinder.area_2=5e-4:2e-3:log', 'cylinder.mass=1:20', count=64,
        base=COARSE, duration=0.002), directory)
    outcomes = {run: run_one(run, plan.base.changed(), plan.changes(run), plan.drive)
                for run in range(62)}
    outcomes[62] = Outcome(62, REFUSED, 'too <heavy> by far', {})
    with Journal(directory) as journal:
        for outcome in outcomes.values():
            journal.append(outcome)
    write_tables(directory, plan, outcomes)
    return directory


@pytest.fixture(scope='module')
def results(directory):
    return load_results(directory)


def test_columns_are_in_engineers_units(results):
    area, mass = results.factors
    assert (area.label, area.logarithmic) == ('cylinder.area_1 [cm^2]', True)
    assert area.values.min() >= 5.0
    assert mass.label == 'cylinder.mass [kg]'
    peak = next(c for c in results.figures if c.name == 'peak_pressure')
    assert (peak.unit, 10.0 < peak.values.max() < 100.0) == ('MPa', True)


def test_parallel_coordinates_hold_every_run_and_factor(results):
    trace = figures.parallel(results).traces[0]
    labels = [axis['label'] for axis in trace['dimensions']]
    assert labels[:3] == ['cylinder.area_1 [cm^2]', 'cylinder.mass [kg]', 'bandwidth [Hz]']
    assert all(len(axis['values']) == 62 for axis in trace['dimensions'])
    assert 10.0**trace['dimensions'][0]['values'] == pytest.approx(
        results.factors[0].values, rel=1e-5)


def test_more_area_is_more_bandwidth_and_more_mass_is_less(results):
    trace = figures.correlations(results).traces[0]
    row = dict(zip(trace['x'], trace['z'][trace['y'].index('bandwidth')]))
    assert row['cylinder.area_1'] > 0.3
    assert row['cylinder.mass'] < -0.3
    indices = figures.sobol_indices(results).traces[0]
    assert 0.5 < sum(indices['z'][indices['y'].index('bandwidth')]) < 1.2


def test_failed_runs_stand_where_they_were_to_be(results):
    traces = figures.failed_runs(results).traces
    assert [trace['name'] for trace in traces] == ['done (62)', 'refused (1)']
    assert traces[1]['y'] == pytest.approx([results.told['runs'][62][1]])


def test_a_grid_says_why_it_has_no_indices(results):
    told = {**results.told, 'method': 'grid'}
    figure = figures.sobol_indices(type(results)(**{**vars(results), 'told': told}))
    assert 'drawn from ranges' in figure.missing


def test_the_page_is_whole_and_fetches_nothing(results):
    text = report_page(results)
    assert '62 runs done, 1 failed' in text
    assert '1 of 64 runs are not done yet' in text
    assert 'too &lt;heavy&gt; by far' in text
    assert "default-src 'none'" in text
    held = re.search(r'id="figures">(.*?)</script>', text, re.DOTALL)[1]
    assert [figure['key'] for figure in json.loads(held)['figures']] == [
        'parallel', 'correlation', 'sobol', 'scatter', 'failed']


def test_the_verb_takes_a_sweep_and_refuses_a_pair(directory, tmp_path, capsys):
    output = tmp_path / 'page.html'
    assert main(['report', str(directory), '-o', str(output)]) == 0
    assert capsys.readouterr().out.startswith(f'{output}: ')
    assert main(['report', str(directory), str(directory), '-o', str(output)]) == 2
    assert 'not compared with another' in capsys.readouterr().err


def test_a_sweep_without_results_is_refused(tmp_path, make_plan):
    settle(make_plan('cylinder.mass=1:20', count=2), tmp_path)
    with pytest.raises(InputError, match=r'results\.parquet cannot be read'):
        write_report(tmp_path, tmp_path / 'page.html')


def test_words_have_codes_and_names(make_plan, tmp_path):
    plan = make_plan('line_1.friction=none,constant', method='grid', duration=0.002)
    settle(plan, tmp_path)
    outcomes = {run: run_one(run, plan.base.changed(), plan.changes(run), plan.drive)
                for run in range(2)}
    write_tables(tmp_path, plan, outcomes)
    factor = load_results(tmp_path).factors[0]
    assert factor.texts == ('none', 'constant')
    assert np.array_equal(factor.values, [0.0, 1.0])
