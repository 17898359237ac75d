# SPDX-License-Identifier: Apache-2.0
"""The page is one file that fetches nothing and holds every figure's numbers."""

import base64
from dataclasses import replace
from html.parser import HTMLParser
import json
import re
import sys

from hydra_actuator.analysis import page as pages
from hydra_actuator.analysis import report
from hydra_actuator.analysis.figure import Figure
from hydra_actuator.errors import InputError
import numpy as np
import pytest


class Elements(HTMLParser):
    """Collects what a page refers to, its identifiers, and the texts of its scripts."""

    def __init__(self, text: str):
        super().__init__()
        self.references, self.identifiers, self.scripts, self.missing = [], [], {}, []
        self.policy = ''
        self._inside = None
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        given = dict(attrs)
        self.references += [given[k] for k in ('src', 'href', 'action', 'data') if k in given]
        self.identifiers += [given['id']] if 'id' in given else []
        self.missing += [given['data-missing']] if 'data-missing' in given else []
        if given.get('http-equiv') == 'Content-Security-Policy':
            self.policy = given['content']
        self._inside = (given.get('id') or len(self.scripts)) if tag == 'script' else None

    def handle_data(self, data):
        if self._inside is not None:
            self.scripts[self._inside] = data

    def handle_endtag(self, tag):
        self._inside = None


def unpacked(array: dict) -> np.ndarray:
    """Read an array as the page's script does."""
    raw = base64.b64decode(array['data'])
    if array['type'] == 'f4':
        return np.frombuffer(raw, '<f4')
    steps = np.frombuffer(raw, f'<{array["type"]}').reshape(array['shape'])
    none = np.iinfo(steps.dtype).max
    return np.where(steps == none, np.nan, array['lowest'] + steps * array['step'])


@pytest.fixture
def text(run):
    return report.report_page(run)


def test_the_page_refers_to_nothing_outside_itself(text):
    elements = Elements(text)
    assert elements.references == []
    assert "default-src 'none'" in elements.policy
    assert "connect-src 'none'" in elements.policy
    assert not re.search(r'url\(|@import', pages.asset('style.css'))


def test_every_figure_has_its_place_and_its_numbers(text, run):
    elements = Elements(text)
    content = json.loads(elements.scripts['figures'])
    keys = [figure['key'] for figure in content['figures']]
    assert keys == [figure.key for figure in report.figures(run)]
    for figure in content['figures']:
        assert figure['key'] in elements.identifiers
        for trace in figure['traces']:
            for axis in {'x', 'y', 'z'} & trace.keys():
                values = unpacked(content['arrays'][trace[axis]['$array']])
                assert np.isfinite(values).any()


def test_plotly_is_embedded_once(text):
    assert text.count('plotly.js v') == 1


def test_numbers_survive_the_page():
    rng = np.random.default_rng(2)
    line, times = rng.normal(size=100).astype(np.float32), np.linspace(0, 600, 50)
    field = rng.normal(size=(7, 9))
    field[2, 3] = np.nan
    figure = Figure('one', '', '', [{'x': times, 'y': line, 'z': field}], {})
    content = json.loads(pages.figures_json([figure, replace(figure, key='two')]))
    assert len(content['arrays']) == 3
    x, y, z = map(unpacked, content['arrays'])
    # Ten minutes in 2**32 steps: 0.07 us.
    np.testing.assert_allclose(x, times, rtol=0, atol=1e-7)
    np.testing.assert_array_equal(y, line)
    # Half of one of 65534 steps.
    np.testing.assert_allclose(z, field, atol=0.5001 * np.ptp(field[np.isfinite(field)]) / 65534)


def test_a_field_of_one_value_or_none_survives():
    for field in (np.full((2, 3), 7.0), np.full((2, 3), np.nan)):
        (array,) = json.loads(pages.figures_json(
            [Figure('one', '', '', [{'z': field}], {})]))['arrays']
        np.testing.assert_array_equal(unpacked(array), field)


def test_names_from_a_recording_cannot_become_markup(run):
    hostile = replace(run, name='<script>alert(1)</script>@PLOTLY@',
                      section_names=('</script>', *run.section_names[1:]))
    elements = Elements(report.report_page(hostile))
    assert len(elements.scripts) == 3
    assert json.loads(elements.scripts['figures'])


def test_a_missing_figure_is_a_sentence(run):
    elements = Elements(report.report_page(replace(run, field=None, diagnostics=())))
    assert elements.missing == ['whole', 'faults', 'real_time']


def test_the_page_of_ten_seconds_is_below_ten_megabytes(make_run):
    # 1 kHz, twelve stations, a field of 200 Hz on the reference mesh (2 m, 200 cells).
    run = make_run(10.0, 200)
    assert len(report.report_page(run)) < 10e6


def test_a_missing_plotly_is_one_line_that_names_the_remedy(monkeypatch, run):
    for name in [m for m in sys.modules if m.startswith('plotly')]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setitem(sys.modules, 'plotly', None)
    with pytest.raises(InputError, match=r'pip install hydra_actuator\[report\]'):
        report.report_page(run)
