# SPDX-License-Identifier: Apache-2.0
"""Pictures and words about cavities, and the warning of a run that should have had them."""

from dataclasses import replace

from hydra_actuator.analysis import boiling, facts, figure_cavities, report
from hydra_actuator.analysis.extraction import series_of
from hydra_actuator.analysis.series import Cavities
from hydra_actuator.analysis.window import window_of
from hydra_actuator.channels import DOMAINS
import numpy as np
import plotly.graph_objects as go
import pytest

AIR, AMBIENT, VAPOUR = 1e-4, 101325.0, 10.0
RETURN_LINE, LINE_2 = DOMAINS.index('return_line'), DOMAINS.index('line_2')


@pytest.fixture
def torn(run):
    """Return the made-up run with a cavity in the return line in the middle of every period."""
    swing = np.maximum(np.sin(2 * np.pi * 50.0 * run.time), 0.0)
    of_domain = np.zeros((len(run.time), 6))
    of_domain[:, RETURN_LINE] = 3e-6 * swing
    is_open = (swing > 0.1).astype(float)
    opened = np.cumsum(np.diff(is_open, prepend=0.0) > 0)
    collapsed = np.cumsum(np.diff(is_open, prepend=0.0) < 0)
    found = Cavities(run.time, of_domain.sum(axis=1), is_open, opened, collapsed, DOMAINS,
                     of_domain)
    pressure = run.field.pressure.copy()
    node = run.field.labels.index('return_line') + 3
    pressure[500, node] = VAPOUR + 0.001 * (AMBIENT - VAPOUR)
    parameters = {
        **run.parameters, 'fluid.cavitation': True, 'fluid.air_fraction': AIR,
        'fluid.vapour_pressure': VAPOUR, 'ambient_pressure': AMBIENT}
    return replace(run, cavities=found, parameters=parameters,
                   field=replace(run.field, pressure=pressure))


def test_void_fraction_is_the_gas_law_above_vapour_pressure(torn):
    void = boiling.void_fraction(torn, np.array([AMBIENT, VAPOUR + 1.0, np.nan]))
    assert void[:2] == pytest.approx([AIR, AIR * (AMBIENT - VAPOUR)])
    assert np.isnan(void[2])
    assert np.isfinite(boiling.void_fraction(torn, np.array([VAPOUR, 0.0]))).all()


def test_figures_of_cavities_are_valid_for_plotly_and_in_order(torn):
    figures = figure_cavities.cavities(torn, window_of(torn))
    assert [figure.key for figure in figures] == ['cavities', 'map_void', 'whole_void']
    for figure in figures:
        go.Figure(data=figure.traces, layout=figure.layout)
    keys = [figure.key for figure in report.figures(torn)]
    assert keys.index('piston') < keys.index('cavities') < keys.index('real_time')


def test_volumes_are_in_millilitres_by_the_domains_that_boiled(torn):
    figure = figure_cavities.volumes(torn, window_of(torn))
    lines = {trace['name']: trace for trace in figure.traces}
    assert list(lines) == ['return_line', 'open']
    assert lines['return_line']['y'].max() == pytest.approx(3.0, rel=1e-6)
    assert '50 opened, 50 collapsed; most was 3 ml' in figure.caption


def test_with_several_domains_their_sum_is_a_line_of_its_own(torn):
    of_domain = torn.cavities.of_domain.copy()
    of_domain[:, LINE_2] = 1e-6
    both = replace(torn.cavities, of_domain=of_domain, volume=of_domain.sum(axis=1))
    lines = {t['name']: t for t in figure_cavities.volumes(
        replace(torn, cavities=both), window_of(torn)).traces}
    assert set(lines) == {'line_2', 'return_line', 'all', 'open'}
    assert lines['all']['y'].max() == pytest.approx(4.0, rel=1e-6)


def test_the_map_of_the_whole_run_keeps_the_one_node_that_boiled(torn):
    (heat,) = figure_cavities.whole_map(torn, torn.field, window_of(torn)).traces
    row, column = np.unravel_index(np.argmax(heat['z']), heat['z'].shape)
    assert heat['y'][row] <= 0.5 < heat['y'][row] + 0.021
    assert 1.4 < heat['x'][column] < 1.6
    # 1e-3 of ambient's p - p_v: a thousand times the gas, 10 %; linear to the neighbours
    assert 5.0 < heat['customdata'][row, column] <= 10.01
    assert 10.0 ** heat['zmin'] == pytest.approx(AIR)


def test_without_cavitation_there_is_nothing_about_it(run):
    assert figure_cavities.cavities(run, window_of(run)) == []


def test_a_run_in_which_nothing_boiled_has_one_line(torn):
    calm = replace(torn.cavities, opened=np.zeros(len(torn.time)))
    (figure,) = figure_cavities.cavities(replace(torn, cavities=calm), window_of(torn))
    assert figure.missing == 'no cavity opened in this run'


def test_without_the_topic_the_maps_remain(torn):
    figures = figure_cavities.cavities(replace(torn, cavities=None), window_of(torn))
    assert 'sections_rate' in figures[0].missing
    assert [figure.key for figure in figures[1:]] == ['map_void', 'whole_void']


def test_the_facts_count_cavities(torn):
    rows = dict(facts.run_facts(torn))
    assert rows['cavities'] == '50 opened, 50 collapsed'
    assert rows['largest volume of cavities'].startswith('3 ml, t = ')


def test_a_plain_run_below_vacuum_warns_with_depth_place_and_remedy(run):
    pressure = run.pressure.copy()
    pressure[70, 10] = -2.5e6
    deep = replace(run, pressure=pressure)
    (words,) = boiling.warnings(deep)
    assert words == ('The plain model let the absolute pressure fall to -2.5 MPa at J, '
                     't = 0.0700 s, below vacuum: turn fluid.cavitation on.')
    assert f'<p class="warning">{words}</p>' in report.report_page(deep)
    field = run.field.pressure.copy()
    field[10, 3] = -3e6
    words, = boiling.warnings(replace(deep, field=replace(run.field, pressure=field)))
    assert '-3 MPa in supply_line, x = 0.06 m' in words


def test_neither_a_sound_run_nor_one_with_cavitation_warns(run, torn):
    assert boiling.warnings(run) == []
    assert 'class="warning"' not in report.report_page(run)
    pressure = torn.pressure.copy()
    pressure[70, 10] = -2.5e6
    assert boiling.warnings(replace(torn, pressure=pressure)) == []


def test_cavities_come_out_of_a_recording(torn, record):
    found = series_of(record(torn)).cavities
    assert found.domains == DOMAINS
    for name in ('time', 'volume', 'open', 'opened', 'collapsed', 'of_domain'):
        np.testing.assert_allclose(getattr(found, name), getattr(torn.cavities, name), atol=1e-9)
