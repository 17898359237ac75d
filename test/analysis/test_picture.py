# SPDX-License-Identifier: Apache-2.0
"""The picture is drawn from the run, in any of its formats, and bad wishes are one line."""

from dataclasses import replace
import sys

from hydra_actuator.analysis.picture import picture, write_picture
from hydra_actuator.errors import InputError
import numpy as np
import pytest


@pytest.mark.parametrize('ending, start', [('png', b'\x89PNG'), ('svg', b'<?xml'),
                                           ('pdf', b'%PDF')])
def test_a_recording_becomes_a_picture(make_run, record, tmp_path, ending, start):
    path = write_picture(record(make_run(0.2, 1000)), tmp_path / f'picture.{ending}')
    assert path.read_bytes().startswith(start)


def axes_by_label(figure, label):
    return next(axes for axes in figure.axes if label in axes.get_ylabel())


def test_the_piston_is_drawn_in_millimetres_over_the_last_three_periods(run):
    axes = axes_by_label(picture(run), 'piston')
    time, position = axes.lines[0].get_data()
    assert time[-1] == pytest.approx(60, rel=1e-3)
    assert np.max(position) == pytest.approx(12, rel=1e-3)


def test_dense_frames_show_waves_and_sparse_ones_the_pressure(make_run):
    sparse = picture(make_run(0.2, 1000))
    dense = picture(make_run(0.2, 10_000))
    assert axes_by_label(sparse, 'pressure [MPa]')
    assert axes_by_label(dense, 'less its mean')


def test_stations_alone_give_a_picture(run):
    assert picture(replace(run, field=None)).axes


def test_a_run_without_field_and_stations_is_refused(run):
    bare = replace(run, field=None, section_positions=np.empty(0))
    with pytest.raises(InputError, match='neither the field nor enough stations'):
        picture(bare)


@pytest.mark.parametrize('name, culprit', [('picture.bmp', r'\.png, \.svg or \.pdf'),
                                           ('nowhere/picture.png', 'no directory')])
def test_a_place_that_cannot_hold_a_picture_is_refused(tmp_path, name, culprit):
    with pytest.raises(InputError, match=culprit):
        write_picture(tmp_path, tmp_path / name)


def test_a_missing_matplotlib_is_one_line_that_names_the_remedy(monkeypatch, run):
    for name in [m for m in sys.modules if m.split('.')[0] == 'matplotlib']:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setitem(sys.modules, 'matplotlib', None)
    with pytest.raises(InputError, match=r'pip install hydra_actuator\[report\]'):
        picture(run)


def test_a_plain_run_below_vacuum_says_so_in_the_picture(run):
    assert not picture(run).texts
    pressure = run.pressure.copy()
    pressure[70, 10] = -2.5e6
    (text,) = picture(replace(run, pressure=pressure)).texts
    assert 'below vacuum' in text.get_text()
