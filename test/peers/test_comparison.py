# SPDX-License-Identifier: Apache-2.0
"""Peers that cannot be had are told with the reason, in a line of the table."""

from pathlib import Path
import sys

from hydra_actuator.peers import environment
from hydra_actuator.peers.comparison import lines, Row, run_peer
from hydra_actuator.peers.environment import last_line, NotInstalled, Peer, python_of
from hydra_actuator.peers.work import Measured
import pytest

pytestmark = pytest.mark.once


def test_a_package_that_is_not_there_is_the_reason(tmp_path):
    peer = Peer('Nobody', 'nobody_line.py', (str(tmp_path / 'nothing.whl'),), 10)
    with pytest.raises(NotInstalled, match=r'(?i)nothing\.whl'):
        python_of(peer, tmp_path)


def test_what_is_installed_is_not_installed_again(tmp_path, monkeypatch):
    peer = Peer('None', 'none_line.py', ('none==1',), 10)
    (tmp_path / 'none').mkdir()
    (tmp_path / 'none' / environment.STAMP).write_text('none==1')
    monkeypatch.setattr(environment.subprocess, 'run', None)
    assert python_of(peer, tmp_path) == tmp_path / 'none' / 'bin' / 'python'


def test_a_peer_that_fails_is_the_reason():
    with pytest.raises(NotInstalled, match='rthym_moc'):
        run_peer(Peer('R', 'rthym_line.py', (), 10), Path(sys.executable))


def test_the_last_error_is_told():
    assert last_line('ok\nERROR: no such thing\nWARNING: old pip\n') == 'ERROR: no such thing'
    assert last_line('') == 'no reason given'


def test_the_table_has_ratios_by_round_and_reasons():
    ours = (Measured(4e8, 1e-9, '0.1'), Measured(2e8, 1e-9, '0.1'))
    one_pass = (Measured(6e8, 1e-8, '0.1'), Measured(3e8, 1e-8, '0.1'))
    peer = (Measured(2e8, -1e-3, '2'), Measured(1e8, -1e-3, '2'))
    told = lines([Row('ours', ours), Row('one', one_pass), Row('Peer', peer),
                  Row('Other', (), 'no wheel')])
    assert told[2].split() == ['ours', '0.1', '300.000', '1.00', '1.50', '1.0e-09']
    assert told[3].split() == ['one', '0.1', '450.000', '0.67', '1.00', '1.0e-08']
    assert told[4].split() == ['Peer', '2', '150.000', '2.00', '3.00', '-1.0e-03']
    assert told[5].split(maxsplit=1) == ['Other', 'no wheel']
