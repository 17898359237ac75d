# SPDX-License-Identifier: Apache-2.0
"""The directory holds the pictures and one page with all of them inside, or nothing at all."""

import base64
from html.parser import HTMLParser
import re

from hydra_actuator.errors import InputError
from hydra_actuator.paper import production
from hydra_actuator.paper.choice import choose
from hydra_actuator.paper.page import page
from hydra_actuator.paper.production import write_paper
from hydra_actuator.paper.statement import Finding, Statement
import pytest


def steep(figure):
    figure.subplots().plot([0, 1], [0, 1])


@pytest.fixture
def statement(monkeypatch):
    """Put one statement in the place of all others."""
    made = Statement(
        'steep', 'A <steep> front stays', 'section 7', False, 'It does not, & why.',
        (Finding('height', 'MPa', '2', '1.5'), Finding('share', '-', '1', '0.75')), steep)
    table = {'steep': lambda: made}
    for module in ('choice', 'production'):
        monkeypatch.setattr(f'hydra_actuator.paper.{module}.STATEMENTS', table)
    return made


def test_all_cases_of_a_figure_are_written(tmp_path, small_cases):
    shares = []
    found = write_paper(tmp_path / 'new' / 'paper', choose(['5a', 'figure_3e']), shares.append)
    assert found == tmp_path / 'new' / 'paper' / 'paper.html'
    assert {path.name for path in found.parent.iterdir()} == {
        'figure_3e.png', 'figure_3e_cavitation.png', 'figure_3e_200hz.png', 'figure_5a.png',
        'figure_5a_cavitation.png', 'figure_5a_200hz.png', 'paper.html'}
    assert all(path.read_bytes().startswith(b'\x89PNG') for path in found.parent.glob('*.png'))
    assert shares == sorted(shares)
    assert shares[-1] == pytest.approx(1.0)


@pytest.mark.parametrize('models, suffixes', [
    ({'cavitation': False}, {'', '_200hz'}), ({'plain': False}, {'_cavitation'})])
def test_one_model_can_be_asked_for(small_cases, models, suffixes):
    assert {case.suffix for _, case in choose(['5a'], **models).pictures} == suffixes


def test_without_a_wish_there_is_every_figure_and_a_fast_one_beside(small_cases, statement):
    choice = choose([])
    names = {figure.name for figure, _ in choice.pictures}
    assert len(names) == 24
    assert choice.statements == ['steep']
    fast = {figure.name for figure, case in choice.pictures if case.name == '200hz'}
    assert {'2a', '2b', '3c', '5b', '5c'} <= fast < names


def test_page_holds_everything_and_fetches_nothing(tmp_path, small_cases, statement):
    found = write_paper(tmp_path / 'paper', choose(['5a', 'steep'], cavitation=False))
    text = found.read_text()
    HTMLParser().feed(text)
    inside = re.findall(r'src="data:image/png;base64,([^"]+)"', text)
    on_disk = {path.read_bytes() for path in found.parent.glob('*.png')}
    assert {base64.b64decode(data) for data in inside} == on_disk
    assert not re.search(r'(?:src|href)="(?!data:)', text)
    assert "default-src 'none'" in text
    assert text.index('id="figure_5a"') < text.index('id="statements"') < text.index('The case')
    assert 'A &lt;steep&gt; front stays' in text
    assert 'It does not, &amp; why.' in text
    assert re.search(r'height \[MPa\]</td><td>2</td><td>1\.5</td><td[^>]*>refuted', text)
    assert re.search(r'share</td><td>1</td><td>0\.75</td></tr>', text)
    assert '@' not in re.sub('base64,[^"]*', '', text).replace('@media', '')


def test_verdicts_are_counted_in_words():
    def of(confirmed):
        return Statement('a', 'claim', 'where', confirmed, 'reason', ()), None
    text = page([], [of(True), of(True), of(None)], [])
    assert 'Statements of the paper: 2 confirmed, 1 in part' in text


def test_unknown_figure_is_refused_with_those_there_are():
    with pytest.raises(InputError, match="'9z'; figures: 2a, 2b, "):
        choose(['2a', '9z'])


def test_an_interrupted_attempt_leaves_nothing(tmp_path, small_cases, monkeypatch):
    def interrupt(*_):
        raise KeyboardInterrupt
    monkeypatch.setattr(production, 'page', interrupt)
    with pytest.raises(KeyboardInterrupt):
        write_paper(tmp_path / 'paper', choose(['5a'], cavitation=False))
    assert not list(tmp_path.iterdir())


def test_a_directory_that_came_meanwhile_is_not_touched(tmp_path, small_cases):
    (tmp_path / 'paper').mkdir()
    with pytest.raises(InputError, match='exists already'):
        write_paper(tmp_path / 'paper', choose(['5a'], cavitation=False))
    assert [path.name for path in tmp_path.iterdir()] == ['paper']
    assert not list((tmp_path / 'paper').iterdir())
