# SPDX-License-Identifier: Apache-2.0
"""The records of speed, and the verdict on what is slower than they are."""

from hydra_actuator import guard
from hydra_actuator.cli.main import main
from hydra_actuator.guard import Record
import pytest

NOW = Record('c', 'here', {'step': 3.0, 'sweep': 1.4})


@pytest.fixture
def records(tmp_path, monkeypatch):
    monkeypatch.setattr(guard, 'measure', lambda: NOW)
    return tmp_path / 'speed.jsonl'


def test_records_come_back_as_written(records):
    assert guard.read(records) == []
    guard.append(records, NOW)
    guard.append(records, Record('d', 'there', {}))
    assert guard.read(records) == [NOW, Record('d', 'there', {})]


def test_the_last_record_of_the_same_processor_counts(records):
    guard.append(records, Record('a', 'here', {'step': 9.0}))
    guard.append(records, Record('b', 'here', {'step': 8.0}))
    guard.append(records, Record('b', 'there', {'step': 1.0}))
    assert guard.last(guard.read(records), 'here').ratios == {'step': 8.0}
    assert guard.last(guard.read(records), 'nowhere') is None


@pytest.mark.parametrize('before, code', [(2.9, 0), (2.0, 1)])
def test_a_much_larger_ratio_fails(records, capsys, before, code):
    guard.append(records, Record('b', 'here', {'step': before}))
    assert main(['bench', '--guard', str(records)]) == code
    assert ('SLOWER' in capsys.readouterr().out) == bool(code)


def test_what_is_measured_is_recorded_when_asked(records):
    main(['bench', '--guard', str(records)])
    assert guard.read(records) == []
    main(['bench', '--guard', str(records), '--record'])
    assert guard.read(records) == [NOW]
